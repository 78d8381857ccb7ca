#include "exitance/io/view_factors/raw_row_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

RawRow row_of(std::uint32_t face) {
    RawRow row;
    row.face = face, row.cast_density = 12.5, row.rays = 100;
    for (std::uint32_t j = 0; j < face + 1; ++j) row.entries.push_back({0.1 * (j + 1), j, 1e-6F, 3});
    return row;
}

/// Writes rows 0 and 2 of a scene of three faces.
std::string write_two(const TemporaryFolder& folder) {
    Result<RawRowFile> file = RawRowFile::open(folder / "F.rows", "work", false, 3);
    EXPECT_TRUE(file);
    file->keep(row_of(0)), file->keep(row_of(2)), file->flush();
    EXPECT_TRUE(file->is_whole());
    return folder / "F.rows";
}

TEST(RawRowFile, ReadsRowsBack) {
    const TemporaryFolder folder;
    Result<RawRowFile> file = RawRowFile::open(write_two(folder), "work", true, 3);
    ASSERT_TRUE(file);
    const std::vector<RawRow> rows = file->resumed();
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[1].face, 2U);
    EXPECT_EQ(rows[1].cast_density, 12.5);
    ASSERT_EQ(rows[1].entries.size(), 3U);
    EXPECT_EQ(rows[1].entries[2].F, row_of(2).entries[2].F);
}

TEST(RawRowFile, TruncatedAndDamagedRowsAreIgnoredAndOverwritten) {
    for (const bool cut : {true, false}) {
        const TemporaryFolder folder;
        const std::string path = write_two(folder);
        const auto bytes = std::filesystem::file_size(path);
        if (cut) {
            std::filesystem::resize_file(path, bytes - 5);
        } else {
            std::FILE* damaged = std::fopen(path.c_str(), "r+b");
            std::fseek(damaged, static_cast<long>(bytes) - 30, SEEK_SET), std::fputc(77, damaged), std::fclose(damaged);
        }
        {
            Result<RawRowFile> file = RawRowFile::open(path, "work", true, 3);
            ASSERT_TRUE(file);
            EXPECT_EQ(file->resumed().size(), 1U);
            file->keep(row_of(1)), file->flush();
        }
        Result<RawRowFile> again = RawRowFile::open(path, "work", true, 3);
        ASSERT_TRUE(again);
        EXPECT_EQ(again->resumed().size(), 2U);
    }
}

TEST(RawRowFile, RowsOfOtherWorkAreRejectedOrWithoutResumeSetAside) {
    const TemporaryFolder folder;
    const std::string path = write_two(folder);
    const Result<RawRowFile> other = RawRowFile::open(path, "other work", true, 3);
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().code, ErrorCode::bad_input);
    Result<RawRowFile> fresh = RawRowFile::open(path, "other work", false, 3);
    ASSERT_TRUE(fresh);
    EXPECT_TRUE(fresh->resumed().empty());
    EXPECT_EQ(fresh->set_aside(), 2U);
    EXPECT_TRUE(std::filesystem::exists(fresh->set_aside_path()));
    fresh->remove();
    EXPECT_FALSE(std::filesystem::exists(path));
    EXPECT_FALSE(std::filesystem::exists(path + ".old"));
}

TEST(RawRowFile, WithdrawnWorkRestoresTheRowsThatWereSetAside) {
    const TemporaryFolder folder;
    const std::string path = write_two(folder);
    RawRowFile::open(path, "work", false, 3)->withdraw();
    EXPECT_FALSE(std::filesystem::exists(path + ".old"));
    EXPECT_EQ(RawRowFile::open(path, "work", true, 3)->resumed().size(), 2U);
}

TEST(RawRowFile, FilesOfAnotherKindAreNotOverwritten) {
    const TemporaryFolder folder;
    std::ofstream(folder / "F.rows") << "notes on rows of chairs";
    for (const bool resume : {false, true}) {
        const Result<RawRowFile> file = RawRowFile::open(folder / "F.rows", "work", resume, 3);
        ASSERT_FALSE(file);
        EXPECT_EQ(file.error().code, ErrorCode::bad_input);
    }
    EXPECT_EQ(std::filesystem::file_size(folder / "F.rows"), 23U);
}

}  // namespace
}  // namespace exitance
