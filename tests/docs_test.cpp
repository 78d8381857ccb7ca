#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "exitance/solve/solve_options.hpp"
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
    std::vector<fs::path> out{root / "README.md", root / "CONTRIBUTING.md", root / "CHANGELOG.md",
                              root / "bench/results/README.md"};
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "docs"))
        if (entry.path().extension() == ".md") out.push_back(entry.path());
    return out;
}

/// Lines of indented and fenced code.
std::vector<std::string> code_lines(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream lines(text);
    bool fenced = false;
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find_first_not_of(' ');
        if (first != std::string::npos && line.compare(first, 3, "```") == 0)
            fenced = !fenced;
        else if (fenced || line.starts_with("    "))
            out.push_back(line);
    }
    return out;
}

/// The text of all sources except tests, with adjacent string literals joined and quotes unescaped.
std::string source_text(const fs::path& root) {
    static const std::regex joint(R"("\s*\n\s*")"), escaped(R"(\\")");
    std::string out;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
        const std::string name = entry.path().filename();
        if ((!name.ends_with(".cpp") && !name.ends_with(".hpp")) || name.ends_with("_test.cpp")) continue;
        out += std::regex_replace(std::regex_replace(content(entry.path()), joint, ""), escaped, "\"");
    }
    return out;
}

/// Fixed parts, of at least six characters, of a message whose variable parts are written as "...".
std::vector<std::string> fixed_parts(const std::string& message) {
    std::vector<std::string> out;
    for (std::size_t at = 0; at <= message.size();) {
        const std::size_t end = std::min(message.find("...", at), message.size());
        std::string part = message.substr(at, end - at);
        const std::string edge = " ',:()%";
        const std::size_t first = part.find_first_not_of(edge);
        part = first == std::string::npos ? "" : part.substr(first, part.find_last_not_of(edge) - first + 1);
        if (part.size() >= 6) out.push_back(part);
        at = end + 3;
    }
    return out;
}

/// The anchors of a page's headings, as the site's generator makes them.
std::set<std::string> anchors(const std::string& text) {
    std::set<std::string> out;
    std::istringstream lines(text);
    bool fenced = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("```")) fenced = !fenced;
        if (fenced || !line.starts_with("#")) continue;
        std::string anchor;
        for (const char c : line.substr(line.find_first_not_of("# "))) {
            if (std::isalnum(static_cast<unsigned char>(c)) || c == '_')
                anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
            else if ((c == ' ' || c == '-') && !anchor.ends_with('-'))
                anchor += '-';
        }
        out.insert(anchor);
    }
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

TEST(Documentation, AnchorsLeadToHeadings) {
    static const std::regex link(R"(\]\(([^)#:\s]*)#([^)\s]+)\))");
    std::size_t found = 0;
    for (const fs::path& document : documents()) {
        const std::string text = content(document);
        for (std::sregex_iterator at(text.begin(), text.end(), link), end; at != end; ++at) {
            const std::string file = (*at)[1];
            const std::string target = file.empty() ? text : content(document.parent_path() / file);
            ++found;
            EXPECT_TRUE(anchors(target).contains((*at)[2])) << document << " links to " << (*at)[0];
        }
    }
    EXPECT_GT(found, 20u);
}

TEST(Documentation, SourcesNameOnlyPagesThatExist) {
    static const std::regex page(R"(\bdocs/[a-z_0-9/]+\.(md|bib)\b)");
    const fs::path root = test::source_folder();
    std::size_t found = 0;
    for (const std::string folder : {"src", "tests", "bench", "scripts", "experiments"})
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
            if (!entry.is_regular_file() || entry.path().filename() == "docs_test.cpp") continue;
            const std::string text = content(entry.path());
            for (std::sregex_iterator at(text.begin(), text.end(), page), end; at != end; ++at) {
                ++found;
                EXPECT_TRUE(fs::exists(root / at->str())) << entry.path() << " names " << at->str();
            }
        }
    EXPECT_GT(found, 10u);
}

TEST(Documentation, NamesOnlyToolsThatExist) {
    static const std::regex tool(R"((^|[\s`])((bench|scripts)/[a-z_0-9]+(\.[a-z]+)?))");
    const fs::path root = test::source_folder();
    std::size_t found = 0;
    for (const fs::path& document : documents()) {
        const std::string text = content(document);
        for (std::sregex_iterator at(text.begin(), text.end(), tool), end; at != end; ++at) {
            ++found;
            EXPECT_TRUE(fs::exists(root / (*at)[2].str()) || fs::exists(root / ((*at)[2].str() + ".cpp")))
                << document << " names " << (*at)[2];
        }
    }
    EXPECT_GT(found, 20u);
}

TEST(Documentation, ReadmeShowsTheMeasuredTimes) {
    const std::string root = test::source_folder();
    const std::string check = "python3 '" + root + "/scripts/result_tables.py' --check '" + root + "/README.md'";
    EXPECT_EQ(std::system(check.c_str()), 0) << "run scripts/result_tables.py README.md";
}

TEST(Documentation, TablesHaveTheColumnsOfTheirFiles) {
    const std::string root = test::source_folder();
    std::string command = "python3 -c \"import sys; sys.path.insert(0, '" + root +
                          "/scripts'); import result_tables as r; " +
                          "[r.expand(open(p).read(), p) for p in sys.argv[1:]]\"";
    std::size_t found = 0;
    for (const fs::path& document : documents()) {
        const std::string text = content(document);
        if (text.find("```results") == std::string::npos && text.find("```chart") == std::string::npos) continue;
        command += " '" + document.string() + "'", ++found;
    }
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_GT(found, 4u);
}

/// Blocks of a page that are fenced as a language.
std::vector<std::string> fenced_blocks(const std::string& text, const std::string& language) {
    std::vector<std::string> out;
    const std::string begin = "```" + language + "\n";
    for (std::size_t at = text.find(begin); at != text.npos; at = text.find(begin, at + 1))
        out.push_back(text.substr(at + begin.size(), text.find("```", at + 3) - at - begin.size()));
    return out;
}

TEST(Documentation, ProgramsAreTheReadmesOne) {
    // tests/package compiles and runs the README's program, and tests/CMakeLists.txt those of adding_a_method.md.
    const fs::path root = test::source_folder();
    const std::vector<std::string> expected = fenced_blocks(content(root / "README.md"), "cpp");
    ASSERT_EQ(expected.size(), 1u);
    std::size_t found = 0;
    for (const fs::path& document : documents()) {
        if (document.filename() == "adding_a_method.md") continue;
        for (const std::string& block : fenced_blocks(content(document), "cpp")) {
            ++found;
            EXPECT_EQ(block, expected[0]) << document;
        }
    }
    EXPECT_EQ(found, 2u);
}

TEST(Documentation, PagesThatImportTheModuleNameTheCommandThatBuildsIt) {
    const fs::path root = test::source_folder();
    EXPECT_NE(content(root / "demo.sh").find("--target exitance-cli"), std::string::npos)
        << "it builds the program only";
    for (const fs::path& page : documents()) {
        const std::string text = content(page);
        if (text.find("PYTHONPATH=build/python") == std::string::npos) continue;
        EXPECT_NE(text.find("-D EXITANCE_PYTHON=ON"), std::string::npos) << page;
    }
}

TEST(Documentation, AddingAMethodCountsTheMethods) {
    const std::string text = content(fs::path(test::source_folder()) / "docs/adding_a_method.md");
    const std::string table = "std::pair<Method, std::string_view>, " + std::to_string(method_names.size() + 1) + ">";
    EXPECT_NE(text.find(table), std::string::npos) << table;
}

TEST(Documentation, ArchitectureListsEveryFolder) {
    const fs::path root = fs::path(test::source_folder()) / "src/exitance";
    const std::string text = content(fs::path(test::source_folder()) / "docs/architecture.md");
    for (const fs::directory_entry& entry : fs::directory_iterator(root))
        if (entry.is_directory()) {
            EXPECT_NE(text.find("| `" + entry.path().filename().string() + "/`"), std::string::npos) << entry.path();
        }
}

TEST(Documentation, UsesOnlyVerbsThatExist) {
    const fs::path root = test::source_folder();
    const std::string arguments = content(root / "src/exitance/cli/options/arguments.cpp");
    static const std::regex row(R"re(verb<\w+>\(\s*"(\w+)",)re");
    std::set<std::string> verbs;
    for (std::sregex_iterator at(arguments.begin(), arguments.end(), row), end; at != end; ++at)
        verbs.insert((*at)[1].str());
    static const std::regex command(R"((^|[\s;&|])exitance (?!as\b)([a-z]+)\b)");  // not Python's 'import exitance as'
    std::size_t found = 0;
    for (const fs::path& document : documents())
        for (const std::string& line : code_lines(content(document)))
            for (std::sregex_iterator at(line.begin(), line.end(), command), end; at != end; ++at) {
                ++found;
                EXPECT_TRUE(verbs.contains((*at)[2].str())) << document << ": " << line;
            }
    EXPECT_GT(found, 50u);
}

TEST(Documentation, NavigationListsEveryPageOnce) {
    const fs::path root = test::source_folder();
    const std::string site = content(root / "mkdocs.yml");
    static const std::regex page(R"(([a-z0-9_/]+\.md)\n)");
    std::multiset<std::string> listed;
    for (std::sregex_iterator at(site.begin(), site.end(), page), end; at != end; ++at) listed.insert((*at)[1]);
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "docs"))
        if (entry.path().extension() == ".md") {
            EXPECT_EQ(listed.count(fs::relative(entry.path(), root / "docs").string()), 1u) << entry.path();
        }
}

TEST(Documentation, TroubleshootingQuotesMessagesOfTheProgram) {
    const fs::path root = test::source_folder();
    const std::string sources = source_text(root / "src/exitance");
    static const std::regex quoted("`([^`]+)`");
    std::istringstream lines(content(root / "docs/troubleshooting.md"));
    std::size_t found = 0;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("| `")) continue;
        const std::string cell = line.substr(1, line.find('|', 1) - 1);
        for (std::sregex_iterator at(cell.begin(), cell.end(), quoted), end; at != end; ++at)
            for (const std::string& part : fixed_parts((*at)[1])) {
                ++found;
                EXPECT_NE(sources.find(part), std::string::npos) << "no message contains: " << part;
            }
    }
    EXPECT_GT(found, 150u);
}

}  // namespace exitance
