#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/measure/light_maps/directed_irradiance.hpp"
#include "exitance/measure/light_maps/unwrap.hpp"
#include "exitance/transport/stage.hpp"
#include "support/built_scene.hpp"
#include "support/sample_solution.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

LightMaps bake_directed(const Solution& s, double density, Directions directions,
                        Component component = Component::total) {
    Progress progress;
    const StopRequest stop;
    BakeOptions options;
    options.density = density, options.directions = directions, options.component = component;
    Result<LightMaps> maps = bake_light_maps(RadiosityFunction(s), options, progress, stop);
    EXI_CHECK(static_cast<bool>(maps));
    return std::move(*maps);
}

/// Calls visit(chart, map, texel, place) for all computed texels that are wholly on their region.
template <class Visit>
void visit_whole_texels(const LightMaps& maps, const Visit& visit) {
    for (const Chart& chart : maps.charts) {
        const LightMap& map = maps.maps[chart.map];
        for (int y = 0; y < chart.height; ++y)
            for (int x = 0; x < chart.width; ++x) {
                const std::size_t i = map.index(chart.x + x, chart.y + y);
                if (map.share[i] == 1 && map.source[i] == LightMap::Source::computed)
                    visit(chart, map, i, chart.at({x + 0.5, y + 0.5}));
            }
    }
}

/// A black floor of 4 x 4 m below a lamp without extent at 2 m above its middle.
Solution lamp_above_floor() {
    SceneDescription d;
    d.file = "floor.obj", d.groups = {"floor"};
    d.materials = {{"black", Spectrum(), Spectrum()}};
    d.points = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}};
    PunctualLight lamp;
    lamp.position = {0, 0, 2}, lamp.intensity = Spectrum(5);
    d.lights = {lamp};
    CheckedScene checked = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return solved(std::move(*checked.scene), {});
}

Solution cornell() {
    SolveOptions options;
    options.error = 0.05;
    return solved(built_scene("cornell"), options);
}

}  // namespace

TEST(DirectedIrradiance, IsThatOfItsRadiance) {
    DirectedIrradiance light;
    light.constant = Spectrum(3), light.slope = {Spectrum(1), Spectrum(-0.5), Spectrum(2)};
    const std::array<Spectrum, 4> L = radiance_of(light);
    Harmonics<Spectrum> all{};
    std::copy(L.begin(), L.end(), all.begin());
    for (const Normal& n : {Normal{1, 0, 0}, Normal{0, -1, 0}, normalized(Vec3{1, 2, -3})}) {
        EXPECT_NEAR(irradiance_of(all, n)[0], 3 + n.x - 0.5 * n.y + 2 * n.z, 1e-12);
        EXPECT_NEAR(light.at(n)[0], 3 + n.x - 0.5 * n.y + 2 * n.z, 1e-12);
    }
}

TEST(DirectedIrradiance, ALargeScaleBecomesUniformLight) {
    DirectedIrradiance light;
    light.slope[2] = Spectrum(1);  // a lamp at the zenith
    DirectedIrradiance same = light;
    constrain(same, {0, 0, 1}, Spectrum(1.5));
    EXPECT_DOUBLE_EQ(same.slope[2][0], 1.5);
    EXPECT_DOUBLE_EQ(same.constant[0], 0);
    constrain(light, {0, 0, 1}, Spectrum(10));
    EXPECT_DOUBLE_EQ(light.at({0, 0, 1})[0], 10);
    EXPECT_DOUBLE_EQ(light.constant[0], 4);
}

TEST(DirectedLightMap, OneLampGivesItsDirection) {
    const Solution s = lamp_above_floor();
    const LightMaps dominant = bake_directed(s, 8, Directions::dominant), sh = bake_directed(s, 8, Directions::sh);
    visit_whole_texels(dominant, [&](const Chart&, const LightMap& map, std::size_t i, const Point& x) {
        const DominantDirection found = dominant_direction(directed_at(map, i));
        const Vec3 to = Vec3{0, 0, 2} - x;
        const double angle = std::acos(std::min(1.0, dot(found.direction, normalized(to)))) * 180 / pi;
        const double slant = std::acos(2 / norm(to)) * 180 / pi;
        // Texels are 12 cm wide, which is 4 degrees below the lamp; one of their points is evaluated.
        EXPECT_LT(angle, slant <= 45 ? 4 : 7) << slant;
        EXPECT_GT(found.share, slant <= 40 ? 0.95 : 0.7) << slant;
    });
    visit_whole_texels(sh, [&](const Chart&, const LightMap& map, std::size_t i, const Point& x) {
        const Vec3 to = Vec3{0, 0, 2} - x;
        if (2 / norm(to) < std::cos(40 * pi / 180)) return;
        // Light from within 45 degrees of the normal is linear in it.
        for (const Vec3& m : {Vec3{0, 0, 1}, normalized(Vec3{0.5, 0, 1}), normalized(Vec3{-0.2, 0.4, 1})}) {
            const double E = 5 * dot(normalized(to), m) / dot(to, to);
            EXPECT_NEAR(directed_at(map, i).at(m)[0], E, 0.05 * 5 / dot(to, to));
        }
    });
}

TEST(DirectedLightMap, AUniformSurroundingHasNoDirection) {
    Solution s;
    s.scene = box_scene(1, 2, 1.1, 0.5, 1, 1);
    s.indirect = sample_function(s.scene, 1, 20);
    for (auto& value : s.indirect.values) value.fill(2);
    s.interpolant = s.indirect, s.bounces = -1;
    // B = 1 + 0.5 * 2 on all faces, of which the indirect component has 1.
    const LightMaps maps = bake_directed(s, 8, Directions::sh, Component::indirect);
    visit_whole_texels(maps, [&](const Chart& chart, const LightMap& map, std::size_t i, const Point&) {
        const Normal& n = s.scene.regions()[chart.region].plane.n;
        EXPECT_NEAR(directed_at(map, i).at(n)[0], mean(map.at(i)), 1e-5);
        const std::array<Spectrum, 4> L = radiance_of(directed_at(map, i));
        for (std::size_t k = 1; k < 4; ++k) EXPECT_NEAR(L[k][0] / L[0][0], 0, 1e-4);
    });
}

TEST(DirectedLightMap, IsExactAtTheNormalAndNearTheLightOfTiltedPlanes) {
    const Solution s = cornell();
    const RadiosityFunction light(s);
    const double step = 2 * light.places().step();
    for (const Directions form : {Directions::sh, Directions::dominant}) {
        const LightMaps maps = bake_directed(s, 64, form);
        std::vector<ProbePoint> points;
        std::vector<double> found;
        visit_whole_texels(maps, [&](const Chart& chart, const LightMap& map, std::size_t i, const Point& x) {
            const Normal& n = s.scene.regions()[chart.region].plane.n;
            const DirectedIrradiance there = directed_at(map, i);
            for (std::size_t b = 0; b < bands; ++b)
                EXPECT_NEAR(there.at(n)[b], map.at(i)[b], 1e-5 * (1 + map.at(i)[b]));
            if (i % 7 != 0) return;
            const Vec3 along = Frame(n).u;
            for (const double tilt : {-30.0, 30.0}) {
                const Normal m = std::cos(tilt * pi / 180) * n + std::sin(tilt * pi / 180) * along;
                points.push_back({x + step * n, m});
                found.push_back(std::max(0.0, mean(there.at(m))));
            }
        });
        ASSERT_GT(points.size(), 100u);
        double squares = 0, level = 0;
        const std::vector<Light> probed = light.at(points);
        for (std::size_t k = 0; k < points.size(); ++k) {
            const double E = mean(probed[k].irradiance);
            squares += std::pow(found[k] - E, 2), level += E * E;
        }
        // Measured 7% and 35%: one direction underestimates light at grazing angles beside the lamp.
        const bool is_sh = form == Directions::sh;
        RecordProperty(is_sh ? "rms_sh" : "rms_dominant", fmt::format("{:.4f}", std::sqrt(squares / level)));
        EXPECT_LT(std::sqrt(squares / level), is_sh ? 0.08 : 0.40);
    }
}

TEST(DirectedLightMap, HasTheSameBitsOnAnyNumberOfThreads) {
    const Solution s = sample_solution();
    set_threads(1);
    const LightMaps one = bake_directed(s, 12, Directions::sh);
    set_threads(3);
    const LightMaps three = bake_directed(s, 12, Directions::sh);
    set_threads(0);
    for (std::size_t m = 0; m < one.maps.size(); ++m) EXPECT_EQ(one.maps[m].directed, three.maps[m].directed);
}

TEST(DirectedLightMap, ExtrapolatedTexelsContinueTheirNeighbours) {
    const Solution s = lamp_above_floor();
    const LightMaps maps = bake_directed(s, 8, Directions::sh);
    std::size_t extrapolated = 0;
    for (std::size_t i = 0; i < maps.maps[0].source.size(); ++i) {
        if (maps.maps[0].source[i] != LightMap::Source::extrapolated) continue;
        ++extrapolated;
        const Spectrum E = maps.maps[0].at(i);
        EXPECT_NEAR(directed_at(maps.maps[0], i).at({0, 0, 1})[0], E[0], 1e-4 * E[0]);
    }
    EXPECT_GT(extrapolated, 100u);
}

TEST(DirectedLightMap, TextureCoordinatesHaveDirectionsToo) {
    const Solution s = lamp_above_floor();
    UnwrapOptions unwrap_options;
    unwrap_options.density = 8;
    const Result<Unwrapped> unwrapped = unwrap(s.scene, unwrap_options);
    ASSERT_TRUE(unwrapped);
    UvBakeOptions options;
    options.size = unwrapped->size, options.directions = Directions::sh;
    Progress progress;
    const StopRequest stop;
    const Result<UvLightMaps> maps =
        bake_uv_light_maps(RadiosityFunction(s), uv_set_of(s.scene, *unwrapped), options, progress, stop);
    ASSERT_TRUE(maps);
    const LightMap& map = maps->maps[0].light;
    std::size_t known = 0;
    for (std::size_t i = 0; i < map.source.size(); ++i) {
        if (map.source[i] != LightMap::Source::computed && map.source[i] != LightMap::Source::extrapolated) continue;
        EXPECT_NEAR(directed_at(map, i).at({0, 0, 1})[0], map.at(i)[0], 1e-4 * map.at(i)[0]);
        ++known;
    }
    EXPECT_GT(known, 900u);
}

}  // namespace exitance
