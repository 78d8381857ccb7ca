#include "exitance/measure/light_maps/uv_light_map.hpp"

#include <gtest/gtest.h>

#include <random>

#include "exitance/base/parallel.hpp"
#include "exitance/base/triangulation.hpp"
#include "exitance/measure/light_maps/texel_cover.hpp"
#include "support/built_scene.hpp"
#include "support/motion.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

using Source = LightMap::Source;

/// Rectangles side by side, 1 m apart: `sizes` are those along x and y, metres, before the motion.
Scene rectangles(const std::vector<Vec2>& sizes, const Motion& turned = as_written) {
    SceneDescription d;
    d.file = "test.obj";
    d.materials = {{"grey", Spectrum(0.5), Spectrum()}, {"lamp", Spectrum(0.25), Spectrum(8)}};
    double x = 0;
    for (std::uint32_t i = 0; i < sizes.size(); ++i) {
        const Vec2 s = sizes[i];
        d.points.insert(d.points.end(),
                        {turned({x, 0, 0}), turned({x + s.x, 0, 0}), turned({x + s.x, s.y, 0}), turned({x, s.y, 0})});
        d.groups.push_back("rectangle " + std::to_string(i));
        d.faces.push_back({{4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3}, i == 0 ? 0u : 1u, i, static_cast<int>(i + 1)});
        x += s.x + 1;
    }
    CheckedScene checked = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

/// Texture coordinates of the corners of every face, in the order of its outline.
UvSet uvs_of(const Scene& scene, const std::vector<std::vector<Vec2>>& places) {
    UvSet set;
    set.file = scene.file(), set.name = "vt";
    set.objects.assign(scene.groups().begin(), scene.groups().end());
    for (SurfaceId s : scene.surfaces().ids()) {
        const std::span<const Point> outline = scene.outline(s);
        for (const auto& [i, j, k] : triangulate(outline, scene.surfaces()[s].normal))
            set.triangles.push_back({s,
                                     scene.surfaces()[s].group.value,
                                     {outline[i], outline[j], outline[k]},
                                     {places[s.value][i], places[s.value][j], places[s.value][k]}});
    }
    return set;
}

/// Corners of a rectangle in the map that is not mirrored: its first edge is at the bottom.
std::vector<Vec2> upright_chart(Vec2 lo, Vec2 hi) {
    return {{lo.x, hi.y}, {hi.x, hi.y}, {hi.x, lo.y}, {lo.x, lo.y}};
}

/// A solution whose elements hold `value(region, point)` in all bands, and no direct light.
template <class Value>
Solution light_of(Scene scene, const Value& value) {
    Solution s;
    s.scene = std::move(scene);
    s.indirect = sample_function(s.scene, 1, 0);
    const ElementTree& tree = s.indirect.tree;
    for (ElementId e : tree.leaves())
        for (int k = 0; k < tree.patch(e).corner_count(); ++k)
            s.indirect.values[s.indirect.first_value[e] + static_cast<std::uint32_t>(k)].fill(
                static_cast<float>(value(tree.region(e), tree.patch(e).corner(k))));
    s.interpolant = s.indirect;
    s.direct_in_elements = true;
    return s;
}

UvLightMaps bake(const Solution& s, const UvSet& set, MapSize size, int padding = 4) {
    Progress progress;
    const StopRequest stop;
    const RadiosityFunction light(s);
    Result<UvLightMaps> maps = bake_uv_light_maps(light, set, {.size = size, .padding = padding}, progress, stop);
    EXI_CHECK(static_cast<bool>(maps));
    return std::move(*maps);
}

float value(const UvLightMap& map, int x, int y) {
    return map.light.irradiance[map.light.index(x, y)][0];
}

/// Bilinear lookup at a place of the map, in texels.
double lookup(const UvLightMap& map, Vec2 place) {
    const double x = place.x - 0.5, y = place.y - 0.5;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const auto at = [&](int i, int j) {
        return static_cast<double>(
            value(map, std::clamp(i, 0, map.light.size.width - 1), std::clamp(j, 0, map.light.size.height - 1)));
    };
    const double s = x - x0, t = y - y0;
    return (1 - t) * ((1 - s) * at(x0, y0) + s * at(x0 + 1, y0)) +
           t * ((1 - s) * at(x0, y0 + 1) + s * at(x0 + 1, y0 + 1));
}

TEST(UvLightMap, UniformLightIsUniformInEveryTexelOfAnyChart) {
    for (const Motion& turned : {as_written, turned_and_moved}) {
        const Scene scene = rectangles({{2, 1}, {1, 3}}, turned);
        // The second chart is rotated, sheared and mirrored.
        const UvSet set = uvs_of(
            scene, {upright_chart({0.1, 0.1}, {0.45, 0.4}), {{0.6, 0.2}, {0.9, 0.35}, {0.83, 0.8}, {0.53, 0.65}}});
        const Solution s = light_of(scene, [](RegionId, const Point&) { return 2.0; });
        const UvLightMaps maps = bake(s, set, {61, 47});
        ASSERT_EQ(maps.maps.size(), 1u);
        const UvLightMap& map = maps.maps[0];
        std::size_t covered = 0;
        for (std::size_t i = 0; i < map.light.size.texels(); ++i) {
            EXPECT_EQ(map.light.irradiance[i][0], map.light.source[i] == Source::nothing ? 0.f : 2.f);
            covered += map.light.share[i] > 0;
            if (map.light.source[i] == Source::nothing) continue;
            // B = M + rho E: the first rectangle reflects half, the second is a lamp.
            EXPECT_FLOAT_EQ(map.radiosity[i][0], maps.layout.chart[0] == map.chart[i] ? 1.f : 8.5f);
        }
        EXPECT_EQ(maps.texels, covered);
        double share = 0;
        for (const float texel : map.light.share) share += static_cast<double>(texel);
        // Areas of both charts in the map: shares are exact up to single precision.
        EXPECT_NEAR(share, 61 * 47 * (0.35 * 0.3 + std::abs(0.3 * 0.45 - 0.15 * -0.07)), 1e-3);
    }
}

TEST(UvLightMap, LinearLightIsIntegratedExactly) {
    for (const Motion& turned : {as_written, turned_and_moved}) {
        const Scene scene = rectangles({{2, 1}}, turned);
        const UvSet set = uvs_of(scene, {{{0.2, 0.3}, {0.8, 0.5}, {0.7, 0.9}, {0.1, 0.7}}});
        const auto linear = [&](const Point& p) {
            const Vec3 d = (p - Point(turned.by)) / turned.scale;
            return 10 + 2 * dot(d, turned.u) + 3 * dot(d, turned.v);
        };
        const Solution s = light_of(scene, [&](RegionId, const Point& p) { return linear(p); });
        const UvLightMap map = std::move(bake(s, set, {40, 40}).maps[0]);
        // The affine map from places to metres: its corners are those of the face.
        const Vec2 a = Vec2{24, 8}, b = Vec2{-4, 16}, from{8, 12};
        std::size_t whole = 0, parts = 0;
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x) {
                const std::size_t i = map.light.index(x, y);
                if (map.light.source[i] != Source::computed) continue;
                std::vector<Vec2> polygon{from, from + a, from + a + b, from + b}, rest;
                clip_to_texel(polygon, x, y, rest);
                double area = 0, sum = 0;
                for (std::size_t k = 2; k < polygon.size(); ++k) {
                    const double part = 0.5 * cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
                    const Vec2 middle = 1.0 / 3 * (polygon[0] + polygon[k - 1] + polygon[k]);
                    const double u = cross(middle - from, b) / cross(a, b), v = cross(a, middle - from) / cross(a, b);
                    area += part, sum += part * (10 + 2 * 2 * u + 3 * v);
                }
                EXPECT_NEAR(static_cast<double>(map.light.share[i]), area, 1e-4);
                if (area < 1e-3) continue;
                const bool is_whole = map.light.share[i] == 1;
                (is_whole ? whole : parts)++;
                // Light varies by up to 0.4 over a texel. The mean of the 16 points of a whole texel is its centre; in
                // a part of a texel it is off the centroid by less than a tenth of the texel.
                EXPECT_NEAR(static_cast<double>(map.light.irradiance[i][0]), sum / area, is_whole ? 1e-5 : 0.04);
            }
        EXPECT_GT(whole, 300u);
        EXPECT_GT(parts, 50u);
    }
}

TEST(UvLightMap, ATexelWithPartsOfTwoChartsIsWeightedByArea) {
    const Scene scene = rectangles({{1, 1}, {1, 1}});
    // In a map 10 texels wide, texel 5 contains 0.2 of the first chart and 0.5 of the second.
    const UvSet set = uvs_of(scene, {upright_chart({0.2, 0.2}, {0.52, 0.8}), upright_chart({0.55, 0.2}, {0.9, 0.8})});
    const Solution s = light_of(scene, [](RegionId r, const Point&) { return r.value == 0 ? 1.0 : 4.0; });
    const UvLightMaps maps = bake(s, set, {10, 10});
    const UvLightMap& map = maps.maps[0];
    for (int y = 2; y < 8; ++y) {
        EXPECT_NEAR(static_cast<double>(value(map, 5, y)), (0.2 * 1 + 0.5 * 4) / 0.7, 1e-4);
        EXPECT_NEAR(map.light.share[map.light.index(5, y)], 0.7, 1e-5);
        // B is 0.5 E of the first, 8 + 0.25 E of the second.
        EXPECT_NEAR(map.radiosity[map.light.index(5, y)][0], (0.2 * 0.5 + 0.5 * 9) / 0.7, 1e-4);
        EXPECT_EQ(value(map, 4, y), 1);
        EXPECT_EQ(value(map, 6, y), 4);
    }
    EXPECT_EQ(map.shared_texels, 6u);
    EXPECT_EQ(maps.layout.maps, 1u);
}

TEST(UvLightMap, ABilinearLookupOnAChartReadsNoOtherChart) {
    const Scene scene = rectangles({{1, 1}, {1, 1}});
    const int size = 100;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number;
    for (int turn = 0; turn < 8; ++turn) {
        // Two parallelograms, two texels apart along their whole length.
        const double angle = 0.4 * turn;
        const Vec2 right{std::cos(angle), std::sin(angle)}, down{-right.y, right.x}, middle{0.5, 0.5};
        const auto chart = [&](double lo, double hi) -> std::vector<Vec2> {
            return {middle + lo * right + 0.2 * down, middle + hi * right + 0.2 * down,
                    middle + hi * right + -0.2 * down, middle + lo * right + -0.2 * down};
        };
        constexpr double apart = 0.0145;  // half of two texels' diagonals: no texel is next to both
        const std::vector<std::vector<Vec2>> places{chart(-0.3, -apart), chart(apart, 0.3)};
        const Solution s = light_of(scene, [](RegionId r, const Point&) { return r.value == 0 ? 1.0 : 4.0; });
        const UvLightMaps maps = bake(s, uvs_of(scene, places), {size, size}, 2);
        EXPECT_EQ(maps.maps[0].shared_texels, 0u);
        EXPECT_EQ(maps.maps[0].close_texels, 0u) << turn;
        for (std::size_t c = 0; c < 2; ++c)
            for (int k = 0; k < 2000; ++k) {
                double u = number(random), v = number(random);
                if (k % 3 == 0) u = k % 2;
                if (k % 5 == 0) v = k % 2;
                const Vec2 place = places[c][0] + u * (places[c][1] - places[c][0]) + v * (places[c][3] - places[c][0]);
                EXPECT_NEAR(lookup(maps.maps[0], size * place), c == 0 ? 1 : 4, 1e-6);
            }
    }
}

TEST(UvLightMap, ChartsThatAreTooCloseAreReported) {
    const Scene scene = rectangles({{1, 1}, {1, 1}});
    const UvSet set = uvs_of(scene, {upright_chart({0.2, 0.2}, {0.5, 0.8}), upright_chart({0.6, 0.2}, {0.9, 0.8})});
    const Solution s = light_of(scene, [](RegionId r, const Point&) { return r.value == 0 ? 1.0 : 4.0; });
    // One column of ten texels is between the charts: six texels of it, and one at each end.
    EXPECT_EQ(bake(s, set, {10, 10}).maps[0].close_texels, 8u);
    EXPECT_EQ(bake(s, set, {30, 30}).maps[0].close_texels, 0u);
}

TEST(UvLayout, ReportsFaultsByObject) {
    const Scene scene = rectangles({{1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}});
    UvSet set = uvs_of(scene, {upright_chart({0.0, 0.0}, {0.2, 0.2}),         // correct, at the border of the map
                               {{0.3, 0}, {0.5, 0}, {0.5, 0.2}, {0.3, 0.2}},  // mirrored
                               upright_chart({2.6, -0.9}, {2.8, -0.7}),       // chart in another unit square
                               upright_chart({0.9, 0.5}, {1.1, 0.7}),  // chart that crosses the border of the map
                               {{0.7, 0.9}, {0.8, 0.9}, {0.9, 0.9}, {0.75, 0.9}}});  // without area
    const UvLayout layout = lay_out(set);
    ASSERT_EQ(layout.objects.size(), 5u);
    EXPECT_EQ(layout.maps, 1u);
    const auto& o = layout.objects;
    EXPECT_EQ(o[0].mirrored + o[0].outside + o[0].moved_charts + o[0].collapsed + o[0].overlapping, 0u);
    EXPECT_EQ(o[0].charts, 1u);
    EXPECT_NEAR(o[0].map_area, 0.04, 1e-12);
    EXPECT_EQ(o[1].mirrored, 2u);
    EXPECT_EQ(o[2].moved_charts, 1u);
    EXPECT_EQ(o[2].outside, 0u);
    EXPECT_NEAR(layout.places[4][0].x - std::floor(layout.places[4][0].x), layout.places[4][0].x, 1e-12);
    EXPECT_EQ(o[3].outside, 2u);
    EXPECT_EQ(o[3].moved_charts, 0u);
    EXPECT_EQ(o[4].collapsed, 2u);
    EXPECT_EQ(o[4].charts, 0u);
    for (const UvObject& object : o) EXPECT_EQ(object.overlapping, 0u);
}

TEST(UvLayout, ObjectsShareAMapUnlessTheirChartsOverlap) {
    const Scene scene = rectangles({{1, 1}, {1, 1}, {1, 1}});
    const auto layout = [&](Vec2 lo, Vec2 hi) {
        return lay_out(uvs_of(
            scene, {upright_chart({0, 0}, {0.3, 0.3}), upright_chart(lo, hi), upright_chart({0.7, 0.7}, {0.9, 0.9})}));
    };
    // Touching charts do not overlap, nor do coordinates that were rounded to single precision.
    EXPECT_EQ(layout({0.3, 0}, {0.6, 0.3}).maps, 1u);
    EXPECT_EQ(layout({0.3 - 3e-8, 0}, {0.6, 0.3}).maps, 1u);
    const UvLayout apart = layout({0.29, 0.1}, {0.6, 0.3});
    EXPECT_EQ(apart.maps, 3u);
    EXPECT_TRUE(apart.objects[0].overlaps_others && apart.objects[1].overlaps_others);
    EXPECT_FALSE(apart.objects[2].overlaps_others);
    EXPECT_EQ(apart.objects[0].overlapping, 0u);  // the overlap is between objects, not within one
    const Solution s = light_of(scene, [](RegionId r, const Point&) { return 1.0 + r.value; });
    const UvSet set = uvs_of(scene, std::vector(3, upright_chart({0, 0}, {1, 1})));
    const UvLightMaps maps = bake(s, set, {8, 8});
    ASSERT_EQ(maps.maps.size(), 3u);
    for (std::size_t m = 0; m < 3; ++m)
        for (const auto& texel : maps.maps[m].light.irradiance) EXPECT_EQ(texel[0], 1.f + static_cast<float>(m));
}

TEST(UvLayout, OverlapsWithinAnObjectAreCounted) {
    Scene scene = rectangles({{1, 1}, {1, 1}, {1, 1}});
    UvSet set = uvs_of(scene, {upright_chart({0, 0}, {0.3, 0.3}), upright_chart({0, 0}, {0.3, 0.3}),
                               upright_chart({0.5, 0.5}, {0.9, 0.9})});
    for (UvTriangle& triangle : set.triangles) triangle.object = 0;
    const UvLayout layout = lay_out(set);
    EXPECT_EQ(layout.maps, 1u);
    EXPECT_EQ(layout.objects[0].overlapping, 4u);
    EXPECT_EQ(layout.charts, 3u);
    // A texel that both cover has the mean of their light.
    const Solution s = light_of(scene, [](RegionId r, const Point&) { return r.value == 0 ? 1.0 : 4.0; });
    EXPECT_EQ(value(bake(s, set, {10, 10}).maps[0], 1, 1), 2.5f);
}

TEST(UvLayout, AreasOfCommonPartsAreExact) {
    const std::array<Vec2, 3> a{{{0, 0}, {2, 0}, {0, 2}}}, mirrored{{{0, 0}, {0, 2}, {2, 0}}};
    const std::array<Vec2, 3> b{{{1, 0}, {1, 2}, {-1, 0}}};
    EXPECT_NEAR(common_area(a, a), 2, 1e-12);
    EXPECT_NEAR(common_area(a, mirrored), 2, 1e-12);
    // b is the part below y = x + 1 and left of x = 1: within a, the square [0, 1]^2 and a triangle of 1/4 above it.
    EXPECT_NEAR(common_area(a, b), 1.25, 1e-12);
    EXPECT_NEAR(common_area(b, a), 1.25, 1e-12);
    EXPECT_EQ(common_area(a, {{{2, 2}, {3, 2}, {2, 3}}}), 0);
}

TEST(UvLightMap, HasTheSameBitsOnAnyNumberOfThreads) {
    const Solution s = sample_solution();
    std::vector<std::vector<Vec2>> places;
    for (SurfaceId f : s.scene.surfaces().ids()) {
        const double x = 0.25 * (f.value % 4), y = 0.25 * (f.value / 4);
        places.push_back(upright_chart({x + 0.01, y + 0.01}, {x + 0.23, y + 0.21}));
    }
    const UvSet set = uvs_of(s.scene, places);
    set_threads(1);
    const UvLightMaps one = bake(s, set, {64, 64});
    set_threads(0);
    const UvLightMaps all = bake(s, set, {64, 64});
    EXPECT_EQ(one.maps[0].light.irradiance, all.maps[0].light.irradiance);
    EXPECT_EQ(one.maps[0].radiosity, all.maps[0].radiosity);
    EXPECT_EQ(one.maps[0].chart, all.maps[0].chart);
}

TEST(UvLightMap, SizesFollowTheDensity) {
    const Scene scene = rectangles({{2, 2}});
    const UvSet set = uvs_of(scene, {upright_chart({0, 0}, {0.5, 0.5})});
    const Solution s = light_of(scene, [](RegionId, const Point&) { return 1.0; });
    Progress progress;
    const StopRequest stop;
    const RadiosityFunction light(s);
    const auto side = [&](double density) -> int {
        const Result<UvLightMaps> maps = bake_uv_light_maps(light, set, {.density = density}, progress, stop);
        return maps ? maps->maps[0].light.size.width : 0;
    };
    EXPECT_EQ(side(16), 64);  // the chart's 2 m are half of the map's side
    EXPECT_EQ(side(17), 128);
    EXPECT_EQ(side(1e5), 0);
    UvSet stacked = set;
    for (int k = 0; k < 600; ++k)
        stacked.triangles.insert(stacked.triangles.end(), set.triangles.begin(), set.triangles.end());
    const Result<UvLightMaps> often = bake_uv_light_maps(light, stacked, {.size = {1024, 1024}}, progress, stop);
    ASSERT_FALSE(often);
    EXPECT_NE(often.error().message.find("158 million"), std::string::npos) << often.error().message;
}

}  // namespace
}  // namespace exitance
