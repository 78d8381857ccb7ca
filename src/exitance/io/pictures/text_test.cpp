#include "exitance/io/pictures/text.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace exitance {
namespace {

/// A picture with white text on black, 20 pixels from its upper left corner.
Image written(const std::string& text, int size) {
    Image image(200, 60);
    draw_text(image, 20, 20, text, size, {255, 255, 255});
    return image;
}

/// Bounds of the pixels that are not black: left, top, right, bottom.
std::array<int, 4> bounds(const Image& image) {
    std::array<int, 4> out{image.width, image.height, -1, -1};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (*image.at(x, y) > 0)
                out = {std::min(out[0], x), std::min(out[1], y), std::max(out[2], x), std::max(out[3], y)};
    return out;
}

}  // namespace

TEST(PictureText, CapitalsBeginAtTheirCorner) {
    const std::array<int, 4> box = bounds(written("H", 20));
    EXPECT_GE(box[0], 20);
    EXPECT_LE(box[0], 23);  // a letter has space of up to a tenth of its size on its left
    EXPECT_NEAR(box[1], 20, 1);
    EXPECT_NEAR(box[3], 20 + 0.73 * 20, 1);
    EXPECT_LE(box[2], 20 + text_width("H", 20));
}

TEST(PictureText, LettersHaveSmoothBorders) {
    const Image image = written("o", 20);
    EXPECT_TRUE(std::any_of(image.rgb.begin(), image.rgb.end(), [](std::uint8_t v) { return v > 40 && v < 215; }));
}

TEST(PictureText, WidthsAddUp) {
    EXPECT_NEAR(text_width("illuminance lx", 24), text_width("illuminance", 24) + text_width(" lx", 24), 1);
    EXPECT_EQ(text_width("", 24), 0);
    EXPECT_NEAR(text_width("100", 22), 2 * text_width("100", 11), 1);
}

TEST(PictureText, AccentedLettersOfUtf8AreOneLetter) {
    EXPECT_EQ(text_width("ä", 20), text_width("a", 20));
    EXPECT_LT(bounds(written("ä", 20))[1], bounds(written("a", 20))[1]);
}

TEST(PictureText, SquaresAreRaised) {
    const std::array<int, 4> two = bounds(written("2", 20)), square = bounds(written("^2", 20));
    EXPECT_LT(square[3], two[3] - 4);  // a raised 2 ends well above the line
    EXPECT_LT(text_width("m^2", 20), text_width("m2", 20));
}

TEST(PictureText, PixelsOutsideThePictureAreIgnored) {
    Image image(10, 10);
    draw_text(image, -8, -8, "Wide text", 40, {255, 255, 255});
    draw_text(image, 8, 8, "Wide text", 40, {255, 255, 255});
}

}  // namespace exitance
