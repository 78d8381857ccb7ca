#include "exitance/io/files/radiance_matrix.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include "exitance/io/files/whole_file.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

void write(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

}  // namespace

TEST(RadianceMatrix, EveryFormatIsReadBack) {
    const TemporaryFolder folder;
    const std::string path = folder / "m.mtx";
    const std::vector<double> first{0, 0.125, 1.0 / 3}, second{-2, 1e-9, 12345.678};
    for (const MatrixFormat format : {MatrixFormat::ascii, MatrixFormat::float32, MatrixFormat::float64}) {
        Result<RadianceMatrixWriter> writer = RadianceMatrixWriter::create(path, format, 2, 3);
        ASSERT_TRUE(writer);
        writer->append_row(first), writer->append_row(second);
        ASSERT_TRUE(writer->commit());
        const Result<RadianceMatrix> read = read_radiance_matrix(path);
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(read->rows, 2u);
        EXPECT_EQ(read->columns, 3u);
        EXPECT_EQ(read->components, 3u);
        for (std::size_t i = 0; i < 6; ++i) {
            const double expected = i < 3 ? first[i] : second[i - 3];
            for (std::size_t c = 0; c < 3; ++c)  // seven digits in text, 24 bits in binary
                EXPECT_NEAR(double(read->values[3 * i + c]), expected, 5e-7 * std::abs(expected));
        }
    }
}

TEST(RadianceMatrix, FilesOfRadianceAreRead) {
    const TemporaryFolder folder;
    const std::string path = folder / "m.mtx";
    // Programs of Radiance add lines, and may write one component and no NROWS.
    write(path,
          "#?RADIANCE\nrcontrib -I+ -fo\nSOFTWARE= RADIANCE 5.4\nCAPDATE= 2026:01:01\nNCOMP=1\nNCOLS=2\n"
          "FORMAT=ascii\n\n1.5\t2\n3e-1 4\n5 6\n");
    const Result<RadianceMatrix> text = read_radiance_matrix(path);
    ASSERT_TRUE(text) << text.error().message;
    EXPECT_EQ(text->rows, 3u);
    EXPECT_EQ(text->values, (std::vector<float>{1.5f, 2, 0.3f, 4, 5, 6}));
    std::string bytes(2 * sizeof(float), '\0');
    const float values[2] = {1.25f, -7};
    std::memcpy(bytes.data(), values, bytes.size());
    std::reverse(bytes.begin(), bytes.begin() + 4), std::reverse(bytes.begin() + 4, bytes.end());
    write(path, "#?RADIANCE\nNROWS=2\nNCOLS=1\nNCOMP=1\nBigEndian=1\nFORMAT=float\n\n" + bytes);
    const Result<RadianceMatrix> binary = read_radiance_matrix(path);
    ASSERT_TRUE(binary) << binary.error().message;
    EXPECT_EQ(binary->values, (std::vector<float>{1.25f, -7}));
}

TEST(RadianceMatrix, DamagedFilesAreErrors) {
    const TemporaryFolder folder;
    const std::string path = folder / "m.mtx", start = "#?RADIANCE\nNROWS=2\nNCOLS=1\nNCOMP=1\n";
    for (const std::string& text :
         {std::string(), std::string("NROWS=2\n\n"), start, start + "FORMAT=ascii\n\n1\n",
          start + "FORMAT=ascii\n\n1 2 3\n", start + "FORMAT=32-bit_rle_rgbe\n\n1 2",
          start + "FORMAT=double\n\n12345678", std::string("#?RADIANCE\nNCOLS=-3\nFORMAT=ascii\n\n1"),
          std::string("#?RADIANCE\nFORMAT=ascii\n\n1 2 3\n")}) {
        write(path, text);
        EXPECT_FALSE(read_radiance_matrix(path)) << text;
    }
    EXPECT_FALSE(read_radiance_matrix(folder / "none.mtx"));
}

}  // namespace exitance
