#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "cli/small_scene.hpp"
#include "exitance/base/processor_check.hpp"
#include "run_program.hpp"

namespace exitance::test {
namespace {

std::vector<std::string> solve_arguments(const std::string& scene, const std::string& solution) {
    return {"solve", scene, "--error", "0.1", "--threads", "1", "--json", "-q", "-o", solution};
}

}  // namespace

TEST(ProgramProcessor, UnknownInstructionSetsAreErrors) {
    setenv("EXITANCE_PROCESSOR", "mmx", 1);
    const Finished run = run_program({"--version"});
    unsetenv("EXITANCE_PROCESSOR");
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find("EXITANCE_PROCESSOR: there is no instruction set 'mmx'"), std::string::npos) << run.err;
}

#ifdef __x86_64__
/// Nehalem (2008) has SSE4.2 but no AVX. Only the rays of Embree, which has kernels of its own, may differ there.
TEST(ProgramProcessor, RunsWithoutAvxOrSaysThatItNeedsIt) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    std::vector<std::string> words = solve_arguments(scene, folder / "old.h5");
    words.insert(words.begin(), {"-cpu", "Nehalem", program()});
    const Finished old = RunningProgram(words, {}, "/usr/bin/qemu-x86_64").finish();
    if ((sets_of_build & (avx | avx2)) != 0) {
        EXPECT_EQ(old.status, 1);
        EXPECT_NE(old.err.find("error: this build of exitance needs a processor with AVX\n"), std::string::npos)
            << old.err;
        EXPECT_NE(old.err.find("EXITANCE_ARCH"), std::string::npos) << old.err;
        return;
    }
    ASSERT_EQ(old.status, 0) << old.err;
    const Finished here = run_program(solve_arguments(scene, folder / "here.h5"));
    ASSERT_EQ(here.status, 0) << here.err;
    const nlohmann::json expected = nlohmann::json::parse(here.out)["energy"],
                         found = nlohmann::json::parse(old.out)["energy"];
    for (const char* const name : {"emitted", "absorbed"}) {
        const double value = expected[name].get<double>();
        EXPECT_NEAR(found[name].get<double>(), value, 1e-3 * value) << name;
    }
}
#endif

}  // namespace exitance::test
