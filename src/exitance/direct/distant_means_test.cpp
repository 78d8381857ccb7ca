#include "exitance/direct/distant_means.hpp"

#include <gtest/gtest.h>

#include "exitance/scene/sky/perez_sky.hpp"
#include "exitance/scene/sky/sun_position.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// A field of small squares, the leaves of trees, below a sky and a sun.
Scene field_under_sky() {
    Scene scene = built_scene("tree", {{"leaves", "500"}});
    DistantLight light;
    light.domes.push_back({perez_sky({100, 300, 80}, sky_direction(40, 10)), Spectrum(100.0)});
    scene.put_under(light);
    return scene;
}

TEST(DistantMeans, AreThoseOfExactLight) {
    const Scene scene = field_under_sky();
    const Occluders occluders(scene);
    const RayTracer tracer(scene);
    const DirectLight direct(scene, occluders);
    ASSERT_TRUE(DistantMeans::suits(direct));
    ElementTree tree;
    for (const RegionId r : scene.regions().ids()) {
        const std::vector<Point>& loop = scene.regions()[r].loops[0];
        if (scene.regions()[r].area < 0.05 && loop.size() == 4)
            tree.add_root(r, {loop[0], loop[1] - loop[0], loop[3] - loop[0]});
    }
    const std::vector<ElementId> elements = tree.leaves();
    ASSERT_GT(elements.size(), 100u);
    const std::vector<LightAccuracy> accuracy(elements.size(), LightAccuracy{.relative = 0.05, .absolute = 1});
    std::vector<DistantMeans::Mean> found(elements.size());
    DistantMeans::Workspace room;
    DistantMeans(direct, tracer).find(tree, elements, accuracy, room, found);
    DirectLight::Workspace scratch;
    double squares = 0, allowed = 0, difference = 0, all = 0;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        if (!found[i].is_found) continue;
        const RegionId region = tree.region(elements[i]);
        const double exact = mean(direct.irradiance(tree.patch(elements[i]).centre(), scene.regions()[region].plane.n,
                                                    region, scratch));
        const double error = mean(found[i].irradiance) - exact;
        squares += error * error, difference += error, all += exact, allowed += std::pow(0.05 * exact + 1, 2);
    }
    // The light also varies over a leaf, so that its centre differs from the mean.
    EXPECT_LT(squares, 4 * allowed);
    EXPECT_LT(std::abs(difference), 0.02 * all);
}

}  // namespace
}  // namespace exitance
