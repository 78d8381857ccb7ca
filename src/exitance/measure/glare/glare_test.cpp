#include "exitance/measure/glare/glare.hpp"

#include <gtest/gtest.h>

#include "support/built_scene.hpp"
#include "support/checked_scene.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

/// A room of 8 x 6 x 3 m whose surfaces all reflect one half. Square lamps of half side `half`, metres, at 2.7 m face
/// down and emit 5000 cd/m^2. The indirect illuminance is 200 lx on every surface, so that every surface sends 100
/// lm/m^2.
Solution lamp_room(const std::vector<Vec2>& lamps, double half = 0.1) {
    SceneDescription d;
    d.photometric = true;
    d.materials = {{"wall", Spectrum(0.5), Spectrum()}, {"lamp", Spectrum(0.5), exitance_of_radiance(Spectrum(5000))}};
    for (const double z : {0.0, 3.0}) d.points.insert(d.points.end(), {{0, 0, z}, {8, 0, z}, {8, 6, z}, {0, 6, z}});
    d.groups = {"room"};
    for (const std::vector<std::uint32_t>& f : box_faces) d.faces.push_back({f, 0, 0, 0});
    for (const Vec2& at : lamps) {
        const auto first = static_cast<std::uint32_t>(d.points.size());
        for (const Vec2& o : {Vec2{-half, -half}, Vec2{-half, half}, Vec2{half, half}, Vec2{half, -half}})
            d.points.push_back({at.x + o.x, at.y + o.y, 2.7});
        d.faces.push_back(
            {{first, first + 1, first + 2, first + 3}, 1, static_cast<std::uint32_t>(d.groups.size()), 0});
        d.groups.push_back("lamp " + std::to_string(d.groups.size()));
    }
    return even_solution(checked_scene(std::move(d)), 200);
}

TEST(Glare, AgreesWithAHandCalculationForARoom) {
    // Eye at (1, 3, 1.2), looking along x. For each lamp omega = A h / r^3, A = 0.04 m^2, h = 1.5 m:
    //   offset       r^2    omega      p        L^2 omega / p^2
    //   (2, 0)       6.25   0.0038400  4.65672  4427.1
    //   (4, 0)       18.25  0.00076959 2.19730  3984.9
    //   (2, 2)       10.25  0.0018284  5.17503  1706.8
    //   (4, -2)      22.25  0.00057169 2.36056  2564.9     sum 12683.7
    // L_b = 100 / pi = 31.831 cd/m^2; UGR = 8 log10(0.25 x 12683.7 / 31.831) = 16.0
    const Solution s = lamp_room({{3, 3}, {5, 3}, {3, 5}, {5, 1}});
    const RadiosityFunction light(s);
    const Glare glare = find_glare(light, {"", {1, 3, 1.2}, {1, 0, 0}}, LightUnit(UnitChoice::lux, true));
    ASSERT_EQ(glare.sources.size(), 4u);
    const GlareSource& worst = glare.sources.front();
    EXPECT_EQ(worst.name, "lamp 1");
    EXPECT_NEAR(worst.luminance, 5000, 1e-6);
    EXPECT_NEAR(worst.solid_angle / 0.00384, 1, 3e-3);
    EXPECT_NEAR(worst.position, 4.65672, 1e-4);
    EXPECT_NEAR(glare.background, 31.831, 0.02 * 31.831);
    EXPECT_NEAR(glare.rating(), 15.99, 0.05);
    EXPECT_FALSE(glare.has_large_source());
}

TEST(Glare, LuminairesBehindOrFacingAwayDoNotCount) {
    const Solution s = lamp_room({{3, 3}, {5, 3}});
    const RadiosityFunction light(s);
    const LightUnit lux(UnitChoice::lux, true);
    EXPECT_EQ(find_glare(light, {"", {1, 3, 1.2}, {-1, 0, 0}}, lux).sources.size(), 0u);
    EXPECT_FALSE(std::isfinite(find_glare(light, {"", {1, 3, 1.2}, {-1, 0, 0}}, lux).rating()));
    EXPECT_EQ(find_glare(light, {"", {4, 3, 1.2}, {1, 0, 0}}, lux).sources.size(), 1u);
    EXPECT_EQ(find_glare(light, {"", {1, 3, 2.8}, {1, 0, 0}}, lux).sources.size(), 0u);  // the eye is above the lamps
}

TEST(Glare, ExcludesLuminairesBeyondTheLimitsOfCie117WithReason) {
    // Seen from (1, 3, 1.2) along x, R, T and H / R of the lamps at 2.7 m: 2, 0, 0.75; 0.7, 0, 2.1; 0.5, 2, 3 (T/R 4).
    const Solution s = lamp_room({{3, 3}, {1.7, 3}, {1.5, 5}});
    const RadiosityFunction light(s);
    const Glare glare = find_glare(light, {"", {1, 3, 1.2}, {1, 0, 0}}, LightUnit(UnitChoice::lux, true));
    ASSERT_EQ(glare.sources.size(), 1u);
    EXPECT_EQ(glare.sources[0].name, "lamp 1");
    ASSERT_EQ(glare.left_out.size(), 2u);
    EXPECT_EQ(glare.left_out[0].name, "lamp 2");
    EXPECT_EQ(glare.left_out[0].limit, GlareLimit::overhead);
    EXPECT_EQ(glare.left_out[1].limit, GlareLimit::aside);
    // The rating is that of the first lamp alone.
    const Solution one = lamp_room({{3, 3}});
    const RadiosityFunction of_one(one);
    EXPECT_NEAR(glare.rating(),
                find_glare(of_one, {"", {1, 3, 1.2}, {1, 0, 0}}, LightUnit(UnitChoice::lux, true)).rating(), 0.01)
        << "the noise of the background's rays";
}

TEST(Glare, ALuminaireJustAboveTheEyeCountsOnlyIfItReachesBelowIt) {
    const Solution s = lamp_room({{7, 3}});
    const RadiosityFunction light(s);
    const LightUnit lux(UnitChoice::lux, true);
    // At a distance of 6 m, 85 degrees from the nadir are 0.525 m.
    EXPECT_EQ(find_glare(light, {"", {1, 3, 2.7 - 0.55}, {1, 0, 0}}, lux).sources.size(), 1u);
    const Glare level = find_glare(light, {"", {1, 3, 2.7 - 0.5}, {1, 0, 0}}, lux);
    EXPECT_EQ(level.sources.size(), 0u);
    ASSERT_EQ(level.left_out.size(), 1u);
    EXPECT_EQ(level.left_out[0].limit, GlareLimit::level);
}

TEST(Glare, ALuminaireWithoutExtentCountsAsASmallSource) {
    // 1 mm wide, like a luminaire whose file gives no extent: L^2 omega = I^2 / (0.005 m^2 r^2), not I^2 / (A r^2).
    const LightUnit lux(UnitChoice::lux, true);
    const auto source = [&](double half) {
        const Solution s = lamp_room({{3, 3}}, half);
        const RadiosityFunction light(s);
        const Glare glare = find_glare(light, {"", {1, 3, 1.2}, {1, 0, 0}}, lux);
        EXPECT_EQ(glare.sources.size(), 1u);
        return glare.sources.at(0);
    };
    const double r2 = 2 * 2 + 1.5 * 1.5, cosine = 1.5 / std::sqrt(r2), p = 4.65672;
    const auto intensity = [&](double half) { return 5000 * 4 * half * half * cosine; };
    EXPECT_NEAR(source(0.0005).term() / (std::pow(intensity(0.0005), 2) / (small_source_area * r2 * p * p)), 1, 1e-3);
    EXPECT_NEAR(source(0.02).term() / (std::pow(intensity(0.02), 2) / (4 * 0.02 * 0.02 * cosine * r2 * p * p)), 1,
                1e-3);
}

TEST(Glare, ALightWithoutExtentCountsAsASmallSource) {
    // L^2 omega = 200 I^2 / r^2.
    Solution s = sample_solution();
    const RadiosityFunction light(s);
    const LightUnit lux(UnitChoice::lux, true);
    const Glare glare = find_glare(light, {"", {0.3, 0.2, 0.1}, {0, 0, 1}}, lux);
    const auto spot = std::find_if(glare.sources.begin(), glare.sources.end(),
                                   [](const GlareSource& source) { return source.name == "spot"; });
    ASSERT_NE(spot, glare.sources.end());
    const double intensity = lux(s.scene.lights()[0].intensity);
    EXPECT_NEAR(spot->term(), 200 * intensity * intensity / 0.64, 1e-9 * spot->term());
}

TEST(Glare, IsTheSameForAnEyeOnAWallAndBesideIt) {
    const Solution s = lamp_room({{3, 3}, {5, 3}});
    const RadiosityFunction light(s);
    const LightUnit lux(UnitChoice::lux, true);
    const Normal view{1, 0, 0};
    const auto rated = [&](const Point& eye) { return find_glare(light, {"", eye, view}, lux); };
    const Glare along = rated({1, 0, 1.2}), beside = rated({1, 1e-3, 1.2});
    EXPECT_NEAR(along.background / beside.background, 1, 0.02);  // noise of 4096 rays at eight points
    EXPECT_NEAR(along.rating(), beside.rating(), 0.1);
    // Looking away from the wall, both lamps are visible.
    const Glare away = rated({0, 3, 1.2}), before = rated({1e-3, 3, 1.2});
    ASSERT_EQ(before.sources.size(), 2u);
    ASSERT_EQ(away.sources.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_NEAR(away.sources[i].term() / before.sources[i].term(), 1,
                    0.01);  // the luminaires moved by 1 mm at a distance of 3 m
}

}  // namespace
}  // namespace exitance
