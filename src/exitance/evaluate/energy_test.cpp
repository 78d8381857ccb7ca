#include "exitance/evaluate/energy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "support/built_scene.hpp"
#include "support/checked_scene.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

/// A closed box of 2 x 1 x 1.5 m, 13 m^2, whose faces reflect nothing and emit different light in every band, rotated
/// by `angle` about the vertical, scaled by `size` and translated.
Solution black_box(bool photometric, double angle = 0, double size = 1) {
    SceneDescription d;
    d.photometric = photometric;
    Spectrum exitance;
    for (std::size_t b = 0; b < bands; ++b) exitance[b] = 10 * static_cast<double>(b + 1);
    d.materials = {{"lamp", Spectrum(), exitance}};
    d.groups = {"box"};
    for (const double z : {0.0, 1.5})
        for (const Vec2& p : {Vec2{0, 0}, Vec2{2, 0}, Vec2{2, 1}, Vec2{0, 1}})
            d.points.push_back({size * (std::cos(angle) * p.x - std::sin(angle) * p.y) + 7,
                                size * (std::sin(angle) * p.x + std::cos(angle) * p.y) - 3, size * z + 100});
    for (const std::vector<std::uint32_t>& f : box_faces) d.faces.push_back({f, 0, 0, 0});
    Solution s;
    s.scene = checked_scene(std::move(d));
    s.indirect = s.interpolant = sample_function(s.scene, 1, 0);
    for (auto& value : s.interpolant.values)
        for (std::size_t b = 0; b < bands; ++b) value[b] = static_cast<float>(exitance[b]);
    for (auto& value : s.indirect.values) value.fill(0);
    return s;
}

TEST(Energy, IsTheMeanOfTheBandsInWattsAndTheirWeightedSumInLumens) {
    for (const bool photometric : {false, true})
        for (const double size : {1.0, 0.01, 30.0}) {
            const Solution s = black_box(photometric, 0.7, size);
            const double a_unit = bands != 3    ? 5 * (static_cast<double>(bands) + 1)
                                  : photometric ? 0.265 * 10 + 0.670 * 20 + 0.065 * 30
                                                : 20;
            const Stage stage(s.scene);
            const EnergyBalance exported = energy_of_interpolant(s, stage);
            EXPECT_NEAR(exported.emitted / (13 * size * size * a_unit), 1, 1e-9);
            EXPECT_NEAR(exported.absorbed / exported.emitted, 1, 1e-6) << "single precision of what is stored";
            EXPECT_NEAR(energy_balance(s, stage).emitted / exported.emitted, 1, 1e-12);
        }
}

TEST(Energy, IsInTheUnitOfTheSceneForLightsWithoutExtent) {
    for (const bool photometric : {false, true}) {
        SceneDescription d;
        d.photometric = photometric;
        d.materials = {{"grey", Spectrum(0.5), Spectrum()}};
        d.groups = {"floor"};
        d.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
        d.faces.push_back({{0, 1, 2, 3}, 0, 0, 0});
        PunctualLight bulb;
        bulb.name = "bulb", bulb.position = {0.5, 0.5, 1}, bulb.intensity = Spectrum(100);
        d.lights = {bulb};
        CheckedScene made = make_scene(std::move(d));
        EXI_CHECK(static_cast<bool>(made.scene));
        Solution s;
        s.scene = std::move(*made.scene);
        s.indirect = s.interpolant = sample_function(s.scene, 1, 0);
        const EnergyBalance energy = energy_of_interpolant(s, Stage(s.scene));
        EXPECT_NEAR(energy.emitted, 4 * pi * 100, 1e-9);
    }
}

/// A floor of 1 m x 1 m that reflects nothing, with a lamp without extent `height` above its middle, scaled and turned
/// about x by `angle`.
Solution lamp_over_floor(PunctualLight lamp, double height, double scale, double angle) {
    const auto turned = [&](const Vec3& p) {
        return Vec3{p.x, std::cos(angle) * p.y - std::sin(angle) * p.z, std::sin(angle) * p.y + std::cos(angle) * p.z};
    };
    SceneDescription d;
    d.materials = {{"black", Spectrum(), Spectrum()}};
    d.groups = {"floor"};
    for (const Vec3& p : {Vec3{-0.5, -0.5, 0}, Vec3{0.5, -0.5, 0}, Vec3{0.5, 0.5, 0}, Vec3{-0.5, 0.5, 0}})
        d.points.push_back(Point{} + scale * turned(p));
    d.faces.push_back({{0, 1, 2, 3}, 0, 0, 0});
    lamp.position = Point{} + scale * turned({0, 0, height}), lamp.direction = turned(lamp.direction);
    lamp.name = "lamp", lamp.intensity = Spectrum(100);
    d.lights = {lamp};
    Solution s;
    s.scene = checked_scene(std::move(d));
    s.indirect = s.interpolant = sample_function(s.scene, 1, 0);
    for (auto& value : s.indirect.values) value.fill(0);
    return s;
}

TEST(Energy, LightOfLampsWithoutExtentThatMeetsNothingHasEscaped) {
    using Kind = PunctualLight::Kind;
    PunctualLight bulb, spot_down, spot_up;
    spot_down.kind = spot_up.kind = Kind::spot;
    spot_down.inner_cone = spot_up.inner_cone = 0.1, spot_down.outer_cone = spot_up.outer_cone = 0.4;
    spot_up.direction = {0, 0, 1};
    const double seen = 4 * std::asin(0.2) / (4 * pi);  // solid angle of the floor from 1 m above it, over 4 pi
    for (const double scale : {0.01, 1.0, 50.0})
        for (const double angle : {0.0, 1.0, 2.5})
            for (const auto& [lamp, height, share] : {std::tuple{bulb, 1.0, 1 - seen},
                                                      {bulb, -1.0, 1.0},
                                                      {spot_down, 1.0, 0.0},
                                                      {spot_down, -1.0, 1.0},
                                                      {spot_up, 1.0, 1.0}}) {
                const Solution s = lamp_over_floor(lamp, height, scale, angle);
                const EnergyBalance energy = energy_balance(s, Stage(s.scene));
                EXPECT_NEAR(energy.escaped / energy.emitted, share, 2e-3) << height << " " << scale << " " << angle;
            }
}

}  // namespace
}  // namespace exitance
