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

/// Messages of verbs with too few fixed words to be found in docs/troubleshooting.md. The list may only get shorter.
const std::vector<std::string> unexplained{
    "'{}' has {} numbers, {} has {}",
    "'{}' {}",
    "a surface ",
    "is empty",
    "{} '{}' {}",
    "{} {} is {:g}",
    "{}: in {}?",
    "{}: {}",
};

std::string page_or_source(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

/// The string literal whose opening quote is at `at`, joined with adjacent ones.
std::string literal_at(const std::string& text, std::size_t at) {
    std::string out;
    while (at < text.size() && text[at] == '"') {
        for (++at; at < text.size() && text[at] != '"'; ++at) {
            if (text[at] == '\\') ++at;
            out += text[at];
        }
        at = text.find_first_not_of(" \n", at + 1);
    }
    return out;
}

/// Texts of errors, warnings and repairs in a source, in the calls that make them. Texts of one word are parts of a
/// message and are omitted.
std::vector<std::string> messages_of(const std::string& source) {
    static const std::regex start(
        R"re((ErrorCode::\w+,|\b(error|warning|repair|warn)\(([^"();]{0,40},)?)\s*(fmt::format\(\s*)?")re");
    std::vector<std::string> out;
    for (std::sregex_iterator at(source.begin(), source.end(), start), end; at != end; ++at) {
        const auto quote = static_cast<std::size_t>(at->position() + at->length()) - 1;
        const std::string text = literal_at(source, quote);
        const std::size_t first = text.find_first_not_of(' ');
        if (first != std::string::npos && text.find(' ', first) < text.find_last_not_of(' ')) out.push_back(text);
    }
    return out;
}

std::set<std::string> messages_of_verbs() {
    const fs::path root = fs::path(test::source_folder()) / "src/exitance";
    std::set<std::string> out;
    for (const std::string folder : {"cli", "io", "measure", "methods", "scene", "sweep", "what_if"})
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
            const std::string name = entry.path().filename();
            if (!name.ends_with(".cpp") || name.ends_with("_test.cpp")) continue;
            for (const std::string& message : messages_of(page_or_source(entry.path()))) out.insert(message);
        }
    return out;
}

/// Parts of messages that the tables of docs/troubleshooting.md quote; "..." separates parts.
std::vector<std::string> explained_parts(const std::string& page) {
    constexpr std::size_t shortest = 6;
    static const std::regex quoted("`([^`]+)`");
    std::vector<std::string> out;
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("| ")) continue;
        const std::string cell = line.substr(1, line.find('|', 1) - 1);
        for (std::sregex_iterator at(cell.begin(), cell.end(), quoted), end; at != end; ++at) {
            std::string rest = (*at)[1];
            for (std::size_t dots = 0; dots != std::string::npos; rest = rest.substr(std::min(dots + 3, rest.size()))) {
                dots = rest.find("...");
                const std::string part = rest.substr(0, dots);
                const std::size_t first = part.find_first_not_of(" ',:()%");
                if (first != std::string::npos) {
                    const std::string text = part.substr(first, part.find_last_not_of(" ',:()%") - first + 1);
                    if (text.size() >= shortest) out.push_back(text);
                }
                if (dots == std::string::npos) break;
            }
        }
    }
    return out;
}

bool is_quoted(const std::string& message, const std::vector<std::string>& parts) {
    return std::any_of(parts.begin(), parts.end(),
                       [&](const std::string& part) { return message.find(part) != std::string::npos; });
}

}  // namespace

TEST(Messages, AreExplainedInTroubleshooting) {
    const std::vector<std::string> parts =
        explained_parts(page_or_source(fs::path(test::source_folder()) / "docs/troubleshooting.md"));
    const std::set<std::string> all = messages_of_verbs();
    const std::set<std::string> known(unexplained.begin(), unexplained.end());
    EXPECT_GT(all.size(), 350u);
    for (const std::string& message : all)
        EXPECT_NE(is_quoted(message, parts), known.contains(message))
            << "explain this message in docs/troubleshooting.md, or take it off the list of this test: " << message;
    for (const std::string& message : known)
        EXPECT_TRUE(all.contains(message)) << "no such message; take it off the list of this test: " << message;
}

TEST(Messages, AreFoundInSources) {
    const std::vector<std::string> expected{"is \"broken\" here", "has {} rows", "a repair of faces"};
    EXPECT_EQ(messages_of("return Error{ErrorCode::usage, \"is \\\"broken\\\" \"\n    \"here\", path};\n"
                          "error(line_, fmt::format(\"has {} rows\", n));\nrepair(0, \"a repair of faces\");\n"
                          "note(\"only a note\"); error(\"short\");"),
              expected);
    EXPECT_EQ(explained_parts("| `has ... rows of text`, `broken here` | remedy |\n"),
              (std::vector<std::string>{"rows of text", "broken here"}));
}

}  // namespace exitance
