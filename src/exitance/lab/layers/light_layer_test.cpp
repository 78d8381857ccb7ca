#include "exitance/solution/layers/light_layer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/lab/layers/winged_edge_bytes.hpp"

namespace exitance {
namespace {

/// A grid of 2 n^2 triangles over 3 x 2 metres; light decreases from a corner and is 0 beyond x = 2.
LayerTriangles grid(std::uint32_t n) {
    const auto light = [](const Vec2& p) { return p.x >= 2 ? 0 : 100 * (2 - p.x) * std::exp(-p.y); };
    LayerTriangles out;
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= n; ++j) out.points.push_back({3.0 * i / n, 2.0 * j / n});
    for (const Vec2& p : out.points) out.values.push_back(light(p));
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        out.corners.push_back({a, b, c});
        const auto middle = [&](std::uint32_t x, std::uint32_t y) {
            return light(0.5 * (out.points[x] + out.points[y]));
        };
        out.middles.push_back({middle(a, b), middle(b, c), middle(c, a)});
    };
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
            add(a, b, b + 1);
            add(a, b + 1, a + 1);
        }
    return out;
}

}  // namespace

TEST(LightLayer, CompressedFormsHoldTheSameLightInHalfAndAQuarterOfTheBytes) {
    const LayerTriangles all = grid(30);
    const double winged = static_cast<double>(winged_edge_bytes(all));
    EXPECT_NEAR(winged / static_cast<double>(all.corners.size()), 92, 6);  // bytes per triangle
    for (const auto& [form, share] : {std::pair(LightLayer::Form::floats, 0.5), {LightLayer::Form::halves, 0.25}}) {
        LightLayer layer(all, form);
        EXPECT_EQ(layer.size(), 2u * 30 * 20) << "dark triangles are left out";
        EXPECT_LT(static_cast<double>(layer.memory_bytes()), share * winged);
        layer.make_grid();
        RandomStream random(1, Stream::mesh);
        for (int k = 0; k < 500; ++k) {
            const double x = 3 * random.uniform(), y = 2 * random.uniform();
            const double exact = x >= 2 ? 0 : 100 * (2 - x) * std::exp(-y);
            // 0.1% of the largest value: halves have 11 bits, coordinates 16.
            EXPECT_NEAR(layer.at({x, y}), exact, 0.2);
        }
        EXPECT_EQ(layer.at({2.5, 1}), 0);
        EXPECT_EQ(layer.at({-1, 1}), 0);
    }
}

TEST(LightLayer, RoundedBordersLeaveNoDarkPlaces) {
    // A triangle whose long side is not on the 16-bit grid: after rounding, points on it are outside.
    LayerTriangles one;
    one.points = {{0, 0}, {3, 0.1237}, {0.7771, 2}}, one.values = {1, 1, 1};
    one.corners = {{0, 1, 2}}, one.middles = {{1, 1, 1}};
    for (const auto form : {LightLayer::Form::floats, LightLayer::Form::halves}) {
        LightLayer layer(one, form);
        layer.make_grid();
        for (int k = 0; k <= 200; ++k)
            for (std::size_t side = 0; side < 3; ++side) {
                const Vec2 a = one.points[side], b = one.points[(side + 1) % 3];
                EXPECT_NEAR(layer.at(a + (k / 200.0) * (b - a)), 1, 1e-3);
            }
        EXPECT_EQ(layer.at({1.5, 0.05}), 0);  // well outside
    }
}

TEST(LightLayer, ContentsRestoreTheLayerAndInvalidOnesAreReported) {
    const LightLayer layer(grid(5), LightLayer::Form::halves);
    LightLayer again{LightLayer::Contents(layer.contents())};
    EXPECT_FALSE(find_nonsense(layer.contents()));
    again.make_grid();
    EXPECT_NEAR(again.at({0.5, 0.5}), 100 * 1.5 * std::exp(-0.5), 2);  // elements of 0.6 m
    LightLayer::Contents wrong = layer.contents();
    wrong.narrow[0][1] = 60000;
    EXPECT_TRUE(find_nonsense(wrong));
    wrong = layer.contents();
    wrong.half_edges.pop_back();
    EXPECT_TRUE(find_nonsense(wrong));
    wrong = layer.contents();
    wrong.scale = NAN;
    EXPECT_TRUE(find_nonsense(wrong));
}

TEST(LightLayer, AnEmptyMeshIsALayer) {
    LightLayer layer({}, LightLayer::Form::halves);
    layer.make_grid();
    EXPECT_EQ(layer.at({0, 0}), 0);
    EXPECT_EQ(layer.memory_bytes(), 0u);
}

}  // namespace exitance
