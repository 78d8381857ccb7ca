#include "exitance/evaluate/energy.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
    for (const std::vector<std::uint32_t>& f : std::vector<std::vector<std::uint32_t>>{
             {0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}})
        d.faces.push_back({f, 0, 0, 0});
    CheckedScene made = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(made.scene));
    Solution s;
    s.scene = std::move(*made.scene);
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

}  // namespace
}  // namespace exitance
