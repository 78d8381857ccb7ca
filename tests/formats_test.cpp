// Files that released versions of the program wrote, and that every later version reads (docs/developers/releasing.md).

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "exitance/base/version.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/io/view_factors/operator_file.hpp"
#include "exitance/io/view_factors/view_factor_file.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"
#include "support/places.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

/// The folders with stored files, one per version.
std::vector<fs::path> versions() {
    std::vector<fs::path> out;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(fs::path(test::source_folder()) / "tests/data/formats"))
        if (fs::exists(entry.path() / "solution.h5")) out.push_back(entry.path());
    return out;
}

/// Rows of numbers of a table with a header.
std::vector<std::vector<double>> rows_of(const fs::path& path) {
    std::vector<std::vector<double>> rows;
    std::ifstream in(path);
    std::string line, cell;
    for (std::getline(in, line); std::getline(in, line);) {
        std::istringstream cells(line);
        for (rows.emplace_back(); std::getline(cells, cell, ',');)
            rows.back().push_back(std::strtod(cell.c_str(), nullptr));
    }
    return rows;
}

std::string bytes_of_file(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

}  // namespace

TEST(StoredFiles, ThereAreSomeOfThisVersion) {
    EXPECT_TRUE(fs::exists(fs::path(test::source_folder()) / "tests/data/formats" / program_version))
        << "tests/data/formats/make writes them";
}

TEST(StoredFiles, SolutionsOfAllVersionsHaveTheLightThatTheyHad) {
    for (const fs::path& folder : versions()) {
        const Result<Solution> solution = load_solution(folder / "solution.h5");
        ASSERT_TRUE(solution) << folder << ": " << solution.error().message;
        EXPECT_LE(solution->statistics.relative_error_estimate.value_or(1), 0.3) << folder;
        const RadiosityFunction light(*solution);
        const std::vector<std::vector<double>> rows = rows_of(folder / "light.csv");
        ASSERT_EQ(rows.size(), 3u) << folder;
        for (const std::vector<double>& row : rows) {
            const ProbePoint point{{row[0], row[1], row[2]}, {row[3], row[4], row[5]}};
            const Spectrum E = light.at({&point, 1})[0].irradiance;
            // Points in the air gather by rays, whose numbers may change: a thousandth. The table has ten digits.
            for (std::size_t b = 0; b < bands; ++b) EXPECT_NEAR(E[b], row[6 + b], 1e-3 * row[6 + b]) << folder;
        }
    }
}

TEST(StoredFiles, LightGroupsOfAllVersionsCanBeDimmed) {
    for (const fs::path& folder : versions()) {
        LightGroups groups;
        Result<Solution> solution = load_solution(folder / "groups.h5", Rehearsed::not_yet, &groups);
        ASSERT_TRUE(solution) << folder << ": " << solution.error().message;
        ASSERT_FALSE(groups.empty()) << folder;
        EXPECT_TRUE(change_light(*solution, groups, {.dim = {{"lamp", 0.5}}})) << folder;
    }
}

TEST(StoredFiles, ViewFactorsOfAllVersionsAreRead) {
    for (const fs::path& folder : versions()) {
        const Result<SparseFactors> factors = read_view_factors(folder / "view_factors.h5");
        ASSERT_TRUE(factors) << folder << ": " << factors.error().message;
        ASSERT_EQ(factors->size(), 7u) << folder;
        // Rows of walls sum to 1, less a share of at most a tenth that meets the back of the lamp.
        for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(factors->row_sums[i], 0.95, 0.1) << folder;
    }
}

TEST(StoredFiles, OperatorsOfAllVersionsAreRead) {
    for (const fs::path& folder : versions()) {
        const Result<FactorOperator> transport = read_factor_operator(folder / "operator.h5");
        ASSERT_TRUE(transport) << folder << ": " << transport.error().message;
        ASSERT_EQ(transport->size(), 7u) << folder;
        std::vector<double> ones(7, 1), sums(7);
        transport->apply(ones, sums);
        for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(sums[i], 0.95, 0.1) << folder;
    }
}

/// Light maps are read by other programs: their table keeps its keys while it says version 1.
TEST(StoredFiles, LightMapsOfAllVersionsKeepTheirForm) {
    for (const fs::path& folder : versions()) {
        const auto table = nlohmann::json::parse(bytes_of_file(folder / "light_maps/lightmaps.json"));
        ASSERT_EQ(table.at("version"), 1) << folder;
        ASSERT_EQ(table.at("maps").size(), 1u) << folder;
        const auto& map = table["maps"][0];
        const std::string image = bytes_of_file(folder / "light_maps" / map.at("file").get<std::string>());
        EXPECT_EQ(image.substr(0, 4), "\x76\x2f\x31\x01") << "an OpenEXR file";
        ASSERT_EQ(table.at("charts").size(), 7u) << folder;
        for (const auto& chart : table["charts"]) {
            EXPECT_LE(chart.at("x").get<int>() + chart.at("width").get<int>(), map.at("width").get<int>()) << folder;
            EXPECT_LE(chart.at("y").get<int>() + chart.at("height").get<int>(), map.at("height").get<int>()) << folder;
            for (const char* vector : {"origin", "du", "dv", "normal"}) EXPECT_EQ(chart.at(vector).size(), 3u);
        }
        const std::string model = folder / "light_maps" / table.at("model").get<std::string>();
        const CheckedScene scene = load_scene(model);
        ASSERT_TRUE(scene.scene) << folder;
        double area = 0;
        for (const Surface& surface : scene.scene->surfaces()) area += surface.area;
        EXPECT_NEAR(area, 60, 1e-4) << "six walls and the lamp";
    }
}

/// The version is in CMakeLists.txt. Two files repeat it for their readers.
TEST(Version, IsThatOfTheCitationAndOfTheChanges) {
    const fs::path root = test::source_folder();
    const std::string version = program_version;
    EXPECT_NE(bytes_of_file(root / "CITATION.cff").find("version: " + version + "\n"), std::string::npos);
    std::smatch heading;
    const std::string changes = bytes_of_file(root / "CHANGELOG.md");
    ASSERT_TRUE(std::regex_search(changes, heading, std::regex("\n## ([0-9.]+)")));
    EXPECT_EQ(heading[1], version);
}

}  // namespace exitance
