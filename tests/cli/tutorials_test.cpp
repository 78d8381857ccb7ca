#include <gtest/gtest.h>

#include <regex>

#include "run_program.hpp"
#include "support/places.hpp"

namespace exitance::test {
namespace {

const std::filesystem::path tutorials = std::filesystem::path(test::source_folder()) / "docs/tutorials";

/// Coarser versions of the same commands, which run all of them in less time.
std::string made_quick(std::string commands) {
    const std::vector<std::pair<std::string, std::string>> coarser{{"--error 0\\.[0-9]+", "--error 0.2"},
                                                                   {"--size [0-9]+x[0-9]+", "--size 24x15"},
                                                                   {"--density [0-9]+", "--density 8"},
                                                                   {"--reference [0-9]+", "--reference 16"},
                                                                   {"--mesh-size 0\\.[0-9]+", "--mesh-size 1"}};
    for (const auto& [fine, coarse] : coarser) commands = std::regex_replace(commands, std::regex(fine), coarse);
    return commands;
}

/// The blocks of a page that are marked `sh run`, as one script.
std::string commands_of(const std::string& page) {
    std::string out;
    const std::string text = read_text(tutorials / page), begin = "```sh run\n";
    for (std::size_t at = 0; (at = text.find(begin, at)) != std::string::npos;) {
        at += begin.size();
        out += text.substr(at, text.find("```", at) - at);
    }
    return out;
}

class Tutorials : public testing::TestWithParam<const char*> {};

TEST_P(Tutorials, RunsAsWritten) {
    const std::string page = std::string(GetParam()) + ".md", commands = commands_of(page);
    ASSERT_NE(commands, "");
    const TemporaryFolder folder;
    write_text(folder / "run.sh", "set -eo pipefail\ncd '" + (folder / "") + "'\nmkdir bin\nln -s '" + test::program() +
                                      "' bin/exitance\nPATH=$PWD/bin:$PATH\n" + made_quick(commands) +
                                      "\necho the end\n");
    const Finished run = RunningProgram({folder / "run.sh"}, {}, "/bin/bash").finish();
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    EXPECT_TRUE(run.out.ends_with("the end\n")) << run.out << run.err;
}

TEST_P(Tutorials, LinksToExistingPagesAndPictures) {
    const std::string text = read_text(tutorials / (std::string(GetParam()) + ".md"));
    for (std::size_t at = 0; (at = text.find("](", at)) != std::string::npos; ++at) {
        const std::string target = text.substr(at + 2, text.find_first_of(")#", at) - at - 2);
        EXPECT_TRUE(std::filesystem::exists(tutorials / target)) << target;
    }
}

INSTANTIATE_TEST_SUITE_P(Pages, Tutorials, testing::Values("designer", "daylight", "baker", "researcher", "thermal"));

}  // namespace
}  // namespace exitance::test
