#include "exitance/io/solution/checkpoint_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "exitance/io/files/whole_file.hpp"
#include "support/built_scene.hpp"
#include "support/sample_solution.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

const CheckpointFacts facts{{"seed", "1"}, {"error", "0.02"}};
constexpr double always = 0, never = std::numeric_limits<double>::infinity();

}  // namespace

TEST(CheckpointFile, ReturnsTheStateThatWasKeptLast) {
    const TemporaryFolder folder;
    const std::string path = folder / "room.h5.checkpoint";
    CheckpointFile file(path, facts, always);
    EXPECT_FALSE(*file.load()) << "there is none";
    EXPECT_TRUE(file.is_due());
    EXPECT_FALSE(CheckpointFile(path, facts, never).is_due());
    file.keep("first"), file.keep(std::string("sec\0nd", 6));
    EXPECT_TRUE(file.written());
    CheckpointFile again(path, facts, never);
    ASSERT_TRUE(*again.load());
    EXPECT_EQ(again.resumed(), std::string("sec\0nd", 6));
    again.remove();
    EXPECT_EQ(folder.count(), 0u);
}

TEST(CheckpointFile, ARunWithOtherFactsIsAnErrorThatNamesTheDifference) {
    const TemporaryFolder folder;
    const std::string path = folder / "room.h5.checkpoint";
    CheckpointFile(path, facts, always).keep("state");
    CheckpointFile other(path, {{"seed", "1"}, {"error", "0.01"}}, never);
    const Result<bool> loaded = other.load();
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().code, ErrorCode::bad_input);
    EXPECT_NE(loaded.error().message.find("error was 0.02 and is 0.01"), std::string::npos) << loaded.error().message;
}

TEST(CheckpointFile, DamageIsDetectedAnywhere) {
    const TemporaryFolder folder;
    const std::string path = folder / "room.h5.checkpoint";
    CheckpointFile(path, facts, always).keep("state");
    const std::string good = *read_whole_file(path);
    for (std::size_t i = 0; i <= good.size(); ++i) {
        std::string bad = good.substr(0, i);
        if (i + 1 < good.size() && i % 2 == 0) bad = good, bad[i] = static_cast<char>(bad[i] ^ 4);
        if (bad == good) continue;
        std::ofstream(path, std::ios::binary) << bad;
        const Result<bool> loaded = CheckpointFile(path, facts, never).load();
        ASSERT_FALSE(loaded) << i;
        EXPECT_EQ(loaded.error().code, ErrorCode::bad_input);
    }
}

TEST(CheckpointFile, AMissingFolderIsReportedWithoutOtherEffects) {
    const TemporaryFolder folder;
    CheckpointFile file(folder / "absent/room.checkpoint", facts, always);
    file.keep("state");
    ASSERT_FALSE(file.written());
    EXPECT_EQ(file.written().error().code, ErrorCode::cannot_write);
}

TEST(SceneFingerprint, DiffersBetweenScenes) {
    EXPECT_EQ(scene_fingerprint(sample_scene()), scene_fingerprint(sample_scene()));
    EXPECT_NE(scene_fingerprint(sample_scene()), scene_fingerprint(box_scene(1, 1, 1, 0.5, 1, 0)));
    EXPECT_NE(scene_fingerprint(box_scene(1, 1, 1, 0.5, 1, 0)), scene_fingerprint(box_scene(1, 1, 1, 0.6, 1, 0)));
}

}  // namespace exitance
