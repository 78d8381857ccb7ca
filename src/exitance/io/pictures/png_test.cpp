#include "exitance/io/pictures/png.hpp"

#include <gtest/gtest.h>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/pictures/bitmap_font.hpp"
#include "exitance/io/pictures/false_colour.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

TEST(Png, BeginsAndEndsAsPngDoesAndSaysWhatItIsTold) {
    const TemporaryFolder folder;
    Image image(5, 3);
    fill_rectangle(image, -2, 1, 4, 9, {10, 200, 30});
    ASSERT_TRUE(static_cast<bool>(write_png(folder / "a.png", image, {{"Exposure", "+1 stops"}})));
    const Result<std::string> bytes = read_whole_file(folder / "a.png");
    ASSERT_TRUE(static_cast<bool>(bytes));
    EXPECT_TRUE(bytes->starts_with("\x89PNG\r\n\x1a\n"));
    EXPECT_EQ(bytes->substr(bytes->size() - 8, 4), "IEND");
    EXPECT_NE(bytes->find(std::string("tEXtExposure\0+1 stops", 21)), std::string::npos);
    EXPECT_EQ(bytes->substr(16, 8), std::string("\0\0\0\5\0\0\0\3", 8));  // width and height
}

TEST(Png, IsAbsentWhereItCannotBeWritten) {
    const TemporaryFolder folder;
    const Result<void> written = write_png(folder / "absent/a.png", Image(2, 2), {});
    ASSERT_FALSE(static_cast<bool>(written));
    EXPECT_EQ(written.error().code, ErrorCode::cannot_write);
    EXPECT_EQ(folder.count(), 0u);
}

Picture ramp(double lo, double hi) {
    Picture picture{{100, 1}, std::vector<Pixel>(100)};
    for (std::size_t i = 0; i < 100; ++i) {
        picture.pixels[i].front = 1;
        picture.pixels[i].irradiance = Spectrum(lo + (hi - lo) * static_cast<double>(i) / 99);
    }
    return picture;
}

TEST(FalseColour, StepsAreRoundAndHoldWhatIsShown) {
    const ColourScale linear = make_colour_scale(ramp(5.3, 39), Quantity::irradiance);
    EXPECT_EQ(linear.names().front(), "5");
    EXPECT_EQ(linear.names()[1], "10");
    EXPECT_EQ(linear.names().back(), "40");
    const ColourScale by_ratio = make_colour_scale(ramp(0.03, 700), Quantity::irradiance);
    EXPECT_EQ(by_ratio.names().back(), "1000");
    for (const ColourScale& scale : {linear, by_ratio}) {
        EXPECT_EQ(scale.band(-1e9), 0u);
        EXPECT_EQ(scale.band(1e9), scale.band_count() - 1);
        for (std::size_t i = 0; i + 1 < scale.steps.size(); ++i)
            EXPECT_EQ(scale.band(0.5 * (scale.steps[i] + scale.steps[i + 1])), i);
    }
}

TEST(FalseColour, ScaleStandsInTheDarkAndInUniformLight) {
    EXPECT_GE(make_colour_scale(ramp(0, 0), Quantity::irradiance).band_count(), 1u);
    EXPECT_GE(make_colour_scale(ramp(3, 3), Quantity::radiosity).band_count(), 1u);
    EXPECT_GE(make_colour_scale(ramp(3, 3), Quantity::illuminance).band_count(), 1u);
    EXPECT_GE(make_colour_scale(Picture{}, Quantity::luminance).band_count(), 1u);
}

TEST(FalseColour, LegendStaysWithinASmallPicture) {
    Image image(20, 10);
    draw_legend(image, Quantity::luminance, {{0, 1, 2, 5, 10}});  // sanitizers would tell
    EXPECT_EQ(image.rgb.size(), 600u);
}

}  // namespace
}  // namespace exitance
