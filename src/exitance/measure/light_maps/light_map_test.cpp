#include "exitance/measure/light_maps/light_map.hpp"

#include <gtest/gtest.h>

#include <random>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/measure/light_maps/texel_cover.hpp"
#include "exitance/methods/light/mesh_of_layers.hpp"
#include "exitance/transport/open_points.hpp"
#include "exitance/transport/stage.hpp"
#include "support/built_scene.hpp"
#include "support/checked_scene.hpp"
#include "support/sample_solution.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

using Source = LightMap::Source;

Scene made(SceneDescription d) {
    d.file = "test.obj";
    if (d.groups.empty()) d.groups = {"all"};
    return checked_scene(std::move(d));
}

/// A solution with uniform irradiance, all of it in the elements.
Solution even_light(Scene scene, double irradiance) {
    Solution s = even_solution(std::move(scene), irradiance, 20);
    s.direct_in_elements = true;
    return s;
}

LightMaps bake(const Solution& s, double density, int padding = 4, int most = 8192) {
    Progress progress;
    const StopRequest stop;
    const RadiosityFunction light(s);
    Result<LightMaps> maps = bake_light_maps(light, {density, padding, most}, progress, stop);
    EXI_CHECK(static_cast<bool>(maps));
    return std::move(*maps);
}

/// A wall of 3 x 2 m with a window, both in the plane y = 0, and a triangle next to them.
Scene wall_with_window() {
    SceneDescription d;
    d.points = {{0, 0, 0},       {3, 0, 0},      {3, 0, 2},      {0, 0, 2}, {1.03, 0, 0.71},
                {2.11, 0, 0.71}, {2.11, 0, 1.6}, {1.03, 0, 1.6}, {4, 0, 0}, {4, 0, 1.3}};
    d.materials = {{"wall", Spectrum(0.5), Spectrum()}, {"glass", Spectrum(0.1), Spectrum()}};
    d.faces = {{{0, 4, 7, 3}, 0, 0, 1}, {{4, 0, 1, 5}, 0, 0, 2}, {{1, 2, 6, 5}, 0, 0, 3},
               {{2, 3, 7, 6}, 0, 0, 4}, {{4, 5, 6, 7}, 1, 0, 5}, {{1, 8, 9}, 1, 0, 6}};
    return made(std::move(d));
}

TEST(LightMap, IsUniformInEveryTexelForUniformLight) {
    const Solution s = even_light(box_scene(1, 2, 1.1, 0.5, 1, 1), 2);
    for (const LightMap& map : bake(s, 13).maps)
        for (std::size_t i = 0; i < map.size.texels(); ++i)
            EXPECT_EQ(map.irradiance[i][0], map.source[i] == Source::nothing ? 0.f : 2.f);
}

TEST(LightMap, ATexelIsTheMeanOfTheFunction) {
    const Solution s = sample_solution();
    const LightMaps maps = bake(s, 16);
    const RadiosityFunction light(s);
    constexpr int side = 6;
    double difference = 0, level = 0;
    int count = 0;
    for (const Chart& chart : maps.charts)
        for (int y = 1; y < chart.height; y += 3)
            for (int x = 1; x < chart.width; x += 3) {
                const std::size_t i = maps.maps[chart.map].index(chart.x + x, chart.y + y);
                if (maps.maps[chart.map].share[i] < 1) continue;
                std::vector<ProbePoint> points;
                for (int k = 0; k < side * side; ++k)
                    points.push_back({chart.at({x + (k % side + 0.5) / side, y + (k / side + 0.5) / side}),
                                      s.scene.regions()[chart.region].plane.n});
                double sum = 0;
                for (const Light& there : light.at(points)) sum += mean(there.irradiance) / (side * side);
                difference += std::pow(mean(maps.maps[chart.map].at(i)) - sum, 2), level += sum * sum, ++count;
            }
    EXPECT_GT(count, 50);
    // Neighbours may differ by 1%, plus jumps at the borders of elements.
    EXPECT_LT(std::sqrt(difference / level), 0.02);
}

/// Bakes one component.
LightMaps bake_component(const Solution& s, Component component) {
    Progress progress;
    const StopRequest stop;
    BakeOptions options;
    options.density = 16, options.component = component;
    Result<LightMaps> maps = bake_light_maps(RadiosityFunction(s), options, progress, stop);
    EXI_CHECK(static_cast<bool>(maps));
    return std::move(*maps);
}

TEST(LightMap, DirectAndIndirectLightAddUpToAllLight) {
    SolveOptions solve;
    solve.error = 0.1;
    const Solution s = solved(built_scene("cornell"), solve);
    const LightMaps all = bake_component(s, Component::total), direct = bake_component(s, Component::direct),
                    indirect = bake_component(s, Component::indirect);
    const RadiosityFunction light(s);
    double largest_direct = 0, largest_indirect = 0;
    for (const Chart& chart : all.charts)
        for (int y = 0; y < chart.height; ++y)
            for (int x = 0; x < chart.width; ++x) {
                const LightMap& map = all.maps[chart.map];
                const std::size_t i = map.index(chart.x + x, chart.y + y);
                if (map.source[i] != Source::computed) continue;
                const double D = mean(direct.maps[chart.map].at(i)), I = mean(indirect.maps[chart.map].at(i));
                EXPECT_NEAR(D + I, mean(map.at(i)), 1e-5 * (D + I));
                largest_direct = std::max(largest_direct, D), largest_indirect = std::max(largest_indirect, I);
            }
    EXPECT_GT(largest_direct, 0);
    EXPECT_GT(largest_indirect, 0);
    // In the middle of the floor's chart, each is the component that `probe` evaluates.
    for (const auto& [component, maps] :
         {std::pair(Component::direct, &direct), std::pair(Component::indirect, &indirect)}) {
        const Chart& chart = maps->charts[0];
        const std::size_t i = maps->maps[chart.map].index(chart.x + chart.width / 2, chart.y + chart.height / 2);
        const ProbePoint middle{chart.at({chart.width / 2 + 0.5, chart.height / 2 + 0.5}),
                                s.scene.regions()[chart.region].plane.n};
        const double expected = mean(light.at(std::span(&middle, 1), component)[0].irradiance);
        EXPECT_NEAR(mean(maps->maps[chart.map].at(i)), expected,
                    0.05 * expected + 1e-3 * (largest_direct + largest_indirect));
    }
}

TEST(LightMap, ASolutionThatHoldsAllLightAsOneHasNoComponents) {
    const Solution s = even_light(wall_with_window(), 2);
    Progress progress;
    const StopRequest stop;
    BakeOptions options;
    options.component = Component::direct;
    const Result<LightMaps> maps = bake_light_maps(RadiosityFunction(s), options, progress, stop);
    ASSERT_FALSE(maps);
    EXPECT_EQ(maps.error().where, "--component");
}

TEST(LightMap, ChartsOfOnePlaneShareTheirLattice) {
    const Scene scene = wall_with_window();
    const Result<std::vector<Chart>> charts = make_charts(scene, 10, 1000);
    ASSERT_TRUE(charts);
    ASSERT_EQ(charts->size(), 3u);
    for (const Chart& chart : *charts) {
        const Vec2 place = charts->front().place(chart.origin);
        EXPECT_NEAR(place.x - 0.5, std::round(place.x - 0.5), 1e-9);
        EXPECT_NEAR(place.y - 0.5, std::round(place.y - 0.5), 1e-9);
        EXPECT_NEAR(norm(chart.du), 0.1, 1e-12);
        EXPECT_NEAR(dot(cross(chart.dv, chart.du), scene.regions()[chart.region].plane.n), 0.01, 1e-12);
    }
    EXPECT_FALSE(make_charts(scene, 10, 29));  // 3 m at 10 texels per metre
}

TEST(LightMap, RoomsAreDisjointAndAlignedToMipTexels) {
    std::mt19937 random(7);
    std::vector<Chart> charts(300);
    for (Chart& chart : charts)
        chart.width = 1 + static_cast<int>(random() % 50), chart.height = 1 + static_cast<int>(random() % 90);
    const std::vector<MapSize> sizes = pack_charts(charts, 5, 256);
    EXPECT_GT(sizes.size(), 1u);
    std::vector<std::vector<int>> taken;
    for (const MapSize& size : sizes) {
        EXPECT_LE(std::max(size.width, size.height), 256);
        taken.emplace_back(size.texels());
    }
    for (const Chart& chart : charts) {
        EXPECT_EQ((chart.room.x | chart.room.y | chart.room.width | chart.room.height) % 4, 0);
        EXPECT_GE(chart.x, chart.room.x + 5);
        EXPECT_GE(chart.room.x + chart.room.width, chart.x + chart.width + 5);
        EXPECT_GE(chart.room.y + chart.room.height, chart.y + chart.height + 5);
        for (int y = chart.room.y; y < chart.room.y + chart.room.height; ++y)
            for (int x = chart.room.x; x < chart.room.x + chart.room.width; ++x)
                EXPECT_EQ(taken[chart.map].at(static_cast<std::size_t>(y * sizes[chart.map].width + x))++, 0);
    }
}

TEST(LightMap, BilinearLookupOnAPolygonReadsNoTexelWithoutLight) {
    const Solution s = even_light(wall_with_window(), 3);
    const LightMaps maps = bake(s, 7.3, 1);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number;
    const Stage stage(s.scene);
    for (const Piece& piece : stage.pieces) {
        const Chart& chart = maps.charts[piece.region.value];
        for (int k = 0; k < 500; ++k) {
            // A third of the points are on the border.
            Vec2 uv = uniform_in_shape(piece.patch.shape, number(random), number(random));
            if (k % 3 == 0) uv.x = 0;
            const Vec2 place = chart.place(piece.patch.at(uv));
            for (const double dx : {-0.5, 0.5})
                for (const double dy : {-0.5, 0.5}) {
                    const int x = chart.x + static_cast<int>(std::floor(place.x + dx));
                    const int y = chart.y + static_cast<int>(std::floor(place.y + dy));
                    const LightMap& map = maps.maps[chart.map];
                    EXPECT_EQ(map.irradiance[map.index(x, y)][0], 3.f);
                }
        }
    }
}

TEST(LightMap, LinearLightIsContinuedBeyondTheBorder) {
    Chart chart;
    chart.x = chart.y = 2, chart.width = chart.height = 3, chart.room = {0, 0, 7, 7};
    LightMap map;
    map.size = {7, 7};
    map.irradiance.resize(49), map.source.resize(49), map.share.resize(49);
    for (int y = 2; y < 5; ++y)
        for (int x = 2; x < 5; ++x) {
            map.irradiance[map.index(x, y)].fill(static_cast<float>(10 + x + 2 * y));
            map.source[map.index(x, y)] = Source::computed;
        }
    extrapolate_texels(chart, 1, map);
    EXPECT_FLOAT_EQ(map.irradiance[map.index(5, 3)][0], 21);
    EXPECT_FLOAT_EQ(map.irradiance[map.index(3, 1)][0], 15);
    EXPECT_FLOAT_EQ(map.irradiance[map.index(1, 1)][0], 13);
    for (const Source source : map.source) EXPECT_NE(source, Source::nothing);
}

/// A floor with a body of five faces, open at the bottom, and a lamp above.
Scene floor_with_body() {
    SceneDescription d;
    d.materials = {{"grey", Spectrum(0.5), Spectrum()}, {"lamp", Spectrum(), Spectrum(10)}};
    d.points = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 4}, {2, 0, 4}, {2, 2, 4}, {0, 2, 4}};
    for (const double z : {0.0, 0.1})
        d.points.insert(d.points.end(), {{0.53, 0.53, z}, {1.53, 0.53, z}, {1.53, 1.53, z}, {0.53, 1.53, z}});
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}, {{7, 6, 5, 4}, 1, 0, 2}, {{12, 13, 14, 15}, 0, 0, 3}};
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t j = (i + 1) % 4;
        d.faces.push_back({{8 + i, 8 + j, 12 + j, 12 + i}, 0, 0, 4});
    }
    return made(std::move(d));
}

TEST(LightMap, NoDarknessLeaksFromBelowABody) {
    Solution s = even_light(floor_with_body(), 0);
    s.direct_in_elements = false, s.bounces = 0;
    const LightMaps maps = bake(s, 10);
    const Chart& floor = maps.charts[0];
    const LightMap& map = maps.maps[floor.map];
    // Texel 5 is from 0.5 to 0.6 m; the body starts within it.
    const auto at = [&](int x) { return static_cast<double>(map.irradiance[map.index(floor.x + x, floor.y + 10)][0]); };
    EXPECT_GT(at(5), 0.5 * at(3));  // more than half of the lamp is visible
    EXPECT_GT(at(6), 0.5 * at(3));  // extrapolated; read by lookups in texel 5
    EXPECT_EQ(at(8), 0);
    EXPECT_EQ(map.source[map.index(floor.x + 8, floor.y + 10)], Source::buried);
}

/// A floor of 2 x 2 m with a rotated body on it, a board above, and a small lamp: penumbrae are narrower than texels of
/// an eighth of a metre.
Scene sharp_shadows() {
    SceneDescription d;
    d.materials = {{"grey", Spectrum(0.5), Spectrum()}, {"lamp", Spectrum(), Spectrum(1000)}};
    d.points = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    for (const double z : {0.0, 0.1})
        d.points.insert(d.points.end(), {{0.31, 0.53, z}, {1.01, 0.36, z}, {1.17, 0.84, z}, {0.47, 1.01, z}});
    d.points.insert(d.points.end(), {{1.2, 1.1, 0.2}, {1.9, 1.3, 0.2}, {1.5, 1.8, 0.2}});
    d.points.insert(d.points.end(), {{0.95, 0.95, 2}, {0.95, 1.05, 2}, {1.05, 1.05, 2}, {1.05, 0.95, 2}});
    d.points.insert(d.points.end(), {{0.05, 1.8, 2}, {0.05, 1.9, 2}, {0.15, 1.9, 2}, {0.15, 1.8, 2}});
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1},
               {{8, 9, 10, 11}, 0, 0, 2},
               {{12, 13, 14}, 0, 0, 3},
               {{15, 16, 17, 18}, 1, 0, 4},
               {{19, 20, 21, 22}, 1, 0, 5}};
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t j = (i + 1) % 4;
        d.faces.push_back({{4 + i, 4 + j, 8 + j, 8 + i}, 0, 0, 6});
    }
    return made(std::move(d));
}

/// For the first chart's texels, the mean light at many uncovered points; -1 if less than half of the points are
/// uncovered.
std::vector<double> means_of_many(const Solution& s, const Chart& chart) {
    constexpr int side = 32;
    const RadiosityFunction light(s);
    RandomStream random(3, Stream::mesh);
    std::vector<double> out;
    for (int y = 0; y < chart.height; ++y)
        for (int x = 0; x < chart.width; ++x) {
            std::vector<ProbePoint> points;
            for (int k = 0; k < side * side; ++k) {
                const Point p =
                    chart.at({x + (k % side + random.uniform()) / side, y + (k / side + random.uniform()) / side});
                if (is_in_open(light.stage(), p, {0, 0, 1}, chart.region)) points.push_back({p, {0, 0, 1}});
            }
            double sum = 0;
            for (const Light& there : light.at(points)) sum += mean(there.irradiance);
            out.push_back(2 * points.size() < side * side ? -1 : sum / static_cast<double>(points.size()));
        }
    return out;
}

/// RMS error of the first chart's texels relative to their mean light.
double error_of(const LightMaps& maps, const std::vector<double>& expected) {
    const Chart& chart = maps.charts[0];
    const LightMap& map = maps.maps[chart.map];
    double square = 0, level = 0, count = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (expected[i] < 0) continue;
        const int x = static_cast<int>(i) % chart.width, y = static_cast<int>(i) / chart.width;
        const double there = mean(map.at(map.index(chart.x + x, chart.y + y)));
        square += std::pow(there - expected[i], 2), level += expected[i], ++count;
    }
    return std::sqrt(square / count) / (level / count);
}

TEST(LightMap, ShadowEdgesAreIntegratedWithADiscontinuityMesh) {
    SolveOptions options{.method = Method::discontinuity, .bounces = 0, .error_interpolant = 0.01};
    std::vector<double> expected;
    for (int kind = 0; kind < 3; ++kind) {
        if (kind == 1) options.discontinuity.element = MeshElement::clough_tocher;
        if (kind == 2) options.discontinuity.element = {}, options.discontinuity.layers = true;
        Solution s = solved(sharp_shadows(), options);
        ASSERT_TRUE(make_requested_mesh(s));
        const LightMaps integrated = bake(s, 8);
        if (kind == 0) expected = means_of_many(s, integrated.charts[0]);
        s.discontinuity = {}, s.layers = {};
        const double of_points = error_of(bake(s, 8), expected);
        EXPECT_LT(error_of(integrated, expected), 0.004) << kind;  // 1024 points have this error at a shadow edge
        // 16 points have an error of up to a sixteenth.
        EXPECT_LT(error_of(integrated, expected), 0.3 * of_points) << kind;
    }
}

TEST(LightMap, HasTheSameBitsOnAnyNumberOfThreads) {
    const Solution s = sample_solution();
    set_threads(1);
    const LightMaps one = bake(s, 20);
    set_threads(0);
    const LightMaps all = bake(s, 20);
    ASSERT_EQ(one.maps.size(), all.maps.size());
    for (std::size_t m = 0; m < one.maps.size(); ++m) EXPECT_EQ(one.maps[m].irradiance, all.maps[m].irradiance);
}

TEST(LightMap, IsRefusedIfTooLarge) {
    const Solution s = even_light(box_scene(30, 30, 30, 0.5, 1), 1);
    const RadiosityFunction light(s);
    Progress progress;
    const StopRequest stop;
    const Result<LightMaps> many = bake_light_maps(light, {270, 4, 8192}, progress, stop);
    ASSERT_FALSE(many);
    EXPECT_EQ(many.error().code, ErrorCode::usage);
    const Result<LightMaps> wide = bake_light_maps(light, {1e9, 4, 8192}, progress, stop);
    ASSERT_FALSE(wide);
    EXPECT_EQ(wide.error().where, "--density");
    EXPECT_EQ(automatic_density(s.scene), 8);  // the scene has 5400 m^2
    EXPECT_EQ(automatic_density(box_scene(0.1, 0.1, 0.1, 0.5, 1)), 2048);
}

TEST(TexelCutter, SharesSumToTheAreaAndPointsAreInside) {
    Chart chart;
    chart.du = {1, 0, 0}, chart.dv = {0, 1, 0}, chart.origin = {0.5, 0.5, 0};
    const Patch triangle{{0.3, 0.2, 0}, {6.1, 1.7, 0}, {1.2, 5.3, 0}, Patch::Shape::triangle};
    const TexelOutline outline(chart, triangle);
    TexelCutter cutter;
    std::vector<TexelCover> covers;
    std::vector<Vec2> places;
    cutter.cut(std::span(&outline, 1), {0, 0, 8, 8}, covers, places);
    double area = 0;
    for (const TexelCover& cover : covers) {
        area += cover.share;
        for (std::size_t k = 0; k < texel_points; ++k) {
            const Vec2 p = places[cover.first + k];
            const Vec2 uv = triangle.coordinates({p.x, p.y, 0});
            EXPECT_TRUE(uv.x >= -1e-5 && uv.y >= -1e-5 && uv.x + uv.y <= 1 + 1e-5);
            EXPECT_TRUE(p.x >= cover.x - 1e-9 && p.y >= cover.y - 1e-9 && p.x <= cover.x + 1 && p.y <= cover.y + 1);
        }
    }
    EXPECT_NEAR(area, triangle.area(), 1e-4);
}

}  // namespace
}  // namespace exitance
