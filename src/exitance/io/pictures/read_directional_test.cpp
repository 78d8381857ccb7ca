#include "exitance/io/pictures/read_directional.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/pictures/linear_image.hpp"
#include "exitance/io/scenes/sky_words.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

class DirectionalFiles : public testing::Test {
  protected:
    std::string write(const std::string& name, const std::string& content) {
        EXPECT_TRUE(write_file(folder / name, content));
        return folder / name;
    }
    /// Returns the message of the error for a file with that content.
    std::string refusal(const std::string& name, const std::string& content) {
        const auto read = read_directional_picture(write(name, content));
        EXPECT_FALSE(read) << name;
        return read ? "" : read.error().message;
    }
    static LinearImage image(int width, int height, float value = 2) {
        LinearImage out{width, height, {}};
        for (const char* name : {"R", "G", "B"}) {
            out.channels.push_back({name, {}});
            for (int i = 0; i < width * height; ++i)
                out.channels.back().values.push_back(value + static_cast<float>(i % 13) +
                                                     static_cast<float>(out.channels.size()));
        }
        return out;
    }
    TemporaryFolder folder;
};

TEST_F(DirectionalFiles, BothFormatsHoldThePicturesThatAreWritten) {
    for (const int height : {2, 16, 64}) {  // narrow rows are not encoded as runs
        const LinearImage written = image(2 * height, height);
        for (const char* name : {"p.hdr", "p.exr"}) {
            const std::string path = folder / name;
            ASSERT_TRUE(std::string_view(name) == "p.hdr" ? write_hdr(path, written, {})
                                                          : write_exr(path, written, {}));
            const auto read = read_directional_picture(path);
            ASSERT_TRUE(read) << read.error().message;
            ASSERT_EQ(read->radiance.size(), written.channels[0].values.size() * bands);
            if (bands != 3) continue;
            for (std::size_t i = 0; i < read->radiance.size(); ++i) {
                const float value = written.channels[i % 3].values[i / 3];
                // tolerance: half a step of a mantissa of 8 bits
                EXPECT_NEAR(read->radiance[i], value, 0.5 / 64 * 17) << name;
            }
        }
    }
}

TEST_F(DirectionalFiles, HeadersAreFollowed) {
    const std::string pixels("\x80\x80\x80\x81\x80\x80\x80\x82\1\1\1\1\x40\x40\x40\x81\x40\x40\x40\x81\1\1\1\3", 24);
    // The rows hold 1, 2, 2, 0.5 (a run of two, then one) and 0.5, ...: values at the middle of their intervals.
    const auto read = read_directional_picture(
        write("old.hdr", "#?RGBE\nEXPOSURE=2\nEXPOSURE=0.5\nCOLORCORR=1 1 1\n\n-Y 2 +X 4\n" + pixels));
    ASSERT_TRUE(read) << read.error().message;
    const double half = 0.5 / 128;
    EXPECT_NEAR(read->radiance[0], 1 + half, 1e-6);
    EXPECT_NEAR(read->radiance[bands], 2 + 2 * half, 1e-6);
    EXPECT_NEAR(read->radiance[2 * bands], 2 + 2 * half, 1e-6);
    EXPECT_NEAR(read->radiance[3 * bands], 0.5 + half, 1e-6);
    const auto turned = read_directional_picture(write("turned.hdr", "#?RADIANCE\nEXPOSURE=4\n\n+Y 2 -X 4\n" + pixels));
    ASSERT_TRUE(turned);
    EXPECT_NEAR(turned->radiance[7 * bands], (1 + half) / 4, 1e-6);  // the first pixel is the last
}

TEST_F(DirectionalFiles, WrongPicturesAreRefused) {
    EXPECT_NE(refusal("wide.hdr", "#?RADIANCE\n\n-Y 3 +X 4\n").find("4 x 3 pixels"), std::string::npos);
    EXPECT_NE(refusal("large.hdr", "#?RADIANCE\n\n-Y 8192 +X 16384\n").find("16384 pixels wide"), std::string::npos);
    EXPECT_NE(refusal("short.hdr", "#?RADIANCE\n\n-Y 32 +X 64\nabc").find("row 1 of 32"), std::string::npos);
    EXPECT_NE(refusal("xyz.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 2 +X 4\n").find("xyze"), std::string::npos);
    EXPECT_NE(refusal("size.hdr", "#?RADIANCE\n\n+X 4 -Y 2\n").find("is not a size of rows"), std::string::npos);
    EXPECT_NE(refusal("zero.hdr", "#?RADIANCE\nEXPOSURE=0\n\n-Y 2 +X 4\n").find("EXPOSURE"), std::string::npos);
    EXPECT_NE(refusal("head.hdr", "#?RADIANCE\n").find("ends within"), std::string::npos);
    EXPECT_NE(refusal("text.hdr", "hello").find("#?RADIANCE"), std::string::npos);
    EXPECT_NE(refusal("text.exr", "hello").find("OpenEXR"), std::string::npos);
    EXPECT_NE(refusal("sky.png", "hello").find(".png holds no radiances"), std::string::npos);
    EXPECT_NE(refusal("sky", "hello").find("no file name ending"), std::string::npos);
    const auto missing = read_directional_picture(folder / "missing.hdr");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::cannot_read);
    EXPECT_EQ(read_directional_picture(folder / "missing.exr").error().code, ErrorCode::cannot_read);
    for (const float bad : {-1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        LinearImage wrong = image(8, 4);
        wrong.channels[1].values[9] = bad;
        ASSERT_TRUE(write_exr(folder / "bad.exr", wrong, {}));
        const auto read = read_directional_picture(folder / "bad.exr");
        ASSERT_FALSE(read) << bad;
        EXPECT_NE(read.error().message.find("column 2, row 2"), std::string::npos) << read.error().message;
    }
}

TEST_F(DirectionalFiles, WordsOfASkyAreChecked) {
    const std::string path = folder / "sky.hdr";
    ASSERT_TRUE(write_hdr(path, image(64, 32), {}));
    const auto sky = parse_sky("image=" + path + ",rotation=-30,scale=2", nullptr);
    ASSERT_TRUE(sky) << sky.error().message;
    const auto plain = parse_sky("image=" + path, nullptr);
    ASSERT_TRUE(plain);
    EXPECT_NEAR(sky->in_watts.domes[0].irradiance[0] / plain->in_watts.domes[0].irradiance[0], 2, 1e-12);
    EXPECT_NEAR(sky->in_lumens.domes[0].irradiance[0] / sky->in_watts.domes[0].irradiance[0], 179, 1e-9);
    for (const char* wrong :
         {"rotation=400", "rotation=", "scale=0", "scale=-1", "turn=3", "rotation=1,rotation=2", ""})
        EXPECT_FALSE(parse_sky("image=" + path + "," + wrong, nullptr)) << wrong;
    EXPECT_FALSE(parse_sky("image=", nullptr));
    LinearImage black = image(8, 4);
    for (auto& channel : black.channels) std::fill(channel.values.begin(), channel.values.end(), 0.0F);
    ASSERT_TRUE(write_hdr(folder / "black.hdr", black, {}));
    EXPECT_NE(parse_sky("image=" + (folder / "black.hdr"), nullptr).error().message.find("black"), std::string::npos);
}

}  // namespace
}  // namespace exitance
