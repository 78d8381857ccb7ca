#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>
#include "support/places.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

/// Folders whose numbers decide work.
const std::vector<std::string> deciding{"accuracy", "links", "methods", "reconstruct"};

/// Parts of these that no solve goes through: what a picture, a light map, a standard or a study asks for stands with
/// it; methods whose numbers are those of their papers; limits of what users may give; and forecasts.
const std::vector<std::string> apart{"reconstruct/pictures/",
                                     "reconstruct/light_maps/",
                                     "reconstruct/glare/",
                                     "reconstruct/measuring_grid.cpp",
                                     "reconstruct/working_plane.cpp",
                                     "reconstruct/surface_levels.cpp",
                                     "reconstruct/error/compare.cpp",
                                     "methods/daylight/",
                                     "methods/classical/",
                                     "methods/growing_cells/",
                                     "methods/options/",
                                     "methods/tasks/",
                                     "methods/plan/forecast.cpp"};

bool is_below(const std::vector<std::string>& places, const std::string& file) {
    return std::any_of(places.begin(), places.end(), [&](const std::string& p) { return file.starts_with(p); });
}

/// The numbers that nobody has to explain.
bool is_plain(double value) {
    const std::vector<double> plain{0, 0.5, 1, 2, 4};
    return std::find(plain.begin(), plain.end(), value) != plain.end();
}

std::vector<double> literals(std::string line) {
    static const std::regex text(R"re("(\\.|[^"\\])*")re"), comment("//.*");
    static const std::regex number(R"((^|[^\w.])((\d+\.\d*|\.\d+)([eE][+-]?\d+)?|\d+[eE][+-]?\d+)f?(?![\w.]))");
    line = std::regex_replace(std::regex_replace(line, text, "\"\""), comment, "");
    std::vector<double> out;
    for (std::sregex_iterator at(line.begin(), line.end(), number), end; at != end; ++at)
        out.push_back(std::stod((*at)[2]));
    return out;
}

/// Places with a literal that decides work and has no home: neither in the table of calibrated numbers nor marked, on
/// its line or in the comment right above, as "given by" mathematics, rounding or a source.
std::vector<std::string> homeless_literals(const std::string& name, std::istream& in) {
    static const std::regex marker("//.*[gG]iven by ");
    std::vector<std::string> out;
    std::string line, last;
    bool is_marked = false;  // by the comment above
    for (int number = 1; std::getline(in, line); ++number) {
        const bool here = std::regex_search(line, marker);
        const bool is_comment = line.find_first_not_of(' ') == line.find("//");
        if (!here && !is_marked)
            for (const double value : literals(line))
                if (!is_plain(value)) out.push_back(name + ":" + std::to_string(number) + ": " + line);
        is_marked = is_comment && (here || is_marked);
    }
    return out;
}

}  // namespace

TEST(Literals, ThatDecideWorkStandInTheTable) {
    const fs::path root = fs::path(test::source_folder()) / "src/exitance";
    std::size_t files = 0;
    for (const std::string& folder : deciding)
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
            const std::string name = fs::relative(entry.path(), root);
            const bool is_code = name.ends_with(".cpp") || name.ends_with(".hpp");
            if (!is_code || name.ends_with("_test.cpp") || is_below(apart, name)) continue;
            std::ifstream in(entry.path());
            for (const std::string& place : homeless_literals(name, in))
                ADD_FAILURE() << place << "\nbelongs into calibration/numbers.inc, or says what it is given by";
            ++files;
        }
    EXPECT_GT(files, 20u);
}

TEST(Literals, AreFoundUnlessTheySayWhatTheyAreGivenBy) {
    const auto count = [](const std::string& code) {
        std::istringstream in(code);
        return homeless_literals("x.cpp", in).size();
    };
    EXPECT_EQ(count("const double a = 0.7 * b + 1e-3;\n"), 2u);
    EXPECT_EQ(count("const double a = 0.5 * b + 2.0 + x1.y;  // 0.7\n"), 0u);
    EXPECT_EQ(count("const double a = 1e-12;  // given by rounding\n"), 0u);
    EXPECT_EQ(count("// Given by the rule\n// of Gauss.\nconst double a = 0.77;\nconst double b = 0.3;\n"), 1u);
    EXPECT_EQ(count("print(\"0.7\", 17, 0x1p20);\n"), 0u);
}

}  // namespace exitance
