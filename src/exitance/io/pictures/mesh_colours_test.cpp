#include "exitance/io/pictures/mesh_colours.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

Rgb pixel_at(const Image& image, int x, int y) {
    const std::uint8_t* p = image.at(x, y);
    return {p[0], p[1], p[2]};
}

TEST(MeshColours, EdgesHaveTheColoursOfTheLegendAndOthersAreFaint) {
    Image image(4, 1);
    std::fill(image.rgb.begin(), image.rgb.end(), std::uint8_t(200));
    const std::vector<std::optional<CurveOrder>> edges = {CurveOrder::d0, CurveOrder::d2, CurveOrder::none,
                                                          std::nullopt};
    draw_ordered_edges(image, edges);
    const auto key = edge_order_key();
    EXPECT_EQ(pixel_at(image, 0, 0), key[0].colour);
    EXPECT_EQ(pixel_at(image, 1, 0), key[2].colour);
    EXPECT_EQ(pixel_at(image, 2, 0), (Rgb{150, 150, 150}));
    EXPECT_EQ(pixel_at(image, 3, 0), (Rgb{200, 200, 200}));
}

TEST(MeshColours, TheLegendShowsEveryColourAndFitsAnyPicture) {
    Image image(300, 200);
    draw_key(image, shadow_class_key());
    for (const KeyEntry& entry : shadow_class_key()) {
        bool shown = false;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) shown |= pixel_at(image, x, y) == entry.colour;
        EXPECT_TRUE(shown) << entry.name;
    }
    Image tiny(3, 2);
    draw_key(tiny, edge_order_key());
}

}  // namespace
}  // namespace exitance
