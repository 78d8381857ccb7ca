#include "exitance/io/pictures/linear_image.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "support/hdr_pixels.hpp"
#include "support/places.hpp"
#include "support/run.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// A picture of light over twelve orders of magnitude; every other row has one value.
Picture sample_picture(int width, int height) {
    Picture picture{{width, height}, std::vector<Pixel>(static_cast<std::size_t>(width * height))};
    RandomStream random(1, Stream::mesh);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        Pixel& pixel = picture.pixels[i];
        const bool flat = i / static_cast<std::size_t>(width) % 2 == 1;
        for (double& value : pixel.radiosity.value) value = flat ? 2.5 : std::pow(10, 12 * random.uniform() - 6);
        pixel.irradiance = 2 * pixel.radiosity;
        pixel.front = i % 5 == 0 ? 0.5f : 1.0f;
    }
    return picture;
}

TEST(WriteHdr, HoldsRadianceWithinAPercentOfThePixelsBrightestBand) {
    const TemporaryFolder folder;
    for (const int width : {5, 8, 300}) {
        const LinearImage image = linear_image(sample_picture(width, 6));
        ASSERT_TRUE(write_hdr(folder / "p.hdr", image, {{"units", "W/(m^2 sr)"}}));
        const Result<std::string> content = read_whole_file(folder / "p.hdr");
        ASSERT_TRUE(content);
        EXPECT_TRUE(content->starts_with("#?RADIANCE\n# units: W/(m^2 sr)\n"));
        EXPECT_NE(content->find("\nEXPOSURE=1\n"), std::string::npos);
        const auto pixels = read_hdr(*content, static_cast<std::size_t>(width), 6);
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const auto value = [&](std::size_t c) { return static_cast<double>(image.channels[c].values[i]); };
            const double brightest = std::max({value(0), value(1), value(2)});
            for (std::size_t c = 0; c < 3; ++c)  // tolerance: half a step of the mantissa, which is at least 128
                EXPECT_NEAR(pixels[i][c], value(c), brightest / 256 * 1.0001);
        }
    }
}

TEST(WriteExr, IsReadBackBitForBitByAnIndependentReader) {
    if (bands != 3 || run("/usr/bin/python3 -c 'import numpy'").status != 0) return;
    const TemporaryFolder folder;
    const LinearImage image = linear_image(sample_picture(37, 21));
    ASSERT_TRUE(write_exr(folder / "p.exr", image, {{"units", "W/(m^2 sr)"}}));
    const Ran ran = run("cd '" + test::source_folder() +
                        "/tests/readers' && /usr/bin/python3 -B -c '\nimport sys, exr\n"
                        "header, channels = exr.read_exr(sys.argv[1])\n"
                        "assert header[\"units\"] == b\"W/(m^2 sr)\"\n"
                        "for name in sys.argv[2:]: print(name, *(v.hex() for v in channels[name].ravel().tolist()))\n"
                        "' '" +
                        folder / "p.exr" + "' R G B A irradiance.R irradiance.G irradiance.B");
    ASSERT_EQ(ran.status, 0) << ran.output;
    std::istringstream words(ran.output);
    for (const LinearImage::Channel& channel : image.channels) {
        std::string word;
        words >> word;
        EXPECT_EQ(word, channel.name);
        for (const float value : channel.values) {
            words >> word;
            EXPECT_EQ(std::strtod(word.c_str(), nullptr), static_cast<double>(value));
        }
    }
}

TEST(LinearImage, IsRadianceAveragedOverThePixel) {
    Picture picture{{1, 1}, std::vector<Pixel>(1)};
    picture.pixels[0].radiosity = picture.pixels[0].irradiance = Spectrum(pi);
    picture.pixels[0].front = 0.25, picture.pixels[0].back = 0.5;
    const LinearImage image = linear_image(picture);
    EXPECT_FLOAT_EQ(image.channels[0].values[0], 0.25f);
    EXPECT_FLOAT_EQ(image.channels[3].values[0], 0.75f);
    EXPECT_FLOAT_EQ(image.channels[4].values[0], static_cast<float>(pi));
}

}  // namespace
}  // namespace exitance
