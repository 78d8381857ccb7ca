#include "exitance/io/scenes/textures/texture_area.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace exitance {
namespace {

using Wrap = TextureArea::Wrap;

/// A picture whose pixels are 255 where `white(x, y)` is true, else 0.
template <class White>
TextureArea picture(std::size_t width, std::size_t height, White&& white) {
    TexturePixels pixels{width, height, std::vector<std::uint8_t>(3 * width * height)};
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t c = 0; c < 3; ++c) pixels.rgb[3 * (y * width + x) + c] = white(x, y) ? 255 : 0;
    return TextureArea::of(pixels, linear_curve());
}

std::vector<Vec2> square(double x, double y, double size) {
    return {{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}};
}

TEST(TextureArea, APartHasItsDeviationAndRange) {
    const TextureArea halves = picture(64, 64, [](std::size_t x, std::size_t) { return x < 32; });
    const TextureArea::Part all = halves.part(square(0, 0, 1), Wrap::repeat, Wrap::repeat);
    EXPECT_NEAR(all.deviation[0], 0.5, 0.01);  // the border is resolved to half the distance of 32 samples
    EXPECT_EQ(all.lowest[0], 0);
    EXPECT_EQ(all.highest[0], 1);
    EXPECT_EQ(halves.part(square(0, 0, 0.5), Wrap::repeat, Wrap::repeat).deviation[0], 0);
}

TEST(TextureArea, AFaceShowsItsOwnPart) {
    const TextureArea halves = picture(64, 64, [](std::size_t x, std::size_t) { return x < 32; });
    EXPECT_DOUBLE_EQ(halves.mean()[0], 0.5);
    EXPECT_DOUBLE_EQ(halves.mean(square(0, 0, 0.5), Wrap::repeat, Wrap::repeat)[0], 1);
    EXPECT_DOUBLE_EQ(halves.mean(square(0.5, 0.5, 0.5), Wrap::repeat, Wrap::repeat)[1], 0);
    const std::vector<Vec2> triangle = {{0, 0}, {1, 0}, {0, 1}};  // three quarters of its area are in the left half
    EXPECT_NEAR(halves.mean(triangle, Wrap::repeat, Wrap::repeat)[2], 0.75, 0.01);
}

TEST(TextureArea, CoordinatesMayBeBeyondTheBorder) {
    const TextureArea halves = picture(64, 64, [](std::size_t x, std::size_t) { return x < 32; });
    const auto mean = [&](double x, Wrap wrap) { return halves.mean(square(x, 0, 0.25), wrap, Wrap::repeat)[0]; };
    EXPECT_EQ(mean(7.1, Wrap::repeat), 1);
    EXPECT_EQ(mean(-0.9, Wrap::repeat), 1);
    EXPECT_EQ(mean(1.1, Wrap::mirror), 0);
    EXPECT_EQ(mean(1.7, Wrap::mirror), 1);
    EXPECT_EQ(mean(7.1, Wrap::clamp), 0);
    EXPECT_EQ(mean(-3, Wrap::clamp), 1);
}

TEST(TextureArea, ManyRepetitionsGiveTheMean) {
    const TextureArea stripes = picture(256, 256, [](std::size_t x, std::size_t y) { return (x + y) % 4 == 0; });
    EXPECT_NEAR(stripes.mean(square(0.1, 0.3, 40), Wrap::repeat, Wrap::repeat)[0], 0.25, 1e-4);
    // a quadrilateral that is half a pixel high
    const std::vector<Vec2> narrow = {{0, 0.5}, {1, 0.5}, {1, 0.502}, {0, 0.502}};
    EXPECT_NEAR(stripes.mean(narrow, Wrap::repeat, Wrap::repeat)[0], 0.25, 0.1);
}

TEST(TextureArea, DegenerateOutlinesShowAPixel) {
    const TextureArea halves = picture(8, 8, [](std::size_t x, std::size_t) { return x < 4; });
    const std::vector<Vec2> point(3, Vec2{0.2, 0.2});
    EXPECT_EQ(halves.mean(point, Wrap::repeat, Wrap::repeat)[0], 1);
    const std::vector<Vec2> nowhere = {{std::numeric_limits<double>::quiet_NaN(), 0}, {1, 0}, {1, 1}};
    EXPECT_EQ(halves.mean(nowhere, Wrap::repeat, Wrap::repeat)[0], 0.5);
    EXPECT_EQ(halves.mean({}, Wrap::repeat, Wrap::repeat)[0], 0.5);
}

TEST(TextureArea, LargePicturesAreReduced) {
    const TextureArea large = picture(4097, 2050, [](std::size_t x, std::size_t) { return x < 2048; });
    EXPECT_NEAR(large.mean()[0], 2048.0 / 4097, 1e-9);
    EXPECT_EQ(large.mean(square(0, 0, 0.49), Wrap::repeat, Wrap::repeat)[0], 1);
    EXPECT_EQ(large.mean(square(0.51, 0, 0.4), Wrap::repeat, Wrap::repeat)[0], 0);
}

}  // namespace
}  // namespace exitance
