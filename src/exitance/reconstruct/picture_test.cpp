#include "exitance/reconstruct/picture.hpp"

#include <gtest/gtest.h>

#include "exitance/core/parallel.hpp"
#include "support/built_scene.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

/// What arrives in a furnace, E = M / (1 - rho), all of it in the elements.
Solution furnace(double rho) {
    Solution s;
    s.scene = box_scene(1, 2, 1, rho, 1, 1);
    s.indirect = sample_function(s.scene, 1, 20);
    for (auto& value : s.indirect.values) value.fill(static_cast<float>(1 / (1 - rho)));
    s.interpolant = s.indirect;
    s.direct_in_elements = true;
    return s;
}

Picture picture_of(const Solution& s, const Camera& camera, PictureSize size) {
    return take_picture(s.scene, RadiosityFunction(s), RayTracer(s.scene), camera, size, 4);
}

TEST(CameraRays, TheMiddleLooksAtTheTargetAndTheEdgesStandHalfTheAngleAway) {
    const Camera camera{{1, 2, 3}, {4, 6, 3}, 90};
    const CameraRays rays(camera, {200, 100});
    const Vec3 ahead = normalized(rays.direction(100, 50)), right = normalized(rays.direction(200, 50));
    EXPECT_NEAR(norm(ahead - Vec3{0.6, 0.8, 0}), 0, 1e-14);
    EXPECT_NEAR(dot(ahead, right), std::sqrt(0.5), 1e-14);
    EXPECT_GT(dot(right, Vec3{0.8, -0.6, 0}), 0);              // right of (3, 4) is (4, -3)
    EXPECT_GT(rays.direction(100, 0).z, rays.direction(100, 100).z);  // above is the picture's first row
    EXPECT_TRUE(is_finite(CameraRays({{0, 0, 1}, {0, 0, 0}}, {2, 2}).direction(0, 0)));
}

TEST(Picture, OfAFurnaceIsUniform) {
    const double rho = 0.6, expected = 1 / (1 - rho);
    const Picture picture = picture_of(furnace(rho), {{0.2, 0.3, 0.5}, {0.9, 1.9, 0.4}, 90}, {24, 16});
    ASSERT_EQ(picture.pixels.size(), 24u * 16u);
    for (const Pixel& pixel : picture.pixels) {
        EXPECT_EQ(pixel.front, 1);
        EXPECT_NEAR(pixel.radiosity[0], expected, 1e-6);  // elements hold floats
        EXPECT_NEAR(pixel.irradiance[0], expected, 1e-6);
    }
}

TEST(Picture, ShowsNoLightOnBacksAndWhereNothingIs) {
    const Solution s = furnace(0.5);
    const Picture picture = picture_of(s, {{0.5, -3, 0.5}, {0.5, 0, 0.5}, 90}, {21, 21});
    const Pixel& middle = picture.pixels[10 * 21 + 10];
    EXPECT_EQ(middle.back, 1);
    EXPECT_EQ(middle.radiosity, Spectrum());
    EXPECT_EQ(picture.pixels.front().back + picture.pixels.front().front, 0);
}

TEST(Picture, SeesTheLightThatTheFunctionHasThere) {
    const Solution s = sample_solution();
    const Camera camera{{1.9, 0.9, 0.9}, {0.2, 0.2, 0}, 30};
    const Picture picture = take_picture(s.scene, RadiosityFunction(s), RayTracer(s.scene), camera, {1, 1}, 1);
    const Vec3 along = camera.target - camera.eye;  // the target lies on the floor
    const std::vector<ProbePoint> there = {{camera.eye + along, {0, 0, 1}}};
    const Light light = RadiosityFunction(s).at(there)[0];
    for (std::size_t b = 0; b < bands; ++b)  // rounding of the point, a few 1e-16 m, times the slope of the light
        EXPECT_NEAR(picture.pixels[0].irradiance[b], light.irradiance[b], 1e-9 * light.irradiance[b]);
}

TEST(Picture, HasTheSameBitsOnAnyNumberOfThreads) {
    const Solution s = sample_solution();
    const Camera camera{{1.9, 0.9, 0.9}, {0, 0, 0}, 80};
    set_threads(1);
    const Picture one = picture_of(s, camera, {31, 17});
    set_threads(2);
    const Picture two = picture_of(s, camera, {31, 17});
    set_threads(0);
    for (std::size_t i = 0; i < one.pixels.size(); ++i) {
        EXPECT_EQ(one.pixels[i].radiosity, two.pixels[i].radiosity);
        EXPECT_EQ(one.pixels[i].front, two.pixels[i].front);
    }
}

TEST(AutomaticCamera, StandsInsideAClosedRoomAndOutsideAnOpenScene) {
    const PictureSize size{64, 40};
    const auto is_inside = [&](const Scene& scene) {
        const Point eye = automatic_camera(scene, RayTracer(scene), size).eye;
        const Box& box = scene.box();
        return min(eye, box.lo) == box.lo && max(eye, box.hi) == box.hi;
    };
    EXPECT_TRUE(is_inside(sample_scene()));
    SceneDescription plate;
    plate.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    plate.materials = {{"grey", Spectrum(0.5), Spectrum(1)}};
    plate.groups = {"plate"};
    plate.faces = {{{0, 1, 2, 3}, 0, 0, 1}};
    const CheckedScene made = make_scene(plate);
    ASSERT_TRUE(static_cast<bool>(made.scene));
    EXPECT_FALSE(is_inside(*made.scene));
}

}  // namespace
}  // namespace exitance
