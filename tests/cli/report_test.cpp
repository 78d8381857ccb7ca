#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "cli/small_scene.hpp"

namespace exitance::test {
namespace {

/// The numbers after a key, up to the closing bracket.
std::vector<double> numbers_after(const std::string& json, const std::string& key, std::size_t from = 0) {
    std::vector<double> out;
    std::size_t at = json.find("\"" + key + "\": [", from);
    if (at == std::string::npos) return out;
    at = json.find('[', at) + 1;
    const std::string list = json.substr(at, json.find(']', at) - at);
    std::istringstream in(std::regex_replace(list, std::regex(","), " "));
    for (double value; in >> value;) out.push_back(value);
    return out;
}

}  // namespace

TEST(ProgramReport, IsOnePageWithItsNumbersBesideIt) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", page = folder / "room.html";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const Finished run = run_program({"report", solution, "-o", page, "--size", "64x40", "--grid",
                                      "0.5,0.5,0 3,0,0 0,2,0 0.5", "--grid", "1,1,1 1,0,0 0,1,0 auto 0.1"});
    ASSERT_EQ(run.status, 0) << run.err;
    const std::string html = read_text(page), json = read_text(folder / "room.json");
    for (const std::string id :
         {"pictures", "walk", "grids", "materials", "surfaces", "energy", "error", "method", "warnings"})
        EXPECT_NE(html.find("<section id=\"" + id + "\">"), std::string::npos) << id;
    EXPECT_EQ(html.find("src=\"http"), std::string::npos);
    EXPECT_EQ(html.find("href=\"http"), std::string::npos);
    // The twin stands within the page as it is, and the page's tables show its numbers.
    EXPECT_NE(html.find(json), std::string::npos);
    std::smatch mean;
    ASSERT_TRUE(
        std::regex_search(json, mean, std::regex("\"surface\": 0,.*\"irradiance\": \\{\"mean\": ([0-9.e-]+),")));
    EXPECT_NE(html.find("<td>" + mean[1].str() + "</td>"), std::string::npos);

    const std::vector<double> values = numbers_after(json, "values");
    ASSERT_EQ(values.size(), 6u * 4u);
    std::string points = "x,y,z,nx,ny,nz\n";
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 6; ++column)
            points += std::to_string(0.75 + 0.5 * column) + "," + std::to_string(0.75 + 0.5 * row) + ",0,0,0,1\n";
    const Finished probe = run_program({"probe", solution, "--points", "-"}, points);
    ASSERT_EQ(probe.status, 0) << probe.err;
    std::istringstream lines(probe.out);
    std::string line;
    std::getline(lines, line);
    for (const double value : values) {
        std::getline(lines, line);
        double x, y, z, nx, ny, nz, r, g, b;
        ASSERT_EQ(
            std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &x, &y, &z, &nx, &ny, &nz, &r, &g, &b), 9)
            << line;
        EXPECT_NEAR(value, (r + g + b) / 3, 1e-4 * value);  // five digits
    }
}

TEST(ProgramReport, TellsNamesAsTextAndLuxWhenAsked) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), solution = folder / "room.h5", page = folder / "room.html";
    std::string text = read_text(scene);
    text.replace(text.find("g floor"), 7, "g <b>&</script>");
    write_text(scene, text);
    ASSERT_EQ(run_program({"solve", scene, "-o", solution, "--error", "0.1", "-q"}).status, 0);
    ASSERT_EQ(run_program({"report", solution, "-o", page, "--size", "32x20", "--unit", "lux", "--camera",
                           "0.5,0.5,1 3,2,1 60", "--camera", "auto", "-q"})
                  .status,
              0);
    const std::string html = read_text(page);
    EXPECT_NE(html.find("&lt;b&gt;&amp;&lt;/script&gt;"), std::string::npos);
    EXPECT_EQ(html.find("<b>&</script>"), std::string::npos);
    EXPECT_NE(html.find("Illuminance in lx"), std::string::npos);
    EXPECT_NE(read_text(folder / "room.json").find("\"unit\": \"lx\""), std::string::npos);
}

TEST(ProgramReport, RefusesWhatCannotBeDone) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", page = folder / "room.html";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    EXPECT_EQ(run_program({"report", solution, "-o", folder / "room.pdf"}).status, 2);
    EXPECT_EQ(run_program({"report", solution, "-o", page, "--grid", "1,2,3"}).status, 2);
    EXPECT_EQ(run_program({"report", solution, "-o", page, "--grid", "0,0,0 1,0,0 0,1,0 -1"}).status, 2);
    EXPECT_EQ(run_program({"report", solution, "-o", page, "--grid", "0,0,0 1,0,0 2,0,0 0.1"}).status, 2);
    EXPECT_EQ(run_program({"report", solution, "-o", page, "--camera", "nowhere"}).status, 2);
    EXPECT_EQ(run_program({"report", folder / "absent.h5", "-o", page}).status, 3);
    EXPECT_FALSE(std::filesystem::exists(page));
}

TEST(ProgramReport, LuxAreWattsByTheEfficacy) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", points = "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const auto last = [&](std::vector<std::string> more, double* bands) {
        std::vector<std::string> words{"probe", solution, "--points", "-"};
        words.insert(words.end(), more.begin(), more.end());
        const Finished run = run_program(words, points);
        EXPECT_EQ(run.status, 0) << run.err;
        const std::string row = run.out.substr(run.out.find('\n') + 1);
        EXPECT_EQ(std::sscanf(row.c_str(), "1,1,0,0,0,1,%lf,%lf,%lf", bands, bands + 1, bands + 2), 3) << row;
        return std::stod(row.substr(row.rfind(',') + 1));
    };
    double E[3];
    const double lux = last({"--unit", "lux"}, E);
    const double expected = 0.265 * E[0] + 0.670 * E[1] + 0.065 * E[2];
    EXPECT_NEAR(lux, 179 * expected, 1e-6 * lux);
    EXPECT_NEAR(last({"--unit", "lux", "--efficacy", "100"}, E), 100 * expected, 1e-6 * lux);
    EXPECT_NEAR(last({"--unit", "w"}, E), (E[0] + E[1] + E[2]) / 3, 1e-6 * lux);
    EXPECT_EQ(run_program({"probe", solution, "--points", "-", "--efficacy", "100"}, points).status, 2);
    EXPECT_EQ(run_program({"render", solution, "-o", folder / "a.png", "--unit", "lux"}).status, 2);
    EXPECT_EQ(run_program({"render", solution, "-o", folder / "a.png", "--unit", "lux", "--false-colour", "irradiance",
                           "--size", "16x10", "-q"})
                  .status,
              0);
}

}  // namespace exitance::test
