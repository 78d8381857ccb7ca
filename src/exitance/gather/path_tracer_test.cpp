#include "exitance/gather/path_tracer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A floor of 100 x 60 m under a square lamp of some width, 20 m above it.
Scene hall(double width) {
    const Point c{40, 30, 20};
    const double h = width / 2;
    return test::make({{{{0, 0, 0}, {100, 0, 0}, {100, 60, 0}, {0, 60, 0}}},
                       {{c + Vec3{-h, -h, 0}, c + Vec3{-h, h, 0}, c + Vec3{h, h, 0}, c + Vec3{h, -h, 0}}, 1}});
}

TEST(PathTracer, FindsTheLightOfLampsAsSmallAsAMillionthOfTheScene) {
    // Rays are traced in single precision, so that a part of those to a small lamp pass its rim.
    for (const double width : {1.0, 1e-2, 1e-3, 1e-4}) {
        const Scene scene = hall(width);
        const Stage stage(scene);
        const PathTracer paths(stage);
        const Surface& floor = scene.surfaces()[SurfaceId(0)];
        const Point x{45.3, 27.1, 0};
        DirectLight::Workspace workspace;
        const double exact = stage.direct.irradiance(x, floor.normal, floor.region, workspace)[0];
        RandomStream random(3, Stream::reference);
        constexpr int count = 4096;
        double sum = 0, squares = 0;
        for (int i = 0; i < count; ++i) {
            const double found = paths.step({x, floor.normal, floor.region}, random).direct[0];
            sum += found, squares += found * found;
        }
        const double mean = sum / count, variance = std::max(0.0, squares / count - mean * mean) / count;
        EXPECT_NEAR(mean, exact, 4 * std::sqrt(variance) + 1e-4 * exact) << width;
    }
}

}  // namespace
}  // namespace exitance
