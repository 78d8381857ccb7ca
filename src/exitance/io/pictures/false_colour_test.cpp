#include "exitance/io/pictures/false_colour.hpp"

#include <gtest/gtest.h>

#include <set>

namespace exitance {
namespace {

/// A picture of surfaces whose irradiance at the pixel (x, y) is value(x, y).
template <class Value>
Picture picture_of(int width, int height, const Value& value) {
    Picture picture;
    picture.size = {width, height};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            Pixel pixel;
            pixel.irradiance = Spectrum(value(x, y));
            pixel.front = 1;
            picture.pixels.push_back(pixel);
        }
    return picture;
}

Rgb colour_at(const Image& image, int x, int y) {
    return {image.at(x, y)[0], image.at(x, y)[1], image.at(x, y)[2]};
}

const ColourScale two_colours{{0, 10, 20}};

}  // namespace

TEST(FalseColour, BordersBetweenColoursAreSmooth) {
    // The border at 10 runs diagonally, one row for every four columns.
    const Image image = false_colour_image(picture_of(40, 12, [](int x, int y) { return 6.1 + 0.1 * x + 0.4 * y; }),
                                           Quantity::irradiance, two_colours);
    const Rgb low = two_colours.colour(5), high = two_colours.colour(15);
    std::set<int> between;
    for (int x = 1; x + 1 < 40; ++x)
        if (const Rgb c = colour_at(image, x, 6); c != low && c != high) between.insert(c[1]);
    EXPECT_GE(between.size(),
              3u);  // light changes by 0.5 per pixel in all and by 0.1 per column, so the border is five columns wide
    EXPECT_EQ(colour_at(image, 2, 2), low);
    EXPECT_EQ(colour_at(image, 38, 10), high);
}

TEST(FalseColour, EdgesOfSurfacesAreNotBlurred) {
    const Image image = false_colour_image(picture_of(10, 5, [](int x, int) { return x < 5 ? 2.0 : 18.0; }),
                                           Quantity::irradiance, two_colours);
    EXPECT_EQ(colour_at(image, 4, 2), two_colours.colour(2));
    EXPECT_EQ(colour_at(image, 5, 2), two_colours.colour(18));
}

}  // namespace exitance
