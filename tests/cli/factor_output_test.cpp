// Outputs of `exitance viewfactors` and `heat` for thermal solvers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "cli/small_scene.hpp"
#include "exitance/io/solution/hdf5_file.hpp"

namespace exitance::test {
namespace {

/// The rows of a CSV file, without its header.
std::vector<std::vector<double>> numbers_of(const std::string& path) {
    std::vector<std::vector<double>> rows;
    std::istringstream text(read_text(path));
    std::string line;
    std::getline(text, line);
    while (std::getline(text, line)) {
        std::istringstream fields(line);
        rows.emplace_back();
        for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(std::stod(field));
    }
    return rows;
}

/// A closed duct of 1 x 1 x 4 m with two materials.
std::string write_duct(const TemporaryFolder& folder) {
    EXPECT_EQ(run_program({"generate", "tube", "length=4", "-o", folder / "duct.obj"}).status, 0);
    return folder / "duct.obj";
}

}  // namespace

TEST(FactorOutput, PairsWithSkyAndBacksSumToOne) {
    const TemporaryFolder folder;
    const Finished run = run_program({"viewfactors", write_small_room(folder), "-o", folder / "f.csv", "--format",
                                      "pairs", "--sky", "--error", "3e-3", "--check", "0"});
    ASSERT_EQ(run.status, 0) << run.err;
    std::map<double, double> sums;
    double to_backs = 0;
    for (const std::vector<double>& pair : numbers_of(folder / "f.csv")) {
        ASSERT_EQ(pair.size(), 3u);
        EXPECT_LE(pair[1], 8);  // 7 faces, the sky, backs of faces
        sums[pair[0]] += pair[2], to_backs += pair[1] == 8 ? pair[2] : 0;
    }
    EXPECT_EQ(sums.size(), 7u);
    for (const auto& [from, sum] : sums) EXPECT_NEAR(sum, 1, 1e-6) << from;  // closure distributes the defect
    EXPECT_GT(to_backs, 0.05);                                               // the ceiling sees the back of the lamp
}

TEST(FactorOutput, NodesAreMeansOfTheirFaces) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    const std::vector<std::string> work{"viewfactors", scene, "--error", "3e-3", "--check", "0", "-o"};
    const auto rows_with = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> words = work;
        words.push_back(folder / name);
        words.insert(words.end(), more.begin(), more.end());
        const Finished run = run_program(words);
        EXPECT_EQ(run.status, 0) << run.err;
        return numbers_of(folder / name);
    };
    const auto faces = rows_with("faces.csv", {});
    const auto groups = rows_with("groups.csv", {"--nodes", "group"});
    write_text(folder / "nodes.csv", "face,node\n1,floor\n2,ceiling\n3,walls\n4,walls\n5,walls\n6,walls\n7,lamp\n");
    EXPECT_EQ(rows_with("table.csv", {"--nodes", folder / "nodes.csv"}), groups);
    ASSERT_EQ(groups.size(), 4u);  // floor, ceiling, walls, lamp
    EXPECT_NEAR(groups[2][1], 35, 1e-12);
    constexpr std::size_t first = 3;  // columns surface, area, row_sum
    for (const std::size_t row : {0u, 1u})
        EXPECT_NEAR(groups[row][first + 2],
                    faces[row][first + 2] + faces[row][first + 3] + faces[row][first + 4] + faces[row][first + 5],
                    1e-12);
    EXPECT_NEAR(groups[2][1] * groups[2][first], groups[0][1] * groups[0][first + 2], 1e-9);  // reciprocity
    EXPECT_GT(groups[2][first + 2], 0.2);                                                     // walls see each other
    EXPECT_EQ(rows_with("materials.csv", {"--nodes", "material"}).size(), 2u);
    EXPECT_EQ(run_program({"viewfactors", scene, "-o", folder / "x.csv", "--nodes", folder / "absent.csv"}).status, 3);
    write_text(folder / "wide.csv", "face,node\n1,floor,2\n");
    const Finished wide = run_program({"viewfactors", scene, "-o", folder / "x.csv", "--nodes", folder / "wide.csv"});
    EXPECT_EQ(wide.status, 3);
    EXPECT_NE(wide.err.find("more than two fields"), std::string::npos) << wide.err;
}

/// A mistake in the table of emissivities is told before hours of work, and leaves no work file.
TEST(FactorOutput, EmissivitiesAreReadBeforeTheWork) {
    const TemporaryFolder folder;
    write_text(folder / "e.csv", "surface,emissivity\n1,1.5\n");
    const Finished run =
        run_program({"viewfactors", write_small_room(folder), "-o", folder / "f.h5", "--emissivity", folder / "e.csv"});
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("e.csv:2"), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "f.h5.rows"));
}

TEST(FactorOutput, EnergyPlusAndOpenFoamHaveEveryRow) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    const Finished idf = run_program(
        {"viewfactors", scene, "-o", folder / "f.idf", "--zone", "hall", "--error", "1e-2", "--check", "0"});
    ASSERT_EQ(idf.status, 0) << idf.err;
    const std::string text = read_text(folder / "f.idf");
    EXPECT_TRUE(text.starts_with("ZoneProperty:UserViewFactors:BySurfaceName,\n  hall,\n  floor,floor,0,\n")) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2 + 7 * 7);
    EXPECT_NE(text.find("walls 4,lamp,"), std::string::npos) << text;
    const Finished foam = run_program(
        {"viewfactors", scene, "-o", folder / "constant", "--format", "openfoam", "--error", "1e-2", "--check", "0"});
    ASSERT_EQ(foam.status, 0) << foam.err;
    for (const char* file : {"F", "globalFaceFaces"}) {
        const std::string list = read_text(std::string(folder / "constant/") + file);
        EXPECT_NE(list.find(std::string("object      ") + file), std::string::npos) << list;
        EXPECT_NE(list.find("\n7\n(\n"), std::string::npos) << list;
    }
}

/// Every row of Gebhart's factors of an enclosure sums to 1: what a surface emits is absorbed somewhere.
TEST(FactorOutput, GebhartFactorsOfAnEnclosureSumToOne) {
    const TemporaryFolder folder;
    const Finished run = run_program({"viewfactors", write_duct(folder), "-o", folder / "f.h5", "--emissivity", "kd",
                                      "--tolerance", "1e-6", "--check", "0"});
    ASSERT_EQ(run.status, 0) << run.err;
    auto file = Hdf5Reader::open(folder / "f.h5");
    ASSERT_TRUE(file) << file.error().message;
    const std::vector<double> gebhart = file->read<double>("view_factors/gebhart", 6, 6);
    const std::vector<double> script_f = file->read<double>("view_factors/script_f", 6, 6);
    const std::vector<double> emittances = file->read<double>("view_factors/emittances", 1, 6);
    write_text(folder / "table.csv", "surface,temperature\n0,300\n1,800\n");
    const Finished heat =
        run_program({"heat", folder / "f.h5", "--table", folder / "table.csv", "-o", folder / "heat.csv", "--exchange",
                     folder / "x.csv", "--gebhart", folder / "g.csv", "--json"});
    ASSERT_EQ(heat.status, 0) << heat.err;
    const auto x = numbers_of(folder / "x.csv"), g = numbers_of(folder / "g.csv"), Q = numbers_of(folder / "heat.csv");
    const double sigma = 5.670374419e-8;  // CODATA 2018
    for (std::size_t i = 0; i < 6; ++i) {
        double sum = 0, loses = 0;
        for (std::size_t j = 0; j < 6; ++j) {
            sum += gebhart[6 * i + j];
            EXPECT_NEAR(script_f[6 * i + j], emittances[i] * gebhart[6 * i + j], 1e-12);
            EXPECT_NEAR(x[i][3 + j], script_f[6 * i + j], 1e-9);
            EXPECT_NEAR(g[i][3 + j], gebhart[6 * i + j], 1e-9);
            const auto power = [&](std::size_t k) { return sigma * std::pow(k == 0 ? 800.0 : 300.0, 4); };
            loses += x[i][1] * x[i][3 + j] * (power(i) - power(j));
        }
        EXPECT_NEAR(sum, 1, 1e-6) << i;
        EXPECT_NEAR(Q[i][5], loses, 1e-5 * Q[0][5]) << i;  // the same heat as by the radiosities
    }
}

TEST(FactorOutput, OptionsThatDoNotApplyToTheFormatAreUsageErrors) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    const std::vector<std::vector<std::string>> wrong = {{"f.vf", "--sky"},
                                                         {"f.h5", "--sky"},
                                                         {"f.csv", "--sky", "--tolerance", "1e-3"},
                                                         {"f.csv", "--zone", "hall"},
                                                         {"f.csv", "--emissivity", "kd"},
                                                         {"f.csv", "--format", "nastran"}};
    for (std::vector<std::string> words : wrong) {
        words.front() = folder / words.front();
        words.insert(words.begin(), {"viewfactors", scene, "-o"});
        const Finished run = run_program(words);
        EXPECT_EQ(run.status, 2) << words.back();
        EXPECT_FALSE(std::filesystem::exists(words[3])) << words.back();
    }
    write_text(folder / "one.vs3", "F 3\nV 1 0 0 0\nV 2 1 0 0\nV 3 0 1 0\nS 1 1 2 3 0 0 0 0.9 low\nE\n");
    EXPECT_EQ(run_program({"viewfactors", folder / "one.vs3", "-o", folder / "f.csv", "--nodes", "material"}).status,
              2);
    EXPECT_EQ(run_program({"viewfactors", folder / "one.vs3", "-o", folder / "f.csv", "--nodes", "group"}).status, 0);
}

}  // namespace exitance::test
