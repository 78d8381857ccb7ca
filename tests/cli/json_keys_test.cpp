#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "cli/input_files.hpp"
#include "cli/small_scene.hpp"

namespace exitance::test {
namespace {

using Keys = std::set<std::string>;

const std::string page = read_text(std::filesystem::path(test::source_folder()) / "docs/reference/json.md");

/// The words in backquotes of the rows of docs/reference/json.md whose first cell has `row`; all rows of the first
/// table for `solve`.
Keys documented(const std::string& row) {
    static const std::regex quoted("`([A-Za-z_0-9]+)`");
    const std::size_t other = page.find("## Other verbs");
    std::istringstream lines(row == "solve" ? page.substr(0, other) : page.substr(other));
    Keys out;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("| `") || (row != "solve" && !line.starts_with("| `" + row + "` |"))) continue;
        for (std::sregex_iterator at(line.begin(), line.end(), quoted), end; at != end; ++at) out.insert((*at)[1]);
    }
    return out;
}

/// All keys of the objects in a JSON text, nested ones included.
void collect(const nlohmann::json& value, Keys& out) {
    if (value.is_object())
        for (const auto& [key, member] : value.items()) out.insert(key);
    if (value.is_structured())
        for (const nlohmann::json& member : value) collect(member, out);
}

Keys printed(const std::vector<std::string>& words) {
    const Finished run = run_program(words);
    EXPECT_TRUE(run.status == 0 || run.status == 4) << words[0] << ": " << run.err;
    Keys out;
    collect(nlohmann::json::parse(run.out), out);
    return out;
}

void expect_documented(const Keys& keys, const std::string& row) {
    const Keys known = documented(row);
    EXPECT_FALSE(keys.empty()) << row;
    for (const std::string& key : keys)
        EXPECT_TRUE(known.contains(key) || key.starts_with("EN17037_"))
            << "docs/reference/json.md does not list the key '" << key << "' of " << row;
}

std::string solved(const TemporaryFolder& folder, const std::string& scene) {
    const std::string out = folder / "s.h5";
    EXPECT_EQ(run_program({"solve", scene, "-o", out, "--error", "0.3"}).status, 0);
    return out;
}

}  // namespace

TEST(JsonKeys, OfSolveAreDocumented) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), out = folder / "s.h5";
    const std::vector<std::vector<std::string>> kinds{
        {"--error", "0.3"},
        {"--error", "0.3", "--method", "hierarchical", "--epsilon", "0.5"},
        {"--error", "0.3", "--method", "monte-carlo"},
        {"--error", "0.3", "--method", "discontinuity"},
        {"--error", "0.3", "--light-groups"},
        {"--recipe", "classical-matrix", "--mesh-size", "2"},
        {"--method", "hierarchical", "--task-engine", "--threshold", "5"}};
    for (std::vector<std::string> options : kinds) {
        options.insert(options.begin(), {"solve", scene, "-o", out, "--json", "-q"});
        expect_documented(printed(options), "solve");
        expect_documented(printed({"stats", out, "--json"}), "solve");
    }
}

TEST(JsonKeys, OfOtherVerbsAreDocumented) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), solution = solved(folder, scene);
    write_text(folder / "d.ies", downlight);
    write_text(folder / "p.csv", "x,y,z,nx,ny,nz\n1,1,0.75,0,0,1\n2,2,0.75,0,0,1\n");
    write_text(folder / "day.epw", weather_of_a_day());
    write_text(folder / "t.csv", "surface,emissivity,temperature\n0,0.8,300\n7,0.9,600\n");
    ASSERT_EQ(run_program({"probe", solution, "--points", folder / "p.csv", "-o", folder / "r.csv"}).status, 0);
    ASSERT_EQ(run_program({"viewfactors", scene, "-o", folder / "f.h5", "-q"}).status, 0);
    expect_documented(printed({"check", scene, "--json"}), "check");
    expect_documented(printed({"compare", solution, folder / "r.csv", "--json"}), "compare");
    expect_documented(printed({"solve", scene, "-o", folder / "n.h5", "--dry-run", "--json"}), "solve --dry-run");
    expect_documented(printed({"viewfactors", scene, "-o", folder / "f.csv", "--json"}), "viewfactors");
    expect_documented(
        printed({"heat", folder / "f.h5", "--table", folder / "t.csv", "--surroundings", "300", "--json"}), "heat");
    expect_documented(printed({"luminaire", folder / "d.ies", "--json"}), "luminaire");
    expect_documented(printed({"glare", solution, "--observers", "1,1,1.2 1,0.5,0.3", "--json"}), "glare");
    expect_documented(printed({"daylight", solution, "--epw", folder / "day.epw", "--points", folder / "p.csv", "-o",
                               folder / "year", "--json"}),
                      "daylight");
}

TEST(JsonKeys, DocumentedOnesAreWrittenSomewhere) {
    std::string sources;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::filesystem::path(test::source_folder()) / "src/exitance"))
        if (entry.path().extension() == ".cpp" || entry.path().extension() == ".hpp")
            sources += read_text(entry.path());
    std::size_t count = 0;
    for (const std::string row :
         {"solve", "check", "compare", "solve --dry-run", "viewfactors", "heat", "luminaire", "glare", "daylight"})
        for (const std::string& key : documented(row)) {
            if (key.starts_with("T_")) continue;  // the program composes these names
            ++count;
            EXPECT_NE(sources.find(key), std::string::npos) << "no source writes '" << key << "' of " << row;
        }
    EXPECT_GT(count, 80u);
}

}  // namespace exitance::test
