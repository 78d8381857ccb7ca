// Solves a square under a sky from a picture and compares its light with the sum over the pixels of the file.
#include <gtest/gtest.h>

#include <cmath>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/pictures/linear_image.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/scenes/sky_words.hpp"
#include "support/solved.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

constexpr int width = 256, height = 128;

/// A sky with clouds, a sun of one pixel and a dim ground; radiances by band and row.
LinearImage sky_image() {
    LinearImage out{width, height, {}};
    for (const char* name : {"R", "G", "B"}) {
        std::vector<float> values;
        for (int i = 0; i < width * height; ++i) {
            const int row = i / width, column = i % width;
            const double clouds = 2 + std::sin(0.2 * column) * std::cos(0.15 * row);
            values.push_back(static_cast<float>(row < height / 2 ? clouds * (5 + (name[0] == 'B' ? 7 : 0)) : 1.5));
        }
        values[30 * width + 77] = 20000;
        out.channels.push_back({name, std::move(values)});
    }
    return out;
}

/// Returns the irradiance of a horizontal plane: radiance times the integral of sin cos over each pixel.
double horizontal_sum(const LinearImage& image, std::size_t channel) {
    double sum = 0;
    for (int row = 0; row < height / 2; ++row) {
        const double top = std::sin(pi * (0.5 - row / (1.0 * height)));
        const double bottom = std::sin(pi * (0.5 - (row + 1) / (1.0 * height)));
        for (int column = 0; column < width; ++column)
            sum += image.channels[channel].values[static_cast<std::size_t>(row * width + column)] * 0.5 *
                   (top * top - bottom * bottom) * (2 * pi / width);
    }
    return sum;
}

TEST(PictureSky, ASolvedOpenSquareHasTheIrradianceOfThePixels) {
    const TemporaryFolder folder;
    const LinearImage image = sky_image();
    ASSERT_TRUE(write_exr(folder / "sky.exr", image, {}));
    ASSERT_TRUE(write_file(folder / "m.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n"));
    ASSERT_TRUE(
        write_file(folder / "s.obj", "mtllib m.mtl\nusemtl grey\nv -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0\nf 1 2 3 4\n"));
    LoadOptions load;
    Result<ChosenSky> sky = parse_sky("image=" + (folder / "sky.exr") + ",rotation=33", nullptr);
    ASSERT_TRUE(sky) << sky.error().message;
    EXPECT_EQ(sky->in_watts.discs.size(), 1U);
    load.sky = std::move(*sky);
    const std::vector<std::string> paths{folder / "s.obj"};
    const LoadedScene scene = load_scene(paths, load);
    ASSERT_TRUE(scene.scene);
    const Solution solution = solved(*scene.scene, {});
    double expected = 0;
    for (std::size_t band = 0; band < bands; ++band)
        expected +=
            (bands == 3 ? horizontal_sum(image, band)
                        : (horizontal_sum(image, 0) + horizontal_sum(image, 1) + horizontal_sum(image, 2)) / 3) /
            static_cast<double>(bands);
    // Half of the light that arrives on 100 m^2 is absorbed. Cells of 2.8 degrees blur the light by 1e-4.
    const double found = solution.statistics.energy.absorbed / 50;
    EXPECT_NEAR(found, expected, 2e-3 * expected);
}

}  // namespace
}  // namespace exitance
