#include "exitance/measure/light_maps/unwrap.hpp"

#include <gtest/gtest.h>

#include "exitance/base/parallel.hpp"
#include "exitance/measure/light_maps/face_charts.hpp"
#include "support/built_scene.hpp"
#include "support/motion.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

/// A scene of triangles and quadrangles of points(i, j) on a lattice.
template <class PointAt>
Scene lattice_scene(int columns, int rows, const PointAt& point, const Motion& placement = as_written) {
    SceneDescription d;
    d.file = "test.obj", d.groups = {"all"};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(1)}};
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) d.points.push_back(placement(point(1.0 * i / columns, 1.0 * j / rows)));
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            d.faces.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, 0, 0, 1});
            d.faces.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}, 0, 0, 1});
        }
    CheckedScene checked = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

Scene tube(const Motion& placement = as_written) {
    return lattice_scene(
        24, 3,
        [](double s, double t) {
            return Point{std::cos(2 * pi * s), std::sin(2 * pi * s), 2 * t};
        },
        placement);
}

/// A spiral ramp of three turns: each part is steep by less than 40 degrees, and the turns are above each other.
Scene spiral(const Motion& placement = as_written) {
    return lattice_scene(
        72, 1,
        [](double s, double t) {
            const double angle = 6 * pi * s, r = 1 + 0.5 * t;
            return Point{r * std::cos(angle), -r * std::sin(angle), 3 * s};
        },
        placement);
}

/// Expects coordinates that are fit for light maps.
void expect_fit(const Scene& scene, const Unwrapped& unwrapped, int padding) {
    const UvSet set = uv_set_of(scene, unwrapped);
    const UvLayout layout = lay_out(set);
    EXPECT_EQ(layout.maps, 1u);
    for (const UvObject& object : layout.objects) {
        EXPECT_EQ(object.overlapping, 0u);
        EXPECT_EQ(object.mirrored, 0u);
        EXPECT_EQ(object.outside, 0u);
        EXPECT_EQ(object.collapsed, 0u);
        EXPECT_EQ(object.moved_charts, 0u);
        EXPECT_FALSE(object.overlaps_others);
    }
    // Every face has its area, reduced by the slope of at most 40 degrees.
    EXPECT_GE(unwrapped.smallest_scale, std::cos(40 * pi / 180) - 1e-9);
    double filled = 0;
    std::vector<std::uint8_t> has_place(scene.surfaces().size());
    for (std::size_t t = 0; t < set.triangles.size(); ++t) {
        const UvTriangle& triangle = set.triangles[t];
        has_place[triangle.surface.value] = 1;
        const Vec2 a = layout.places[t][1] - layout.places[t][0], b = layout.places[t][2] - layout.places[t][0];
        const double texels = 0.5 * std::abs(cross(a, b)) * static_cast<double>(unwrapped.size.texels());
        const double area =
            0.5 * norm(cross(triangle.corner[1] - triangle.corner[0], triangle.corner[2] - triangle.corner[0]));
        const double density = texels / area / (unwrapped.density * unwrapped.density);
        EXPECT_LE(density, 1 + 1e-6);
        EXPECT_GE(density, unwrapped.smallest_scale - 1e-6);
        filled += texels / static_cast<double>(unwrapped.size.texels());
    }
    EXPECT_NEAR(filled, unwrapped.filled, 1e-9);
    for (const std::uint8_t has : has_place) EXPECT_TRUE(has);
    // Charts are at least twice the padding apart: their rectangles (`room`) include the padding and do not overlap.
    std::vector<std::uint8_t> taken(unwrapped.size.texels());
    for (const Chart& chart : unwrapped.regions) {
        EXPECT_GE(std::min(chart.x, chart.y), padding);
        EXPECT_LE(chart.x + chart.width + padding, unwrapped.size.width);
        EXPECT_LE(chart.y + chart.height + padding, unwrapped.size.height);
        for (int y = chart.room.y; y < chart.room.y + chart.room.height; ++y)
            for (int x = chart.room.x; x < chart.room.x + chart.room.width; ++x)
                EXPECT_EQ(taken[static_cast<std::size_t>(y * unwrapped.size.width + x)]++, 0);
    }
}

TEST(Unwrap, ATubeHasFewChartsWithoutFaults) {
    for (const Motion& placement : {as_written, turned_and_moved}) {
        const Scene scene = tube(placement);
        for (const int padding : {1, 4}) {
            const Result<Unwrapped> unwrapped = unwrap(scene, {.size = {256, 192}, .padding = padding});
            ASSERT_TRUE(unwrapped) << unwrapped.error().message;
            EXPECT_EQ(unwrapped->size.width, 256);
            EXPECT_EQ(unwrapped->size.height, 192);
            EXPECT_LE(unwrapped->charts, 6u);  // five of 75 degrees each, and a rest
            EXPECT_GT(unwrapped->filled, 0.4);
            expect_fit(scene, *unwrapped, padding);
        }
    }
}

TEST(Unwrap, ChartsThatWouldOverlapThemselvesAreDivided) {
    for (const Motion& placement : {as_written, turned_and_moved}) {
        const Scene scene = spiral(placement);
        const Result<Unwrapped> unwrapped = unwrap(scene, {.size = {256, 256}});
        ASSERT_TRUE(unwrapped);
        EXPECT_GE(unwrapped->charts, 3u);
        EXPECT_LE(unwrapped->charts, 9u);
        expect_fit(scene, *unwrapped, 4);
    }
}

TEST(Unwrap, RoomsWithFurnitureFitAtTheDensityThatIsRequested) {
    const Scene scene = built_scene("complex");
    const Result<Unwrapped> unwrapped = unwrap(scene, {.density = 30});
    ASSERT_TRUE(unwrapped);
    EXPECT_GE(unwrapped->density, 30);
    EXPECT_GT(unwrapped->filled, 0.3);
    expect_fit(scene, *unwrapped, 4);
}

TEST(Unwrap, ScalesAndThreadsChangeNoCharts) {
    const Scene a = tube(), b = tube({2, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {}});
    set_threads(1);
    const Result<Unwrapped> one = unwrap(a, {.size = {128, 128}});
    set_threads(3);
    const Result<Unwrapped> three = unwrap(a, {.size = {128, 128}}), twice = unwrap(b, {.size = {128, 128}});
    set_threads(0);
    ASSERT_TRUE(one && three && twice);
    EXPECT_EQ(one->density, three->density);
    EXPECT_NEAR(one->density, 2 * twice->density, 1e-9 * one->density);
    for (std::size_t r = 0; r < one->regions.size(); ++r) {
        EXPECT_EQ(one->regions[r].x, three->regions[r].x);
        EXPECT_EQ(one->regions[r].origin.x, three->regions[r].origin.x);
        EXPECT_EQ(one->regions[r].y, twice->regions[r].y);
    }
}

TEST(Unwrap, MapsThatAreTooSmallAreErrors) {
    const Result<Unwrapped> small = unwrap(built_scene("complex"), {.size = {8, 8}});
    ASSERT_FALSE(small);
    EXPECT_EQ(small.error().code, ErrorCode::usage);
    const Result<Unwrapped> dense = unwrap(built_scene("complex"), {.density = 1e6});
    ASSERT_FALSE(dense);
    EXPECT_EQ(dense.error().where, "--density");
}

/// Uniform light gives uniform texels, also where a chart has regions with slopes of their own.
TEST(Unwrap, MapsOfUniformLightAreUniform) {
    Solution s;
    s.scene = tube();
    s.indirect = sample_function(s.scene, 1, 20);
    for (auto& value : s.indirect.values) value.fill(3);
    s.interpolant = s.indirect;
    s.direct_in_elements = true;
    const Result<Unwrapped> unwrapped = unwrap(s.scene, {.size = {128, 128}});
    ASSERT_TRUE(unwrapped);
    Progress progress;
    const Result<UvLightMaps> maps = bake_uv_light_maps(RadiosityFunction(s), uv_set_of(s.scene, *unwrapped),
                                                        {.size = unwrapped->size}, progress, StopRequest());
    ASSERT_TRUE(maps);
    EXPECT_EQ(maps->maps[0].shared_texels, 0u);
    EXPECT_EQ(maps->maps[0].close_texels, 0u);
    for (std::size_t i = 0; i < maps->maps[0].light.size.texels(); ++i)
        EXPECT_NEAR(
            maps->maps[0].light.irradiance[i][0],
            maps->maps[0].light.share[i] > 0 ? 3 : 3 * (maps->maps[0].light.source[i] != LightMap::Source::nothing),
            1e-5);
    const LightMaps as_charts = as_region_charts(*unwrapped, *maps);
    EXPECT_EQ(as_charts.charts.size(), s.scene.regions().size());
}

}  // namespace
}  // namespace exitance
