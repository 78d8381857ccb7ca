#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "run_program.hpp"
#include "support/temporary_folder.hpp"

namespace exitance::test {
namespace {

void write_text(const std::string& path, const std::string& text) {
    std::ofstream(path) << text;
}

/// A closed box of 1 m, from the inside.
void write_box(const TemporaryFolder& folder) {
    write_text(folder / "box.mtl", "newmtl wall\nKd 0.5 0.5 0.5\n");
    write_text(folder / "box.obj",
               "mtllib box.mtl\nusemtl wall\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
               "f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 3 7 8 4\nf 1 4 8 5\nf 2 6 7 3\n");
}

}  // namespace

TEST(ProgramHeat, BalancesABoxFromItsViewFactors) {
    const TemporaryFolder folder;
    write_box(folder);
    ASSERT_EQ(run_program({"viewfactors", folder / "box.obj", "-o", folder / "f.h5", "-q"}).status, 0);
    write_text(folder / "t.csv", "surface,emissivity,temperature,heat\n0,0.8,,0\n1,,400,\n2,,300,\n");
    const Finished run = run_program({"heat", folder / "f.h5", "--table", folder / "t.csv", "-o", folder / "q.csv",
                                      "--exchange", folder / "x.csv", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("\"surfaces\": 6"), std::string::npos) << run.out;
    std::ifstream in(folder / "q.csv");
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "surface,area,emissivity,temperature,radiosity,heat");
    std::vector<double> temperature, heat;
    while (std::getline(in, line)) {
        double row[6];
        ASSERT_EQ(
            std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", row, row + 1, row + 2, row + 3, row + 4, row + 5), 6);
        temperature.push_back(row[3]), heat.push_back(row[5]);
    }
    ASSERT_EQ(heat.size(), 6u);
    EXPECT_NEAR(heat[0] + heat[1], 0, 1e-6 * heat[0]);  // the four walls are adiabatic
    EXPECT_GT(heat[0], 0);
    for (std::size_t i = 2; i < 6; ++i) {
        EXPECT_NEAR(heat[i], 0, 1e-6 * heat[0]);
        // Symmetry: the exitance of the walls is the mean of the floor's and the ceiling's.
        EXPECT_NEAR(std::pow(temperature[i], 4), 0.5 * (std::pow(400, 4) + std::pow(300, 4)), 1e-3 * std::pow(400, 4));
    }
    EXPECT_TRUE(std::ifstream(folder / "x.csv").good());
}

TEST(ProgramHeat, SaysWhatIsWrong) {
    const TemporaryFolder folder;
    write_box(folder);
    ASSERT_EQ(run_program({"viewfactors", folder / "box.obj", "-o", folder / "f.h5", "-q"}).status, 0);
    const auto heat = [&](const std::string& table) {
        write_text(folder / "t.csv", table);
        return run_program({"heat", folder / "f.h5", "--table", folder / "t.csv"});
    };
    EXPECT_NE(heat("surface,temperature\n7,300\n").err.find("there is no surface 7"), std::string::npos);
    EXPECT_NE(heat("surface,heat\n0,0\n").err.find("nothing determines"), std::string::npos);
    EXPECT_EQ(run_program({"heat", folder / "box.obj", "--table", folder / "t.csv"}).status, 3);
    EXPECT_EQ(run_program({"heat", folder / "f.h5"}).status, 2);
}

}  // namespace exitance::test
