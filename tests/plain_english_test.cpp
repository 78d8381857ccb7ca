#include <gtest/gtest.h>

#include <algorithm>
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

/// Folders and files of src/exitance whose comments are not yet in plain English. The list may only get shorter.
const std::vector<std::string> unfinished{};

struct Comment {
    int line = 0;
    std::string text;
};

/// The comments of a C++ source: consecutive lines of comment are one; a comment behind code is one of its own.
std::vector<Comment> comments_of(std::istream& in) {
    static const std::regex whole(R"(^\s*///?<?\s?(.*)$)"), trailing(R"([;,{})]\s+///?<?\s(.*)$)");
    std::vector<Comment> out;
    bool continues = false;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        std::smatch match;
        if (std::regex_match(line, match, whole)) {
            if (continues)
                out.back().text += " " + match[1].str();
            else
                out.push_back({number, match[1]});
            continues = true;
            continue;
        }
        continues = false;
        if (std::regex_search(line, match, trailing)) out.push_back({number, match[1]});
    }
    return out;
}

/// Why a comment is hard to read by the rules that a program can check; empty if it passes. A comment is a sentence or
/// a noun phrase: it does not begin in the middle of a sentence. The words are ones that readers misunderstood.
std::string fault_of(const std::string& text) {
    static const std::regex opening(R"(^(Of|By|That|Where|So many|The same|As|What|With which|Those|Else)\b)");
    static const std::regex word(R"(\b(obey|obeys|obeyed|by lot|to and fro|for (its|their) sake|for ever|hands on)\b)");
    std::smatch match;
    if (std::regex_search(text, match, opening)) return "begins with '" + match[1].str() + "'";
    if (std::regex_search(text, match, word)) return "says '" + match[1].str() + "'";
    return "";
}

std::string fault_of_source(const std::string& source) {
    std::istringstream in(source);
    for (const Comment& comment : comments_of(in))
        if (const std::string fault = fault_of(comment.text); !fault.empty()) return fault;
    return "";
}

}  // namespace

TEST(PlainEnglish, CommentsAreSentencesOrNounPhrases) {
    const fs::path root = test::source_folder();
    std::size_t count = 0;
    for (const std::string folder : {"src/exitance", "include/exitance", "bindings", "tests", "bench"})
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
            const std::string extension = entry.path().extension();
            if (extension != ".cpp" && extension != ".hpp" && extension != ".inc") continue;
            const std::string name = fs::relative(entry.path(), root / folder);
            if (folder == "src/exitance" && std::any_of(unfinished.begin(), unfinished.end(),
                                                        [&](const std::string& u) { return name.starts_with(u); }))
                continue;
            std::ifstream in(entry.path());
            for (const Comment& comment : comments_of(in)) {
                ++count;
                EXPECT_EQ(fault_of(comment.text), "") << entry.path() << ":" << comment.line << ": " << comment.text;
            }
        }
    EXPECT_GT(count, 5000u);
}

TEST(PlainEnglish, FaultsAreFound) {
    EXPECT_EQ(fault_of_source("int a;\t///< Of the whole, m^2.\n"), "begins with 'Of'");
    EXPECT_EQ(fault_of_source("/// What is gathered,\n/// in the end.\nint a;\n"), "begins with 'What'");
    EXPECT_EQ(fault_of_source("/// Methods that obey it.\nint a;\n"), "says 'obey'");
    EXPECT_EQ(fault_of_source("/// Area of a leaf, of which\n/// Of all leaves is the sum.\nint a;\n"), "");
    EXPECT_EQ(fault_of_source("const char* url = \"http://x\";  // the project's page\n"), "");
}

}  // namespace exitance
