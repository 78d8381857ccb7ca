#include "exitance/error/area_samples.hpp"

#include <gtest/gtest.h>

#include "exitance/scene/locator.hpp"
#include "support/sample_solution.hpp"

namespace exitance {

TEST(PointsUniformInArea, AreOnFacesAndProportionalToTheirArea) {
    const Scene scene = sample_scene();
    const Locator locator(scene);
    const std::size_t count = 5000;
    std::vector<double> hits(scene.regions().size(), 0);
    for (const ProbePoint& point : points_uniform_in_area(scene, count, 1)) {
        const SurfaceId surface = locator.find(point.x, point.n);
        ASSERT_FALSE(surface.is_none());
        hits[scene.surfaces()[surface].region.value] += 1;
    }
    double area = 0;
    for (const Region& region : scene.regions()) area += region.area;
    // The strata follow the order of the pieces: a region's count deviates by at most one at each end of its pieces.
    for (RegionId r : scene.regions().ids())
        EXPECT_NEAR(hits[r.value], static_cast<double>(count) * scene.regions()[r].area / area, 8) << r.value;
}

}  // namespace exitance
