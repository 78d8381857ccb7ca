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

/// Folders of the engine in which numbers control the amount of work.
const std::vector<std::string> deciding{"direct",    "visibility", "mesh",         "transport",           "links",
                                        "solution",  "gather",     "evaluate",     "discontinuity",       "error",
                                        "reference", "methods",    "view_factors", "what_if/light_groups"};

/// Exceptions, which no solve uses.
const std::vector<std::string> apart{"evaluate/surface_levels.cpp", "reference/compare.cpp", "methods/options/",
                                     "methods/plan/forecast.cpp"};

/// Folders whose numbers still stem from measurements that are not reproducible by a command: there, "given by" and
/// "measured" without one are accepted, and fractions and integers are not examined.
const std::vector<std::string> measured_by_hand{"gather/", "error/", "methods/solver/", "methods/plan/"};

bool is_below(const std::vector<std::string>& places, const std::string& file) {
    return std::any_of(places.begin(), places.end(), [&](const std::string& p) { return file.starts_with(p); });
}

/// True for numbers that need no explanation.
bool is_plain(double value) {
    const std::vector<double> plain{0, 0.5, 1, 2, 4};
    return std::find(plain.begin(), plain.end(), value) != plain.end();
}

std::string code_of(const std::string& line) {
    static const std::regex text(R"re("(\\.|[^"\\])*")re"), comment("//.*");
    return std::regex_replace(std::regex_replace(line, text, "\"\""), comment, "");
}

std::vector<double> literals(const std::string& line) {
    static const std::regex number(R"((^|[^\w.])((\d+\.\d*|\.\d+)([eE][+-]?\d+)?|\d+[eE][+-]?\d+)f?(?![\w.]))");
    const std::string code = code_of(line);
    std::vector<double> out;
    for (std::sregex_iterator at(code.begin(), code.end(), number), end; at != end; ++at)
        out.push_back(std::stod((*at)[2]));
    return out;
}

/// True if a line hides a threshold in a fraction (1.0 / 7) or in an integer by which it divides (`gap_divisor = 7`).
/// Halves, thirds and quarters are coordinates of midpoints and centroids.
bool has_hidden_threshold(const std::string& line) {
    static const std::regex fraction(R"(\b1(\.0)? / ([5-9]|\d\d+)(\.0)?\b)"), divisor(R"(divisor\w* = \d)");
    const std::string code = code_of(line);
    return std::regex_search(code, fraction) || std::regex_search(code, divisor);
}

/// Text of the comment at the end of a line.
std::string comment_of(const std::string& line) {
    static const std::regex comment("///?<?(.*)");
    std::smatch found;
    return std::regex_search(line, found, comment) ? found[1].str() : "";
}

/// Lines with a number that controls work but has no origin: it is not in the table of calibrated numbers, and the
/// comment directly above or on its line does not say what it is derived from, or by which command a constant was
/// measured.
std::vector<std::string> unexplained_literals(const std::string& name, std::istream& in) {
    static const std::regex derived("[dD]erived from "), measured("[mM]easured by `[^`]+`"), constant("\\bconst"),
        by_hand("([gG]iven by|[dD]erived from|[mM]easured) ");
    const bool is_by_hand = is_below(measured_by_hand, name);
    std::vector<std::string> out;
    std::string line, said;  // `said`: the comment above, as one line
    for (int number = 1; std::getline(in, line); ++number) {
        const std::size_t begin = line.find_first_not_of(' ');
        said += comment_of(line);
        if (begin != std::string::npos && line.compare(begin, 2, "//") == 0) continue;
        const bool is_explained = std::regex_search(said, derived) ||
                                  (std::regex_search(said, measured) && std::regex_search(line, constant)) ||
                                  (is_by_hand && std::regex_search(said, by_hand));
        const std::vector<double> found = literals(line);
        const bool is_odd = std::any_of(found.begin(), found.end(), [](double value) { return !is_plain(value); });
        if (!is_explained && (is_odd || (!is_by_hand && has_hidden_threshold(line))))
            out.push_back(name + ":" + std::to_string(number) + ": " + line);
        said.clear();
    }
    return out;
}

}  // namespace

TEST(Literals, ThatControlWorkHaveAnOrigin) {
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
                              << "\nneeds a comment that says what it is derived from or by which `command` it was "
                                 "measured, or a row in calibration/numbers.inc";
            ++files;
        }
    EXPECT_GT(files, 20u);
}

TEST(Literals, AreFoundUnlessTheirOriginIsGiven) {
    const auto count = [](const std::string& code) {
        std::istringstream in(code);
        return unexplained_literals("x.cpp", in).size();
    };
    EXPECT_EQ(count("const double a = 0.7 * b + 1e-3;\n"), 1u);
    EXPECT_EQ(count("const double a = 0.5 * b + 2.0 + x1.y;  // 0.7\n"), 0u);
    EXPECT_EQ(count("const double a = 1e-12;  // derived from rounding\n"), 0u);
    EXPECT_EQ(count("const double a = 0.3;  // given by experience\n"), 1u);
    EXPECT_EQ(count("const double a = 0.3;  // measured 0.2 to 0.4\n"), 1u);
    EXPECT_EQ(count("const double a = 0.3;  // measured by `exitance-calibrate a`\n"), 0u);
    EXPECT_EQ(count("x = 0.3 * y;  // measured by `exitance-calibrate a`\n"), 1u) << "a measured number has a name";
    EXPECT_EQ(count("const double a = 1.0 / 7;\nconstexpr int gap_divisor = 7;\nx = y / 3;\n"), 2u);
    EXPECT_EQ(count("// Derived from the rule\n// of Gauss.\nconst double a = 0.77;\nconst double b = 0.3;\n"), 1u);
    EXPECT_EQ(count("// Measured by\n// `exitance solve a` and b.\nconst double a = 0.77;\n"), 0u);
    EXPECT_EQ(count("// measured by `exitance solve a`\nx = 0.77;\n"), 1u) << "a measured number has a name";
    EXPECT_EQ(count("print(\"0.7\", 17, 0x1p20);\n"), 0u);
}

}  // namespace exitance
