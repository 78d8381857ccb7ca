#include "exitance/direct/crowded_light.hpp"

#include <gtest/gtest.h>

#include "exitance/transport/stage.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// The floor below thin triangles and a lamp, seen as a whole.
struct Floor {
    Floor() {
        region = stage.scene.surfaces()[SurfaceId(0)].region;
        n = stage.scene.regions()[region].plane.n;
        stage.direct.prepare(stage.scene.regions()[region].loops[0], n, region, light, room);
    }

    const Scene scene = built_scene("clutter", {{"n", "60"}});
    const Stage stage{scene};
    RegionId region;
    Normal n;
    ReceiverLight light;
    DirectLight::Workspace room;
};

TEST(CrowdedLight, IsExactLightUpToItsNoise) {
    Floor floor;
    ReceiverLight rest = floor.light;
    unsigned rays = 0;
    const auto crowded = floor.stage.crowded.take_crowded(rest, {2, 2, 0}, 0.01, floor.room, rays);
    ASSERT_EQ(crowded.size(), 1u);
    EXPECT_TRUE(rest.sources.empty());
    EXPECT_GE(rays, 16u);
    double squares = 0, variance = 0;
    int places = 0;
    for (double x = 0.1; x < 4; x += 0.2)
        for (double y = 0.1; y < 4; y += 0.2, ++places) {
            const CrowdedLight::Estimate at = floor.stage.crowded.at(rest, crowded, {x, y, 0}, rays, floor.room);
            const Spectrum exact = floor.stage.direct.irradiance(floor.light, {x, y, 0}, floor.room);
            squares += std::pow(mean(at.irradiance) - mean(exact), 2), variance += at.variance;
        }
    // Rays that are spread evenly are better than by chance; 400 places tell a variance to a tenth or so.
    EXPECT_LT(squares, 1.3 * variance);
    EXPECT_LT(variance / places, 0.01);
}

TEST(CrowdedLight, LeavesAllSourcesToExactLightWhereNoNoiseIsAllowed) {
    Floor floor;
    unsigned rays = 0;
    for (const double allowed : {0.0, 1e-9})
        EXPECT_TRUE(floor.stage.crowded.take_crowded(floor.light, {2, 2, 0}, allowed, floor.room, rays).empty());
    EXPECT_EQ(floor.light.sources.size(), 1u);
}

}  // namespace
}  // namespace exitance
