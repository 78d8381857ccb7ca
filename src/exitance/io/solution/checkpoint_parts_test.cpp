#include "exitance/io/solution/checkpoint_parts.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "exitance/io/files/atomic_file.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

const std::string content = "what a process keeps";

void write(const std::string& path, std::string_view bytes) {
    ASSERT_TRUE(write_file(path, bytes));
}

}  // namespace

TEST(CheckpointParts, AreReadAsWrittenOrAreErrorsThatNameTheFile) {
    const TemporaryFolder folder;
    const std::string checkpoint = folder / "room.h5.checkpoint", path = checkpoint_part_path(checkpoint, 7, 2);
    EXPECT_EQ(path, checkpoint + ".7.2");
    const CheckpointPart part{content.size(), checksum(content)};
    write(path, content);
    const Result<std::string> good = read_checkpoint_part(checkpoint, 7, 2, part);
    ASSERT_TRUE(good);
    EXPECT_EQ(*good, content);
    const auto expect_refused = [&](const std::string& why) {
        const Result<std::string> bad = read_checkpoint_part(checkpoint, 7, 2, part);
        ASSERT_FALSE(bad) << why;
        EXPECT_EQ(bad.error().code, ErrorCode::bad_input);
        EXPECT_EQ(bad.error().where, path);
        EXPECT_NE(bad.error().message.find(why), std::string::npos) << bad.error().message;
        EXPECT_NE(bad.error().hint.find("without --resume"), std::string::npos) << bad.error().hint;
    };
    write(path, content.substr(0, 5));
    expect_refused("has 5 bytes, and as a part of the checkpoint had 20");
    write(path, "what another one had");
    expect_refused("damaged, or a part of another checkpoint");
    std::filesystem::remove(path);
    expect_refused("is missing");
}

TEST(CheckpointParts, AreRemovedByGenerationWithoutOtherFiles) {
    const TemporaryFolder folder;
    const std::string checkpoint = folder / "room.h5.checkpoint";
    EXPECT_EQ(last_checkpoint_generation(checkpoint), 0u);
    const std::vector<std::string> parts{".3.1", ".3.2", ".12.1", ".13.1"},
        others{"", ".3", ".3.", ".3.x", ".3.1.h5", ".-3.1", ".x.1", ".3.1 "};
    for (const auto* const names : {&parts, &others})
        for (const std::string& name : *names) write(checkpoint + name, content);
    write(folder / "hall.h5.checkpoint.20.1", content);
    EXPECT_EQ(last_checkpoint_generation(checkpoint), 13u);
    remove_checkpoint_parts(checkpoint, 0, 13);
    EXPECT_EQ(folder.count(), others.size() + 2);
    EXPECT_TRUE(std::filesystem::exists(checkpoint + ".13.1"));
    remove_checkpoint_parts(checkpoint, 13, 14);
    EXPECT_EQ(folder.count(), others.size() + 1);
    EXPECT_EQ(last_checkpoint_generation(folder / "absent/room.h5.checkpoint"), 0u);
}

}  // namespace exitance
