#include "exitance/io/files/atomic_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

class AtomicFiles : public testing::Test {
  protected:
    std::string read(const fs::path& path) const {
        std::ifstream in(path);
        std::stringstream text;
        text << in.rdbuf();
        return text.str();
    }
    TemporaryFolder folder;
};

TEST_F(AtomicFiles, AppearWithTheirContentAndLeaveNoOtherFile) {
    ASSERT_TRUE(write_file(folder / "a.txt", "light"));
    EXPECT_EQ(read(folder / "a.txt"), "light");
    EXPECT_EQ(folder.count(), 1u);
}

TEST_F(AtomicFiles, KeepTheOldFileUntilCommit) {
    const fs::path path = folder / "a.txt";
    ASSERT_TRUE(write_file(path.string(), "old"));
    {
        Result<AtomicFile> file = AtomicFile::create(path.string());
        ASSERT_TRUE(file);
        file->write(std::string(1 << 20, 'x'));
        EXPECT_EQ(read(path), "old");
    }
    EXPECT_EQ(read(path), "old");
    EXPECT_EQ(folder.count(), 1u);
}

TEST_F(AtomicFiles, AcceptManySmallPieces) {
    Result<AtomicFile> file = AtomicFile::create(folder / "a.txt");
    ASSERT_TRUE(file);
    std::string all;
    for (int i = 0; i < 100000; ++i) {
        const std::string piece = std::to_string(i) + "\n";
        file->write(piece);
        all += piece;
    }
    ASSERT_TRUE(file->commit());
    EXPECT_EQ(read(folder / "a.txt"), all);
}

TEST_F(AtomicFiles, ReportWhyTheyCannotBeWritten) {
    const std::string missing = folder / "no/a.txt";
    const Result<void> written = write_file(missing, "x");
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::cannot_write);
    EXPECT_NE(written.error().where.find(missing), std::string::npos);
    EXPECT_NE(written.error().message.find("No such file"), std::string::npos);
    EXPECT_EQ(write_file(fs::path(folder / "").parent_path().string(), "x").error().code, ErrorCode::cannot_write);
    EXPECT_EQ(write_file("", "x").error().code, ErrorCode::cannot_write);
}

TEST_F(AtomicFiles, FullDisksAreReported) {
    if (!fs::exists("/dev/full")) return;
    const Result<void> written = write_file("/dev/full", "x");
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().message.find("No space"), std::string::npos);
}

TEST_F(AtomicFiles, FollowLinksAndKeepPermissions) {
    ASSERT_TRUE(write_file(folder / "a.txt", "old"));
    fs::permissions(folder / "a.txt", fs::perms::owner_read | fs::perms::owner_write);
    fs::create_symlink("a.txt", folder / "link");
    ASSERT_TRUE(write_file(folder / "link", "new"));
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(read(folder / "a.txt"), "new");
    EXPECT_EQ(fs::status(folder / "a.txt").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(AtomicFiles, AreWrittenAndReadAnywhere) {
    const auto bytes = [](std::string_view text) { return std::as_bytes(std::span(text)); };
    Result<AtomicFile> file = AtomicFile::create(folder / "a.txt");
    ASSERT_TRUE(file);
    file->write_at(3, bytes("light"));
    file->write_at(0, bytes("ray"));
    std::array<std::byte, 10> there;
    file->read_at(1, there);
    EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(there.data()), 10), std::string_view("aylight\0\0\0", 10));
    EXPECT_FALSE(fs::exists(folder / "a.txt"));
    ASSERT_TRUE(file->commit());
    EXPECT_EQ(read(folder / "a.txt"), "raylight");
    // A path without random access gets the whole content at the end.
    if (!fs::exists("/dev/full")) return;
    Result<AtomicFile> full = AtomicFile::create("/dev/full");
    ASSERT_TRUE(full);
    full->write_at(0, bytes("ray"));
    EXPECT_FALSE(full->failed());
    const Result<void> written = full->commit();
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().message.find("No space"), std::string::npos);
}

TEST_F(AtomicFiles, DevicesAreWrittenToDirectly) {
    ASSERT_TRUE(write_file("/dev/null", "x"));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(AtomicFiles, AreRemovedBySignalsBeforeCommit) {
    Result<AtomicFile> file = AtomicFile::create(folder / "a");
    ASSERT_TRUE(file);
    const AtomicFile moved = std::move(*file);
    EXPECT_EQ(folder.count(), 1u);
    remove_unfinished_files();
    EXPECT_EQ(folder.count(), 0u);
}

}  // namespace
}  // namespace exitance
