#include "exitance/io/files/npy_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <numeric>
#include <sstream>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

std::string read_text(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

void write_text(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

}  // namespace

TEST(NpyFile, RowsAreReadBack) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.npy";
    Result<NpyWriter> writer = NpyWriter::create(path, NpyType::float32, 3, 4);
    ASSERT_TRUE(writer);
    std::vector<float> values(12);
    std::iota(values.begin(), values.end(), 0.5f);
    writer->append(std::span<const float>(values).first(5)), writer->append(std::span<const float>(values).subspan(5));
    ASSERT_TRUE(writer->commit());
    Result<NpyReader> reader = NpyReader::open(path);
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ(reader->rows(), 3u);
    EXPECT_EQ(reader->columns(), 4u);
    EXPECT_EQ(*reader->read<float>(1, 2), (std::vector<float>{4.5, 5.5, 6.5, 7.5, 8.5, 9.5, 10.5, 11.5}));
}

TEST(NpyFile, DamagedFilesAreErrors) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.npy";
    Result<NpyWriter> writer = NpyWriter::create(path, NpyType::float64, 2, 2);
    ASSERT_TRUE(writer);
    writer->append(std::vector<double>{1, 2, 3, 4});
    ASSERT_TRUE(writer->commit());
    const std::string whole = read_text(path);
    EXPECT_EQ((whole.size() - 4 * sizeof(double)) % 64, 0u);  // numbers begin at a multiple of 64 bytes
    for (std::size_t size = 0; size < whole.size(); size += 7) {
        write_text(path, whole.substr(0, size));
        EXPECT_FALSE(NpyReader::open(path)) << size;
    }
    write_text(path, whole + "x");
    EXPECT_FALSE(NpyReader::open(path));
    EXPECT_FALSE(NpyReader::open(folder / "none.npy"));
}

}  // namespace exitance
