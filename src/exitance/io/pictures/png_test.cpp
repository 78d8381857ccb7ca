#include "exitance/io/pictures/png.hpp"

#include <gtest/gtest.h>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/pictures/false_colour.hpp"
#include "exitance/io/pictures/text.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

TEST(Png, HasTheStructureOfPngAndItsTexts) {
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

TEST(Png, IsAbsentIfItCannotBeWritten) {
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

TEST(FalseColour, StepsAreRoundAndIncludeTheValues) {
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

TEST(FalseColour, ScalesHaveTheRequestedRangeBandsAndSpacing) {
    const Picture picture = ramp(5.3, 39);
    const auto scale = [&](const ScaleChoice& choice) {
        return make_colour_scale(picture, Quantity::irradiance, choice);
    };
    const ColourScale range = scale({.range = std::pair(0.0, 500.0)});
    EXPECT_EQ(range.steps.front(), 0);
    EXPECT_EQ(range.steps.back(), 500);
    EXPECT_EQ(scale({.range = std::pair(0.0, 500.0), .bands = 5}).steps,
              (std::vector<double>{0, 100, 200, 300, 400, 500}));
    const ColourScale ratio = scale({.range = std::pair(1.0, 1000.0), .by_ratio = true, .bands = 3});
    EXPECT_NEAR(ratio.steps[1], 10, 1e-9);
    EXPECT_NEAR(ratio.steps[2], 100, 1e-9);
    const ColourScale smooth = scale({.range = std::pair(0.0, 100.0), .smooth = true, .palette = Palette::grey});
    EXPECT_LT(smooth.colour(20)[0], smooth.colour(21.5)[0]);
    EXPECT_EQ(range.colour(20), range.colour(21.5));
    EXPECT_NEAR(smooth.place(50), 0.5, 1e-12);
}

TEST(FalseColour, ScaleIsValidInDarknessAndUniformLight) {
    EXPECT_GE(make_colour_scale(ramp(0, 0), Quantity::irradiance).band_count(), 1u);
    EXPECT_GE(make_colour_scale(ramp(3, 3), Quantity::radiosity).band_count(), 1u);
    EXPECT_GE(make_colour_scale(ramp(3, 3), Quantity::illuminance).band_count(), 1u);
    EXPECT_GE(make_colour_scale(Picture{}, Quantity::luminance).band_count(), 1u);
}

TEST(FalseColour, LegendStaysWithinASmallPicture) {
    Image image(20, 10);
    draw_legend(image, "luminance cd/m^2", {{0, 1, 2, 5, 10}});  // sanitizers detect writes outside the picture
    EXPECT_EQ(image.rgb.size(), 600u);
}

}  // namespace
}  // namespace exitance
