#include <gtest/gtest.h>

#include "cli/small_scene.hpp"

namespace exitance::test {

TEST(ProgramExport, EveryEndingMakesAFileAndOthersAreUsageErrors) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    for (const std::string ending : {".vtkhdf", ".vtu", ".glb", ".csv", ".obj"}) {
        const std::string file = folder / ("lit" + ending);
        const Finished run = run_program({"export", solution, "-o", file});
        EXPECT_EQ(run.status, 0) << ending << run.err;
        EXPECT_FALSE(read_text(file).empty()) << ending;
    }
    const Finished run = run_program({"export", solution, "-o", folder / "lit.docx"});
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find("docx"), std::string::npos) << run.err;
    EXPECT_EQ(run_program({"export", solution, "-o", folder / "absent/lit.glb"}).status, 5);
}

}  // namespace exitance::test
