#include "exitance/io/pictures/isolux.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

/// Illuminance that rises from 0 to 100 lx from left to right, on two regions, one above the other.
Picture ramp(int width, int height) {
    Picture picture{{width, height}, std::vector<Pixel>(static_cast<std::size_t>(width * height))};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            Pixel& pixel = picture.pixels[static_cast<std::size_t>(y * width + x)];
            pixel.front = 1;
            pixel.irradiance = Spectrum((y < height / 2 ? 1.0 : 0.5) * 100.0 * x / width);
            pixel.region = RegionId(std::size_t(y < height / 2 ? 0 : 1));
        }
    return picture;
}

TEST(Isolux, LinesAreAtTheStepsAndNotBetweenSurfaces) {
    const Picture picture = ramp(200, 40);
    Image image(200, 40);
    draw_isolux(image, picture, Quantity::illuminance, {{0, 25, 50, 75, 100}}, "illuminance lx");
    const auto is_drawn = [&](int x, int y) { return image.at(x, y)[0] > 0; };
    for (const int y : {1, 3, 5}) {
        // Lines of 25, 50 and 75 lx are between this pixel and the next.
        EXPECT_TRUE(is_drawn(49, y) && is_drawn(99, y) && is_drawn(149, y));
        EXPECT_FALSE(is_drawn(60, y) || is_drawn(120, y));
    }
    EXPECT_TRUE(is_drawn(99, 22));  // the lower surface has half the light: 25 lx
    int on_border = 0;
    for (int x = 0; x < 200; ++x) on_border += is_drawn(x, 19);
    EXPECT_LT(on_border, 10);
}

TEST(Isolux, LongLinesAreLabelled) {
    const Picture picture = ramp(200, 160);
    Image image(200, 160);
    draw_isolux(image, picture, Quantity::illuminance, {{0, 50, 100}}, "illuminance lx");
    int paper = 0;  // pixels of the label's background, on the line of 50 lx
    for (int y = 0; y < 80; ++y) paper += image.at(94, y)[2] == 24;
    EXPECT_GT(paper, 3);  // a label is higher than this
}

TEST(Isolux, LinesOfIrradianceAreAtTheMeanOfTheBands) {
    if constexpr (bands != 3) GTEST_SKIP() << "the bands of this build weigh alike";
    Picture picture = ramp(200, 40);
    for (Pixel& pixel : picture.pixels) {
        // Changes the luminous mean of the bands, but not their plain mean.
        pixel.irradiance[1] *= 0.5, pixel.irradiance[0] *= 1.5;
    }
    Image image(200, 40);
    draw_isolux(image, picture, Quantity::irradiance, {{0, 25, 50, 75, 100}}, title(Quantity::irradiance, false));
    for (const int y : {1, 3, 5}) EXPECT_TRUE(image.at(49, y)[0] > 0 && image.at(99, y)[0] > 0);
    EXPECT_EQ(title(Quantity::irradiance, false), "irradiance W/m^2");
    EXPECT_EQ(title(Quantity::illuminance, true), "illuminance lx");
    EXPECT_EQ(title(Quantity::illuminance, false).find("illuminance"), std::string::npos);
}

}  // namespace
}  // namespace exitance
