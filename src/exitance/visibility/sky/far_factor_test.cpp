#include "exitance/visibility/sky/far_factor.hpp"

#include <gtest/gtest.h>

#include "exitance/direct/direct_light.hpp"

namespace exitance {
namespace {

/// A square under a clear sky whose sun is at height `height`, shifted by `along` in x.
Scene square(double height, double along = 0) {
    SceneDescription d;
    d.file = "square";
    d.groups = {"all"};
    d.materials = {{"grey", Spectrum(0.5), Spectrum()}};
    for (const Point& p : {Point{0, 0, 0}, Point{1, 0, 0}, Point{1, 1, 0}, Point{0, 1, 0}})
        d.points.push_back(p + Vec3{along, 0, 0});
    d.faces.push_back({{0, 1, 2, 3}, 0, 0, 1});
    SkyModel sky = cie_sky(12, normalized(Vec3{1, 0, height}));
    sky.normalize();
    d.distant.domes.push_back({sky, Spectrum(100)});
    CheckedScene checked = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

}  // namespace

TEST(FarFactor, IsRememberedByDirectionPartAndSky) {
    const Scene scene = square(0.5), other_sky = square(0.6), moved = square(0.5, 3);
    const Occluders occluders(scene), under_other_sky(other_sky), of_moved(moved);
    const PieceId first = occluders.distant_pieces().front(), second(first.value + 1);
    const Normal up{0, 0, 1}, north{0, 1, 0};
    EXPECT_LT(known_far_factor(occluders, first, up), 0);
    known_far_factor(occluders, first, up) = 0.25;
    known_far_factor(occluders, first, north) = 0.5;
    EXPECT_EQ(known_far_factor(occluders, first, up), 0.25);
    EXPECT_EQ(known_far_factor(occluders, first, north), 0.5);
    EXPECT_LT(known_far_factor(occluders, second, up), 0);
    EXPECT_LT(known_far_factor(under_other_sky, first, up), 0);
    EXPECT_LT(known_far_factor(occluders, first, up), 0) << "one sky is remembered";
    known_far_factor(occluders, first, up) = 0.25;
    EXPECT_LT(known_far_factor(of_moved, first, up), 0) << "its corners are rounded otherwise";
}

TEST(FarFactor, LightDoesNotDependOnEarlierQueries) {
    const Scene one = square(0.2), other = square(2);
    const Occluders at_one(one), at_other(other);
    const DirectLight light_of_one(one, at_one), light_of_other(other, at_other);
    DirectLight::Workspace workspace;
    const auto light = [&](const DirectLight& direct, const Normal& n) {
        return direct.irradiance({0.3, 0.4, 2}, n, RegionId(), workspace)[0];
    };
    const Normal up{0, 0, 1}, slanting = normalized(Vec3{0.3, 0.2, 1});
    const double first = light(light_of_one, up), second = light(light_of_other, up),
                 third = light(light_of_one, slanting);
    EXPECT_EQ(light(light_of_one, up), first);
    EXPECT_EQ(light(light_of_other, up), second);
    EXPECT_EQ(light(light_of_one, slanting), third);
    EXPECT_NEAR(first, 100, 0.1);  // 1e-3, the accuracy of sky integrals
    EXPECT_NEAR(second, 100, 0.1);
    EXPECT_GT(std::abs(third - first), 1);
}

}  // namespace exitance
