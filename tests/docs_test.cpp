#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/places.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

std::vector<fs::path> documents() {
    const fs::path root = test::source_folder();
    std::vector<fs::path> out{root / "README.md", root / "CONTRIBUTING.md"};
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "docs"))
        if (entry.path().extension() == ".md") out.push_back(entry.path());
    return out;
}

/// Paths in backquotes that begin with a folder of `src/exitance`, of which only the last part may lack its suffix.
std::vector<std::string> code_paths(const std::string& text, const std::set<std::string>& folders) {
    static const std::regex quoted(R"(`(src/exitance/)?(([a-z_0-9]+)/[a-z_0-9/]*[a-z_0-9](\.(cpp|hpp|inc))?)`)");
    std::vector<std::string> out;
    for (std::sregex_iterator at(text.begin(), text.end(), quoted), end; at != end; ++at)
        if (folders.contains((*at)[3])) out.push_back((*at)[2]);
    return out;
}

bool exists_in_sources(const fs::path& root, const std::string& path) {
    const std::vector<std::string> suffixes{"", ".hpp", ".cpp", ".inc"};
    return std::any_of(suffixes.begin(), suffixes.end(),
                       [&](const std::string& suffix) { return fs::exists(root / (path + suffix)); });
}

}  // namespace

TEST(Documentation, NamesOnlyFilesThatExist) {
    const fs::path root = fs::path(test::source_folder()) / "src/exitance";
    std::set<std::string> folders;
    for (const fs::directory_entry& entry : fs::directory_iterator(root)) folders.insert(entry.path().filename());
    std::size_t found = 0;
    for (const fs::path& document : documents())
        for (const std::string& path : code_paths(content(document), folders)) {
            if (path.starts_with("methods/ambient")) continue;  // the example of docs/adding_a_method.md
            ++found;
            EXPECT_TRUE(exists_in_sources(root, path)) << document << " names " << path;
        }
    EXPECT_GT(found, 60u);
}

TEST(Documentation, LinksLeadToFilesThatExist) {
    static const std::regex link(R"(\]\(([^)#:\s]+)(#[^)\s]*)?\))");
    std::size_t found = 0;
    for (const fs::path& document : documents()) {
        const std::string text = content(document);
        for (std::sregex_iterator at(text.begin(), text.end(), link), end; at != end; ++at) {
            ++found;
            EXPECT_TRUE(fs::exists(document.parent_path() / (*at)[1].str())) << document << " links to " << (*at)[1];
        }
    }
    EXPECT_GT(found, 10u);
}

TEST(Documentation, ArchitectureListsEveryFolder) {
    const fs::path root = fs::path(test::source_folder()) / "src/exitance";
    const std::string text = content(fs::path(test::source_folder()) / "docs/architecture.md");
    for (const fs::directory_entry& entry : fs::directory_iterator(root))
        if (entry.is_directory()) {
            EXPECT_NE(text.find("| `" + entry.path().filename().string() + "/`"), std::string::npos) << entry.path();
        }
}

}  // namespace exitance
