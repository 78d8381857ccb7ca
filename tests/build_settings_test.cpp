#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <thread>

#include "support/places.hpp"
#include "support/run.hpp"

namespace exitance {
namespace {

/// Runs commands of bash after scripts/build_settings. Returns their output.
std::string settings(const std::string& commands) {
    const std::string script = test::source_folder() + "/scripts/build_settings";
    const Ran ran = run("bash -euc 'source \"" + script + "\"; " + commands + "'");
    EXPECT_EQ(ran.status, 0) << ran.output;
    return ran.output;
}

TEST(BuildSettings, OnlyAFirstBuildHasUnitsOfManyFiles) {
    const TemporaryFolder folder;
    const std::string show = "; echo \"${unit_options[*]} ${CCACHE_DEPEND:-off}\"";
    const std::string choose = "choose_units \"" + (folder / "build") + "\"" + show;
    EXPECT_EQ(settings(choose), "-D EXITANCE_UNIT_FILES=24 1\n");
    std::filesystem::create_directory(folder / "build");
    std::ofstream(folder / "build/CMakeCache.txt") << "EXITANCE_UNIT_FILES:STRING=8\n";
    EXPECT_EQ(settings(choose), " off\n");
}

TEST(BuildSettings, EveryProcessorHasAtMostOneCompiler) {
    const int jobs = std::stoi(settings("build_jobs"));
    EXPECT_GE(jobs, 1);
    EXPECT_LE(jobs, static_cast<int>(std::max(1u, std::thread::hardware_concurrency())));
}

}  // namespace
}  // namespace exitance
