#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include <nlohmann/json.hpp>

#include "cli/small_scene.hpp"

namespace exitance::test {

TEST(ProgramExport, EveryEndingMakesAFileAndOthersAreUsageErrors) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    for (const std::string ending : {".vtkhdf", ".vtu", ".glb", ".csv", ".obj"}) {
        const std::string file = folder / ("lit" + ending);
        const Finished run = run_program({"export", solution, "-o", file});
        EXPECT_EQ(run.status, 0) << ending << run.err;
        EXPECT_FALSE(read_text(file).empty()) << ending;
    }
    const Finished run = run_program({"export", solution, "-o", folder / "lit.docx"});
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find("docx"), std::string::npos) << run.err;
    EXPECT_EQ(run_program({"export", solution, "-o", folder / "absent/lit.glb"}).status, 5);
}

TEST(ProgramExport, WritesDiscontinuityCurvesAndQuadraticTriangles) {
    const TemporaryFolder folder;
    const std::string scene = folder / "table.obj", solution = folder / "table.h5";
    ASSERT_EQ(run_program({"generate", "table", "-o", scene, "-q"}).status, 0);
    const Finished run = run_program({"solve", scene, "-o", solution, "--method", "discontinuity", "--bounces", "0",
                                      "--error-interpolant", "0.01", "--json", "-q"});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_GT(json["curves"]["d0"], 0);
    EXPECT_GT(json["curves"]["d2"], 0);
    EXPECT_GT(json["faces"]["lit"], 0);
    EXPECT_GT(json["faces"]["penumbra"], 0);
    EXPECT_GT(json["faces"]["umbra"], 0);
    EXPECT_EQ(json["leaf_elements"], json["triangles"]);
    EXPECT_LE(json["relative_error_estimate_interpolant"], 0.01);
    const std::string curves = folder / "table.curves.csv", cells = folder / "table.vtu";
    ASSERT_EQ(run_program({"export", solution, "-o", curves}).status, 0);
    const std::string table = read_text(curves);
    EXPECT_EQ(table.substr(0, table.find('\n')), "surface,x0,y0,z0,x1,y1,z1,order,cause,source");
    for (const char* word : {",D0,contact,", ",D2,VE,", ",D2,EV,"}) EXPECT_NE(table.find(word), std::string::npos);
    ASSERT_EQ(run_program({"export", solution, "-o", cells}).status, 0);
    const std::string count = "NumberOfCells=\"" + std::to_string(json["triangles"].get<int>()) + "\"";
    EXPECT_NE(read_text(cells).find(count), std::string::npos);
}

TEST(ProgramExport, WritesCloughTocherElementsAsCubicTriangles) {
    const TemporaryFolder folder;
    const std::string scene = folder / "table.obj", solution = folder / "table.h5", cells = folder / "table.vtu";
    ASSERT_EQ(run_program({"generate", "table", "-o", scene, "-q"}).status, 0);
    const Finished run = run_program({"solve", scene, "-o", solution, "--method", "discontinuity", "--bounces", "0",
                                      "--error-interpolant", "0.01", "--dm-element", "clough-tocher", "--json", "-q"});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["basis"], "clough-tocher");
    EXPECT_LE(json["relative_error_estimate_interpolant"], 0.01);
    ASSERT_EQ(run_program({"export", solution, "-o", cells}).status, 0);
    const std::string count = "NumberOfCells=\"" + std::to_string(3 * json["triangles"].get<int>()) + "\"";
    EXPECT_NE(read_text(cells).find(count), std::string::npos);
    EXPECT_EQ(run_program({"export", solution, "-o", folder / "table.glb"}).status, 0);
    EXPECT_EQ(run_program({"render", solution, "-o", folder / "table.png", "--size", "40x30", "--mesh"}).status, 0);
}

TEST(ProgramExport, WritesTheMeshThatASolutionWithoutLayersHas) {
    const TemporaryFolder folder;
    const std::string scene = folder / "boxes.obj", solution = folder / "boxes.h5", cells = folder / "boxes.vtu",
                      single = folder / "single.h5", single_cells = folder / "single.vtu";
    ASSERT_EQ(run_program({"generate", "boxes", "lights=2", "-o", scene, "-q"}).status, 0);
    const Finished run = run_program({"solve", scene, "-o", solution, "--method", "discontinuity", "--bounces", "0",
                                      "--error-interpolant", "0.01", "--layers", "on", "--json", "-q"});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["layers"], 2);
    EXPECT_GT(json["layer_bytes"], 0);
    EXPECT_LT(json["layer_bytes"].get<double>(), 0.5 * json["winged_edge_bytes"].get<double>());
    ASSERT_EQ(run_program({"export", solution, "-o", cells}).status, 0);
    ASSERT_EQ(run_program({"solve", scene, "-o", single, "--method", "discontinuity", "--bounces", "0",
                           "--error-interpolant", "0.01", "-q"})
                  .status,
              0);
    ASSERT_EQ(run_program({"export", single, "-o", single_cells}).status, 0);
    EXPECT_EQ(read_text(cells), read_text(single_cells));
    EXPECT_LT(3 * std::filesystem::file_size(solution), std::filesystem::file_size(single));
    EXPECT_EQ(run_program({"export", solution, "-o", folder / "boxes.curves.csv"}).status, 0);
    const std::string picture = folder / "boxes.png";
    EXPECT_EQ(run_program({"render", solution, "-o", picture, "--size", "40x30", "--shadow-classes"}).status, 0);
}

TEST(ProgramExport, TablesOfFacesHaveErrorsAndTheirNumberOfPoints) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", table = folder / "room.csv";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    ASSERT_EQ(run_program({"export", solution, "-o", table}).status, 0);
    std::istringstream lines(read_text(table));
    std::string line;
    std::getline(lines, line);
    EXPECT_TRUE(line.ends_with(",relative_error,error_points")) << line;
    double points = 0;
    while (std::getline(lines, line)) {
        const std::size_t last = line.rfind(','), before = line.rfind(',', last - 1);
        const double error = std::stod(line.substr(before + 1));
        EXPECT_GE(error, 0) << line;  // 0 if nothing is reflected
        EXPECT_LT(error, 0.5) << line;
        points += std::stod(line.substr(last + 1));
    }
    EXPECT_GT(points, 1000);
}

TEST(ProgramExport, OfASolutionWithoutCurvesIsAUsageError) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    EXPECT_EQ(run_program({"export", solution, "-o", folder / "lit.curves.csv"}).status, 2);
}

}  // namespace exitance::test
