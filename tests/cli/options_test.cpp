#include <gtest/gtest.h>

#include <map>
#include <set>
#include <sstream>

#include "cli/small_scene.hpp"
#include "exitance/methods/options/make_request.hpp"
#include "exitance/methods/options/recipes.hpp"
#include "exitance/methods/options/solve_option_table.hpp"
#include "exitance/methods/options/support.hpp"
#include "support/option_words.hpp"

namespace exitance::test {
namespace {

struct ListedOption {
    std::string verb, name, type, group, audience;
};

/// Every option that the program's parser declares.
std::vector<ListedOption> listed_options() {
    std::istringstream in(run_program({"reference", "--format", "list"}).out);
    std::vector<ListedOption> out;
    for (std::string line; std::getline(in, line);) {
        std::istringstream fields(line);
        ListedOption& o = out.emplace_back();
        for (std::string* field : {&o.verb, &o.name, &o.type, &o.group, &o.audience})
            std::getline(fields, *field, '\t');
    }
    return out;
}

}  // namespace

TEST(ProgramOptions, OfSolveAreRowsOfTheTableOrSharedWithOtherVerbs) {
    std::set<std::string> shared, of_solve;
    for (const ListedOption& option : listed_options())
        (option.verb == "solve" ? of_solve : shared).insert(option.name);
    for (const std::string& name : of_solve)
        EXPECT_TRUE(find_option(name) || shared.contains(name)) << name << " has no row in the table of options";
    for (const OptionRow& row : solve_option_table()) EXPECT_TRUE(of_solve.contains(row.name)) << row.name;
}

TEST(ProgramOptions, HelpNamesTheValuesThatAFormSupports) {
    const std::string help = run_program({"reference", "--format", "markdown"}).out;
    const std::size_t row = help.find("| `--clusters ");
    ASSERT_NE(row, std::string::npos);
    const std::string line = help.substr(row, help.find('\n', row) - row);
    EXPECT_NE(line.find("all published forms with off"), std::string::npos) << line;
    EXPECT_NE(line.find("--task-engine with off"), std::string::npos) << line;
}

TEST(ProgramOptions, HelpShowsThirtyOptionsAtMostAndHelpAllShowsAll) {
    const std::string help = run_program({"solve", "--help"}).out, all = run_program({"solve", "--help-all"}).out;
    const auto shows = [](const std::string& text, const std::string& name) {
        return text.find("  " + name + " ") != std::string::npos ||
               text.find("  " + name + "\n") != std::string::npos || text.find(", " + name + " ") != std::string::npos;
    };
    std::size_t for_users = 0;
    for (const ListedOption& option : listed_options()) {
        if (option.verb != "solve" || !option.name.starts_with("--")) continue;
        for_users += option.audience == "users";
        EXPECT_EQ(shows(help, option.name), option.audience == "users") << option.name;
        EXPECT_TRUE(shows(all, option.name)) << option.name;
    }
    EXPECT_LE(for_users, 30u);
    for (const Recipe& recipe : recipes()) EXPECT_NE(all.find(recipe.name), std::string::npos) << recipe.name;
    EXPECT_EQ(help.find("willmott97"), std::string::npos);
}

/// Runs one unsupported method per option; OptionSupport tests all methods.
TEST(ProgramOptions, EveryOptionIsRefusedByAMethodThatDoesNotSupportIt) {
    for (const OptionRow& row : solve_option_table()) {
        const std::string word = words_for(row).back();
        for (const auto& [method, name] : method_names) {
            SolveRequest request{.options = {.method = method}};
            ASSERT_EQ(row.value.read(word, request), "");
            settle(request);
            const Result<MethodForm> method_form = find_method_form(request);
            if (method_form || method == Method::automatic || row.name == "--method") continue;
            std::vector<std::string> words{"solve", "no_such_scene.obj", "-o", "s.h5", "--method", std::string(name)};
            words.push_back(row.name);
            if (!word.empty()) words.push_back(word);
            const Finished run = run_program(words);
            EXPECT_EQ(run.status, 2) << row.name << " " << name << run.err;
            EXPECT_NE(run.err.find(method_form.error().message), std::string::npos) << run.err;
            break;
        }
    }
}

TEST(ProgramOptions, OldNamesGiveTheSameLightAsNewOnesWithAWarning) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    const auto light = [&](const std::vector<std::string>& more, std::string& messages) {
        std::vector<std::string> words{"solve", scene, "-o", folder / "s.h5", "--mesh-size", "1.5"};
        words.insert(words.end(), more.begin(), more.end());
        const Finished run = run_program(words);
        EXPECT_EQ(run.status, 0) << run.err;
        messages = run.err;
        return run_program({"probe", folder / "s.h5", "--points", "-"}, "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n3,2,0,0,0,1\n")
            .out;
    };
    const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> pairs{
        {{"--method", "matrix", "--smoothing", "off"}, {"--method", "matrix", "--output-light", "elements"}},
        {{"--method", "hierarchical", "--smoothing", "on"},
         {"--method", "hierarchical", "--output-light", "smoothed-elements"}},
        {{"--method", "progressive", "--gather", "off"}, {"--recipe", "classical-progressive"}},
        {{"--method", "matrix", "--direct", "carried", "--gather", "off", "--smoothing", "on"},
         {"--recipe", "classical-matrix", "--direct", "carried", "--output-light", "smoothed-elements"}},
    };
    for (const auto& [old_words, new_words] : pairs) {
        std::string old_messages, new_messages;
        EXPECT_EQ(light(old_words, old_messages), light(new_words, new_messages)) << old_words[2];
        EXPECT_NE(old_messages.find("warning: " + old_words[old_words.size() - (old_words.size() > 4 ? 4 : 2)]),
                  std::string::npos)
            << old_messages;
        for (std::size_t i = 0; i + 1 < new_words.size(); i += 2)
            if (new_words[i] == "--output-light" || new_words[i] == "--recipe") {
                EXPECT_NE(old_messages.find(new_words[i] + " " + new_words[i + 1]), std::string::npos) << old_messages;
            }
        EXPECT_EQ(new_messages.find("0.4"), std::string::npos) << new_messages;
    }
}

TEST(ProgramOptions, RecipesSolveASmallRoom) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    for (const Recipe& recipe : recipes()) {
        const auto presets = [&](const char* option) { return recipe.presets.find(option) != std::string::npos; };
        std::vector<std::string> words{"solve", scene, "-o", folder / "s.h5", "-q"};
        words.insert(words.end(), {"--recipe", std::string(recipe.name)});
        // Coarse settings, which replace presets.
        if (presets("--threshold") || presets("--task-engine"))
            words.insert(words.end(), {"--threshold", "5", "--min-area", "0.2"});
        else if (presets("--local-pass"))
            words.insert(words.end(), {"--error", "0.5"});
        else if (presets("growing-cells"))
            words.insert(words.end(), {"--max-units", "8"});
        else
            words.insert(words.end(), {"--mesh-size", "2"});
        const Finished run = run_program(words);
        EXPECT_TRUE(run.status == 0 || run.status == 4) << recipe.name << ": " << run.err;
    }
}

TEST(ProgramReference, TheCommittedPageIsWhatTheProgramPrints) {
    const Finished page = run_program({"reference", "--format", "markdown"});
    EXPECT_EQ(page.status, 0);
    EXPECT_TRUE(page.out == read_text(std::filesystem::path(source_folder()) / "docs/options.md"))
        << "run: build/bin/exitance reference --format markdown > docs/options.md";
}

TEST(ProgramReference, PrintsAManualPageAndCompletions) {
    EXPECT_TRUE(run_program({"reference", "--format", "man"}).out.starts_with(".TH EXITANCE 1"));
    EXPECT_TRUE(run_program({"reference", "--format", "zsh"}).out.starts_with("#compdef exitance\n"));
    EXPECT_EQ(run_program({"reference", "--format", "html"}).status, 2);
    EXPECT_EQ(run_program({"reference"}).status, 2);
    EXPECT_EQ(run_program({"--help"}).out.find("\n  reference "), std::string::npos) << "the verb is hidden";
    const TemporaryFolder folder;
    write_text(folder / "c.sh", run_program({"reference", "--format", "bash"}).out +
                                    "COMP_WORDS=(exitance solve --recipe cohen8) COMP_CWORD=3\n_exitance\n"
                                    "echo \"${COMPREPLY[@]}\"\n");
    EXPECT_EQ(RunningProgram({folder / "c.sh"}, {}, "/bin/bash").finish().out,
              "cohen85 cohen86-substructuring cohen88-progressive\n");
}

}  // namespace exitance::test
