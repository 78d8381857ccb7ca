// `exitance view3d IN OUT` in place of NIST's View3D.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "cli/small_scene.hpp"

namespace exitance::test {
namespace {

/// The inside of a unit cube, with controls and emittance.
std::string cube(const std::string& controls, const std::string& emittance = "0.9") {
    std::string text = "T cube\nF 3\n" + controls + "\n";
    for (int k = 0; k < 8; ++k)
        text += "V " + std::to_string(k + 1) + " " + std::to_string(k & 1) + " " + std::to_string(k >> 1 & 1) + " " +
                std::to_string(k >> 2) + "\n";
    const char* faces[] = {"1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"};
    for (int i = 0; i < 6; ++i)
        text += "S " + std::to_string(i + 1) + " " + faces[i] + " 0 0 " + emittance + " face" + std::to_string(i + 1) +
                "\n";
    return text + "E\n";
}

/// The numbers of a text output after its header.
std::vector<double> numbers_in(const std::string& text) {
    std::istringstream in(text.substr(31));
    std::vector<double> out;
    for (double value; in >> value;) out.push_back(value);
    return out;
}

constexpr double opposite = 0.199825, adjacent = 0.200044;  // exact factors of a cube, to six digits

}  // namespace

TEST(ProgramView3d, WritesWhatView3dWrites) {
    const TemporaryFolder folder;
    write_text(folder / "cube.vs3", cube("C out=0 eps=1e-5"));
    const Finished run = run_program({"view3d", folder / "cube.vs3", folder / "cube.vf"});
    ASSERT_EQ(run.status, 0) << run.err;
    const std::string text = read_text(folder / "cube.vf");
    EXPECT_EQ(text.substr(0, 31), "View3D 4.0.0 0 0 0 6          \n");
    const std::vector<double> numbers = numbers_in(text);
    ASSERT_EQ(numbers.size(), 6u + 36 + 6);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(numbers[i], 1);
        EXPECT_EQ(numbers[42 + i], 0.9);
        for (std::size_t j = 0; j < 6; ++j) {
            const double exact = i == j ? 0 : i / 2 == j / 2 ? opposite : adjacent;
            EXPECT_NEAR(numbers[6 + 6 * i + j], exact, 1.5e-6) << i << " " << j;  // both are rounded to six digits
        }
    }
}

TEST(ProgramView3d, WritesBinaryFilesOfTheSameNumbers) {
    const TemporaryFolder folder;
    write_text(folder / "cube.vs3", cube("C out=1,encl=1"));
    ASSERT_EQ(run_program({"view3d", folder / "cube.vs3", folder / "cube.vf"}).status, 0);
    const std::string bytes = read_text(folder / "cube.vf");
    ASSERT_EQ(bytes.size(), 32 + 4 * (2 * 6 + 36u));
    EXPECT_EQ(bytes.substr(0, 32), "View3D 4.0.0 1 1 0 6          \r\n");
    std::vector<float> numbers((bytes.size() - 32) / 4);
    std::memcpy(numbers.data(), bytes.data() + 32, 4 * numbers.size());
    for (std::size_t i = 0; i < 6; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < 6; ++j) sum += double(numbers[6 + 6 * i + j]);
        EXPECT_NEAR(sum, 1, 1e-6) << "an enclosure's rows add up to 1, up to the rounding of 32 bits";
    }
}

/// The lower triangle of A_i F_ij, five numbers in a line.
TEST(ProgramView3d, WritesExchangeAreasWithNames) {
    const TemporaryFolder folder;
    write_text(folder / "cube.vs3", cube("C out=2 eps=1e-5"));
    const Finished run = run_program({"view3d", folder / "cube.vs3", folder / "cube.vf"});
    ASSERT_EQ(run.status, 0) << run.err;
    std::istringstream in(read_text(folder / "cube.vf"));
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "View3D 4.0.0 2 0 0 6          ");
    std::getline(in, line);
    EXPECT_EQ(line, "T cube");
    std::getline(in, line);
    EXPECT_EQ(line, "!  #     area          emit    name");
    std::size_t lines = 3;
    for (int i = 0; i < 6; ++i) {
        int number = 0;
        double area = 0, emittance = 0;
        std::string name;
        in >> number >> area >> emittance >> name;
        EXPECT_EQ(number, i + 1);
        EXPECT_EQ(area, 1);
        EXPECT_EQ(emittance, 0.9);
        EXPECT_EQ(name, "face" + std::to_string(i + 1));
        for (int j = 0; j <= i; ++j) {
            double exchange = -1;
            in >> exchange;
            EXPECT_NEAR(exchange, i == j ? 0 : i / 2 == j / 2 ? opposite : adjacent, 1.5e-6) << i << " " << j;
        }
        lines += i < 5 ? 2 : 3;
    }
    const std::string text = read_text(folder / "cube.vf");
    EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')), lines + 1);  // and an empty line
}

/// A mask on a quarter of the floor faces the floor: it exchanges heat with the floor only, and hides the quarter.
TEST(ProgramView3d, AMaskExchangesHeatWithItsBaseOnly) {
    const TemporaryFolder folder;
    std::string text = cube("C out=0 eps=1e-5");
    text.insert(text.find("S 1"), "V 9 0.5 0 0\nV 10 0.5 0.5 0\nV 11 0 0.5 0\n");
    text.replace(text.find("E\n"), 2, "M 7 1 11 10 9 1 0 0.5 mask\nE\n");
    write_text(folder / "cube.vs3", text);
    const Finished run = run_program({"view3d", folder / "cube.vs3", folder / "cube.vf"});
    ASSERT_EQ(run.status, 0) << run.err;
    const std::vector<double> numbers = numbers_in(read_text(folder / "cube.vf"));
    ASSERT_EQ(numbers.size(), 7u + 49 + 7);
    const auto F = [&](std::size_t i, std::size_t j) { return numbers[7 + 7 * i + j]; };
    EXPECT_EQ(numbers[0], 1);     // all of the floor
    EXPECT_EQ(numbers[6], 0.25);  // the mask
    EXPECT_EQ(F(6, 0), 1);
    EXPECT_EQ(F(0, 6), 0.25);
    for (std::size_t i = 1; i < 6; ++i) {
        EXPECT_EQ(F(6, i), 0);
        EXPECT_EQ(F(i, 6), 0);
        EXPECT_NEAR(F(i, 0), F(0, i), 1.5e-6);  // equal areas; both are rounded to six digits
    }
    // Each quarter of the floor takes a quarter of the light from the ceiling, for reasons of symmetry.
    EXPECT_NEAR(F(1, 0), 0.75 * opposite, 1.5e-6);
    // The floor's exposed part sees the ceiling and the walls only.
    double sum = 0;
    for (std::size_t j = 0; j < 7; ++j) sum += F(0, j);
    EXPECT_NEAR(sum, 1, 4e-6);  // seven numbers of six digits
}

TEST(ProgramView3d, EmittancesGiveExchangeFactors) {
    // In an enclosure of equal emittances e, each row of script F adds up to e.
    const TemporaryFolder folder;
    write_text(folder / "cube.vs3", cube("C emit=1 encl=1", "0.4"));
    const Finished run = run_program({"view3d", folder / "cube.vs3", folder / "cube.vf"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err.find("is ignored"), std::string::npos) << run.err;
    const std::vector<double> numbers = numbers_in(read_text(folder / "cube.vf"));
    for (std::size_t i = 0; i < 6; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < 6; ++j) sum += numbers[6 + 6 * i + j];
        EXPECT_NEAR(sum, 0.4, 6e-6) << "six numbers of six digits";
        EXPECT_GT(numbers[6 + 7 * i], 0) << "a face absorbs some of its own light";
    }
}

/// Two unit squares 1 m apart; a square of 0.5 m hides the middle half-way.
std::string hidden_plates(const std::string& controls) {
    return "T plates\nF 3\nC " + controls +
           "\nV 1 0 0 0\nV 2 1 0 0\nV 3 1 1 0\nV 4 0 1 0\nV 5 0 0 1\nV 6 1 0 1\nV 7 1 1 1\nV 8 0 1 1\n"
           "V 9 .25 .25 .5\nV 10 .75 .25 .5\nV 11 .75 .75 .5\nV 12 .25 .75 .5\n"
           "S 1 1 2 3 4 0 0 0.9 low\nS 2 8 7 6 5 0 0 0.9 high\nO 3 9 10 11 12\nE\n";
}

TEST(ProgramView3d, HonoursEps) {
    const TemporaryFolder folder;
    constexpr double exact = 0.0995062947;  // by `viewfactors --tolerance 1e-9`
    for (const char* controls : {"eps=1e-5", "EPS=1e-5", "out=0"}) {
        write_text(folder / "plates.vs3", hidden_plates(controls));
        const Finished run = run_program({"view3d", folder / "plates.vs3", folder / "plates.vf"});
        ASSERT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(run.err, "");
        EXPECT_NEAR(numbers_in(read_text(folder / "plates.vf"))[3], exact, 1.5e-6) << controls;  // six digits
    }
}

TEST(ProgramView3d, WarnsOfUnknownControlsByName) {
    const TemporaryFolder folder;
    write_text(folder / "plates.vs3", hidden_plates("epz=1e-5 bananas=7 maxU=8 MAXO=8 minO=0 list=0 prjD=0 maxV=64"));
    const Finished run = run_program({"view3d", folder / "plates.vs3", folder / "plates.vf"});
    EXPECT_EQ(run.status, 0);
    std::size_t warnings = 0;
    for (std::size_t at = run.err.find("has no control"); at != std::string::npos;
         at = run.err.find("has no control", at + 1))
        ++warnings;
    EXPECT_EQ(warnings, 2u) << run.err;
    EXPECT_NE(run.err.find("'epz=1e-05'"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("'bananas=7'"), std::string::npos) << run.err;
}

TEST(ProgramView3d, AnswersToTheNameOfView3d) {
    const TemporaryFolder folder;
    write_text(folder / "cube.vs3", cube(""));
    std::filesystem::create_symlink(test::program(), folder / "view3d");
    const Finished run = RunningProgram({folder / "cube.vs3", folder / "cube.vf"}, {}, folder / "view3d").finish();
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(numbers_in(read_text(folder / "cube.vf")).size(), 48u);
}

TEST(ProgramView3d, SaysWhatItCannotDo) {
    const TemporaryFolder folder;
    const std::string scene = folder / "cube.vs3", out = folder / "cube.vf";
    write_text(scene, cube("C out=3"));
    EXPECT_EQ(run_program({"view3d", scene, out}).status, 3);
    write_text(scene, cube("C out=0.5"));
    EXPECT_EQ(run_program({"view3d", scene, out}).status, 3);
    EXPECT_EQ(run_program({"view3d", folder / "none.vs3", out}).status, 3);
    EXPECT_EQ(run_program({"view3d", folder / "cube.obj", out}).status, 2);
    write_text(scene, cube(""));
    EXPECT_EQ(run_program({"view3d", scene, scene}).status, 2);
    EXPECT_FALSE(std::filesystem::exists(out));
    write_text(scene, cube("C row=2"));
    const Finished row = run_program({"view3d", scene, out});
    EXPECT_EQ(row.status, 0);
    EXPECT_NE(row.err.find("all rows are computed"), std::string::npos) << row.err;
}

}  // namespace exitance::test
