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

/// Folders in which numbers control the amount of work.
const std::vector<std::string> deciding{"links",     "solution",      "gather",
                                        "evaluate",  "discontinuity", "error",
                                        "reference", "methods",       "what_if/light_groups"};

/// Exceptions, which no solve uses.
const std::vector<std::string> apart{"evaluate/surface_levels.cpp", "reference/compare.cpp", "methods/options/",
                                     "methods/plan/forecast.cpp"};

bool is_below(const std::vector<std::string>& places, const std::string& file) {
    return std::any_of(places.begin(), places.end(), [&](const std::string& p) { return file.starts_with(p); });
}

/// True for numbers that need no explanation.
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

/// Lines with a number that controls work but has no origin: it is not in the table of calibrated numbers, and no
/// comment on its line or directly above says what it is given by or derived from, or how it was measured.
std::vector<std::string> unexplained_literals(const std::string& name, std::istream& in) {
    static const std::regex origin("//.*([gG]iven by|[dD]erived from|[mM]easured) ");
    std::vector<std::string> out;
    std::string line;
    bool is_explained = false;  // by the comment directly above
    for (int number = 1; std::getline(in, line); ++number) {
        const bool here = std::regex_search(line, origin);
        const bool is_comment = line.find_first_not_of(' ') == line.find("//");
        if (!here && !is_explained)
            for (const double value : literals(line))
                if (!is_plain(value)) out.push_back(name + ":" + std::to_string(number) + ": " + line);
        is_explained = is_comment && (here || is_explained);
    }
    return out;
}

}  // namespace

TEST(Literals, ThatControlWorkAreInTheTable) {
    const fs::path root = fs::path(test::source_folder()) / "src/exitance";
    std::size_t files = 0;
    for (const std::string& folder : deciding)
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
            const std::string name = fs::relative(entry.path(), root);
            const bool is_code = name.ends_with(".cpp") || name.ends_with(".hpp");
            if (!is_code || name.ends_with("_test.cpp") || is_below(apart, name)) continue;
            std::ifstream in(entry.path());
            for (const std::string& place : unexplained_literals(name, in))
                ADD_FAILURE() << place
                              << "\nneeds a comment that says what it is derived from or how it was measured, or a "
                                 "place in calibration/numbers.inc";
            ++files;
        }
    EXPECT_GT(files, 20u);
}

TEST(Literals, AreFoundUnlessTheirOriginIsGiven) {
    const auto count = [](const std::string& code) {
        std::istringstream in(code);
        return unexplained_literals("x.cpp", in).size();
    };
    EXPECT_EQ(count("const double a = 0.7 * b + 1e-3;\n"), 2u);
    EXPECT_EQ(count("const double a = 0.5 * b + 2.0 + x1.y;  // 0.7\n"), 0u);
    EXPECT_EQ(count("const double a = 1e-12;  // given by rounding\n"), 0u);
    EXPECT_EQ(count("// Given by the rule\n// of Gauss.\nconst double a = 0.77;\nconst double b = 0.3;\n"), 1u);
    EXPECT_EQ(count("print(\"0.7\", 17, 0x1p20);\n"), 0u);
}

}  // namespace exitance
