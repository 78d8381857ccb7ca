#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "cli/input_files.hpp"
#include "run_program.hpp"

namespace exitance::test {
namespace {

TEST(ProgramLuminaire, PrintsAndDrawsFacts) {
    const TemporaryFolder folder;
    write_text(folder / "d.ies", downlight);
    const Finished text = run_program({"luminaire", folder / "d.ies", "-o", folder / "d.svg", "-o", folder / "d.obj"});
    EXPECT_EQ(text.status, 0) << text.err;
    EXPECT_NE(text.out.find("beam angle (50%)"), std::string::npos) << text.out;
    EXPECT_TRUE(read_text(folder / "d.svg").starts_with("<svg"));
    ASSERT_EQ(run_program({"luminaire", folder / "d.ies", "-o", folder / "ugr.csv"}).status, 0);
    EXPECT_TRUE(read_text(folder / "ugr.csv").starts_with("ceiling,walls,floor,X,Y,crosswise,endwise\n70,50,20,2,2,"));
    const Finished checked = run_program({"check", folder / "d.obj", "--json"});
    EXPECT_EQ(checked.status, 0) << checked.err;
    const Finished json = run_program({"luminaire", folder / "d.ies", "--json"});
    const auto facts = nlohmann::json::parse(json.out);
    EXPECT_NEAR(facts["luminaire_lumens"], 3123.8, 1);
    EXPECT_NEAR(facts["efficiency"], 0.781, 1e-3);
    EXPECT_NEAR(facts["beam_angle"]["c0_c180"], 120, 0.1);
    EXPECT_EQ(facts["opening"]["shape"], "rectangle");
    EXPECT_EQ(facts["opening"]["size"], (std::vector<double>{1.2, 0.6, 0}));
}

/// Height of the geometry in an OBJ file.
double height_of(const std::string& obj) {
    std::istringstream lines(obj);
    double least = 1e9, most = -1e9;
    for (std::string line; std::getline(lines, line);) {
        double x = 0, y = 0, z = 0;
        if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3)
            least = std::min(least, z), most = std::max(most, z);
    }
    return most - least;
}

TEST(ProgramLuminaire, WritesTheTrueHeightOfAThinOpeningAndReportsAMissingOne) {
    const TemporaryFolder folder;
    const auto run = [&](const std::string& opening) {
        std::string text = downlight;
        write_text(folder / "l.ies", text.replace(text.find("0.6 1.2 0"), 9, opening));
        const Finished done = run_program({"luminaire", folder / "l.ies", "-o", folder / "l.obj"});
        EXPECT_EQ(done.status, 0) << done.err;
        return done;
    };
    for (const double height : {0.001, 0.003, 0.02}) {
        const Finished thin = run("0.024 0.599 " + std::to_string(height));
        EXPECT_NEAR(height_of(read_text(folder / "l.obj")), height, 1e-9);
        EXPECT_EQ(thin.err.find("extent"), std::string::npos) << thin.err;
    }
    EXPECT_NE(run("0 1.2 0").err.find("no extent in some direction: 1 cm is used there"), std::string::npos);
    EXPECT_NE(run("0 0 0").err.find("a cube of 1 mm is used"), std::string::npos);
}

TEST(ProgramLuminaire, ReportsTheLineOfAnError) {
    const TemporaryFolder folder;
    std::string text = downlight;
    write_text(folder / "d.ies", text.replace(text.find("707.1"), 5, "7o7.1"));
    const Finished bad = run_program({"luminaire", folder / "d.ies"});
    EXPECT_EQ(bad.status, 3);
    EXPECT_NE(bad.err.find("d.ies:9: '7o7.1'"), std::string::npos) << bad.err;
    EXPECT_EQ(run_program({"luminaire", folder / "d.xyz"}).status, 3);
    EXPECT_EQ(run_program({"luminaire", folder / "d.ies", "-o", "a.png"}).status, 2);
}

constexpr const char* floor_obj =
    "mtllib floor.mtl\nv -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0\nusemtl grey\nf 1 2 3 4\n"
    "v -5 -5 3\nv 5 -5 3\nv 5 5 3\nv -5 5 3\ng ceiling\nf 8 7 6 5\n";

/// Illuminance (last column) at points on a black floor below a black ceiling, with luminaires from a table.
std::vector<double> lux_below(const TemporaryFolder& folder, const std::string& table, const std::string& points) {
    write_text(folder / "floor.obj", floor_obj);
    write_text(folder / "floor.mtl", "newmtl grey\nKd 0 0 0\n");
    write_text(folder / "d.ies", downlight);
    write_text(folder / "l.csv", table);
    const Finished solved = run_program(
        {"solve", folder / "floor.obj", "--luminaires", folder / "l.csv", "-o", folder / "s.h5", "--progress", "none"});
    EXPECT_EQ(solved.status, 0) << solved.err;
    const Finished probed =
        run_program({"probe", folder / "s.h5", "--points", "-", "-o", "-"}, "x,y,z,nx,ny,nz\n" + points);
    EXPECT_EQ(probed.status, 0) << probed.err;
    std::vector<double> out;
    std::istringstream lines(probed.out);
    std::string line;
    std::getline(lines, line);
    EXPECT_TRUE(line.ends_with(",lux")) << line;
    while (std::getline(lines, line)) out.push_back(std::stod(line.substr(line.rfind(',') + 1)));
    return out;
}

/// Intensity of `downlight` at an angle from its axis, given by the cosine of that angle.
double intensity(double cosine) {
    const std::vector<double> table{1000, 965.9, 866, 707.1, 500, 258.8, 0};
    const double place = std::acos(std::clamp(cosine, 0.0, 1.0)) * 180 / std::numbers::pi / 15;
    const auto i = std::min<std::size_t>(5, static_cast<std::size_t>(place));
    return table[i] + (place - static_cast<double>(i)) * (table[i + 1] - table[i]);
}

/// Illuminance on a horizontal plane below an opening of 1.2 x 0.6 m, as a sum over 400 x 200 parts of the opening.
double finely_summed(double x, double y, double height) {
    double sum = 0;
    for (int i = 0; i < 400; ++i)
        for (int k = 0; k < 200; ++k) {
            const double dx = x - 1.2 * ((i + 0.5) / 400 - 0.5), dy = y - 0.6 * ((k + 0.5) / 200 - 0.5);
            const double r2 = dx * dx + dy * dy + height * height, cosine = height / std::sqrt(r2);
            sum += intensity(cosine) * cosine / r2 / (400 * 200);
        }
    return sum;
}

TEST(ProgramLuminaire, LightOfAnOpeningInACeilingIsTheSumOverItsParts) {
    const TemporaryFolder folder;
    const std::vector<double> lux = lux_below(folder, "file,x,y,z\nd.ies,0,0,3\n",
                                              "0,0,0,0,0,1\n2,1,0,0,0,1\n0.2,0.1,2.5,0,0,1\n0.9,0,2.9,0,0,1\n");
    ASSERT_EQ(lux.size(), 4u);
    EXPECT_NEAR(lux[0] / finely_summed(0, 0, 3), 1, 1e-3);
    EXPECT_NEAR(lux[1] / finely_summed(2, 1, 3), 1, 1e-3);
    EXPECT_NEAR(lux[2] / finely_summed(0.2, 0.1, 0.5), 1, 1e-3);
    EXPECT_NEAR(lux[3] / finely_summed(0.9, 0, 0.1), 1, 1e-3);
}

TEST(ProgramLuminaire, ATableIsInMetresWhateverTheUnitOfTheScene) {
    const TemporaryFolder folder;
    const std::string table = "file,x,y,z,rotation\nd.ies,0.5,0,2,90\n", points = "1,0.5,0,0,0,1\n0,1,0,0,0,1\n";
    const std::vector<double> plain = lux_below(folder, table, points);
    write_text(folder / "floor.obj",  // in millimetres, with Y up
               "mtllib floor.mtl\nv -5000 0 5000\nv 5000 0 5000\nv 5000 0 -5000\nv -5000 0 -5000\nusemtl grey\n"
               "f 1 2 3 4\nv -5000 3000 5000\nv 5000 3000 5000\nv 5000 3000 -5000\nv -5000 3000 -5000\ng ceiling\n"
               "f 8 7 6 5\n");
    const Finished solved = run_program({"solve", folder / "floor.obj", "--length-unit", "mm", "--up", "y",
                                         "--luminaires", folder / "l.csv", "-o", folder / "mm.h5", "-q"});
    ASSERT_EQ(solved.status, 0) << solved.err;
    const Finished probed =
        run_program({"probe", folder / "mm.h5", "--points", "-", "-o", "-"}, "x,y,z,nx,ny,nz\n" + points);
    std::istringstream lines(probed.out);
    std::string line;
    std::getline(lines, line);
    for (const double lux : plain) {
        ASSERT_TRUE(std::getline(lines, line));
        EXPECT_NEAR(std::stod(line.substr(line.rfind(',') + 1)), lux, 1e-4 * lux);
    }
}

TEST(ProgramLuminaire, EmittingMaterialsWithoutFacesDoNotChangeTheUnit) {
    const TemporaryFolder folder;
    const std::string table = "file,x,y,z\nd.ies,0,0,2\n", points = "1,0.5,0,0,0,1\n";
    const std::vector<double> plain = lux_below(folder, table, points);
    write_text(folder / "floor.mtl", "newmtl grey\nKd 0 0 0\nnewmtl lamp\nKe 1 1 1\n");
    const Finished solved = run_program(
        {"solve", folder / "floor.obj", "--luminaires", folder / "l.csv", "-o", folder / "s.h5", "--progress", "none"});
    EXPECT_EQ(solved.status, 0);
    EXPECT_EQ(solved.err.find("in watts"), std::string::npos) << solved.err;
    const Finished probed =
        run_program({"probe", folder / "s.h5", "--points", "-", "-o", "-"}, "x,y,z,nx,ny,nz\n" + points);
    EXPECT_NEAR(std::stod(probed.out.substr(probed.out.rfind(',') + 1)), plain[0], 1e-6 * plain[0]);
}

TEST(ProgramLuminaire, ATableRotatesAndDimsLuminaires) {
    const TemporaryFolder folder;
    const std::vector<double> plain = lux_below(folder, "file,x,y,z\nd.ies,0,0,2\n", "1,0,0,0,0,1\n0,1,0,0,0,1\n");
    const std::vector<double> turned = lux_below(folder,
                                                 "# a comment\nfile,x,y,z,rotation,dimming,lumens,maintenance_factor,"
                                                 "group\n\"d.ies\",0,0,2,90,0.5,2000,0.8,\"office, west\"\n",
                                                 "1,0,0,0,0,1\n0,1,0,0,0,1\n");
    ASSERT_EQ(turned.size(), 2u);
    EXPECT_NEAR(turned[1] / plain[0], 0.5 * 0.5 * 0.8, 1e-6);  // half of its 4000 lm
    EXPECT_NEAR(turned[0] / plain[1], 0.5 * 0.5 * 0.8, 1e-6);
    const std::vector<double> aimed =
        lux_below(folder, "file,x,y,z,aim_x,aim_y,aim_z\nd.ies,0,0,2,1,0,-1\n", "2,0,0,0,0,1\n-2,0,0,0,0,1\n");
    EXPECT_NEAR(aimed[0] / (1000 * std::sqrt(0.5) / 8), 1, 0.05);  // on its axis at 2.83 m, which is not quite far away
    EXPECT_NEAR(aimed[1], 0, 0.5);
}

TEST(ProgramLuminaire, ATableIsReadStrictly) {
    const TemporaryFolder folder;
    write_text(folder / "floor.obj", floor_obj);
    write_text(folder / "floor.mtl", "newmtl grey\nKd 0 0 0\n");
    write_text(folder / "d.ies", downlight);
    const auto message = [&](const std::string& table) {
        write_text(folder / "l.csv", table);
        const Finished ran = run_program({"check", folder / "floor.obj", "--luminaires", folder / "l.csv"});
        EXPECT_EQ(ran.status, 3) << table;
        return ran.err;
    };
    EXPECT_NE(message("file,x,y\nd.ies,0,0\n").find("l.csv:1: the header has no column z"), std::string::npos);
    EXPECT_NE(message("file,x,y,z,dimmer\nd.ies,0,0,1,1\n").find("no column 'dimmer'"), std::string::npos);
    EXPECT_NE(message("file,x,y,z\nd.ies,0,0,one\n").find("l.csv:2: 'one'"), std::string::npos);
    EXPECT_NE(message("file,x,y,z\ne.ies,0,0,1\n").find("e.ies"), std::string::npos);
    EXPECT_NE(message("file,x,y,z,dimming\nd.ies,0,0,1,2\n").find("dimming 2"), std::string::npos);
}

TEST(ProgramLuminaire, ANamedEmptyOfGltfIsALuminaire) {
    const TemporaryFolder folder;
    const std::string points = "1,0,0,0,0,1\n0,1,0,0,0,1\n";
    const std::vector<double> table = lux_below(folder, "file,x,y,z\nd.ies,0.5,0,2\n", points);
    write_text(folder / "e.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
                                  R"("nodes":[{"name":"d.ies.001","translation":[0.5,2,0]}]})");
    const Finished solved = run_program({"solve", folder / "floor.obj", folder / "e.gltf", "-o", folder / "g.h5"});
    EXPECT_EQ(solved.status, 0) << solved.err;
    const Finished probed = run_program({"probe", folder / "g.h5", "--points", "-"}, "x,y,z,nx,ny,nz\n" + points);
    const std::size_t last = probed.out.rfind(',');
    EXPECT_NEAR(std::stod(probed.out.substr(last + 1)), table[1], 1e-6 * table[1]);
}

}  // namespace
}  // namespace exitance::test
