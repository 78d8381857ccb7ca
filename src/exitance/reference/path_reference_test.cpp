#include "exitance/reference/path_reference.hpp"

#include <gtest/gtest.h>

#include "exitance/base/parallel.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

std::vector<ReferenceLight> paths(const Scene& scene, const std::vector<ProbePoint>& points, std::size_t n) {
    Progress progress;
    const StopRequest stop;
    return reference_light(scene, points, n, 3, progress, stop);
}

TEST(PathReference, FindsAFurnacesLightWithinItsOwnStandardError) {
    const double rho = 0.5;
    const Scene scene = box_scene(1, 2, 1, rho, 1, 1);
    std::vector<ProbePoint> points;
    for (int i = 0; i < 30; ++i) points.push_back({{0.02 + 0.03 * i, 1.0, 0}, {0, 0, 1}});
    double z_squares = 0;
    for (const ReferenceLight& r : paths(scene, points, 2048)) {
        ASSERT_GT(r.standard_error[0], 0);
        EXPECT_LT(r.standard_error[0], 0.06);
        z_squares += std::pow((r.irradiance[0] - 1 / (1 - rho)) / r.standard_error[0], 2);
    }
    // 30 values of Student's t with 15 degrees of freedom: the mean square is 1.15 +- 0.35.
    EXPECT_LT(z_squares / 30, 2.5);
}

/// From such points, a path may hit the emitter at distance zero.
TEST(PathReference, IsFiniteBesideTheCornerOfAnEmitter) {
    const Scene scene = box_scene(1, 1, 1, 0.7, 1, 1);
    std::vector<ProbePoint> points;
    for (int i = 0; i < 16; ++i)
        points.push_back({{0, std::pow(10, -4 - 0.5 * i), 1 - std::pow(10, -4 - 0.4 * i)}, {1, 0, 0}});
    for (const ReferenceLight& r : paths(scene, points, 1024)) EXPECT_TRUE(std::isfinite(r.irradiance[0]));
}

TEST(PathReference, HasTheSameBitsOnAnyNumberOfThreads) {
    const Scene scene = built_scene("gcr2");
    const std::vector<ProbePoint> points = {{{1, 0.5, 0}, {0, 0, 1}}, {{0.4, 1, 0}, {0, 0, 1}}};
    set_threads(1);
    const std::vector<ReferenceLight> one = paths(scene, points, 256);
    set_threads(2);
    const std::vector<ReferenceLight> two = paths(scene, points, 256);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(one[i].irradiance, two[i].irradiance);
}

}  // namespace
}  // namespace exitance
