#include "exitance/direct/crowd_by_light.hpp"

#include <gtest/gtest.h>

#include "exitance/transport/stage.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

TEST(CrowdByLight, ErrorIsBoundedByTheLight) {
    const Scene scene = built_scene("clutter", {{"n", "500"}});
    const Stage stage(scene);
    const RegionId floor = scene.surfaces()[SurfaceId(0)].region;
    const Normal n = scene.regions()[floor].plane.n;
    const std::span<const Point> outline = scene.regions()[floor].loops[0];
    constexpr double allowed = 1e-3, kept = 0.5;
    ReceiverLight all, rest;
    DirectLight::Workspace room;
    stage.direct.prepare(outline, n, floor, all, room);
    const CrowdedLight::Crowd crowd = stage.crowded.prepare(outline, n, floor, allowed, rest, room);
    ASSERT_EQ(crowd.sources.size(), 1u);
    double last = HUGE_VAL;
    for (const double mean_light : {0.05, 5.0}) {
        double squares = 0, may = 0, count = 0;
        for (double x = 0.3; x < 3.8; x += 0.4)
            for (double y = 0.3; y < 3.8; y += 0.4) {
                std::vector<Point> places;
                for (int k = 0; k < 9; ++k) places.push_back({x + 0.01 * (k % 3), y + 0.01 * (k / 3), 0});
                double E = 0;
                const auto found = estimates_by_light(stage.crowded, rest, crowd, places, kept, mean_light, room);
                for (std::size_t i = 0; i < places.size(); ++i) {
                    const double exact = mean(stage.direct.irradiance(all, places[i], room));
                    squares += std::pow(mean(found[i].irradiance) - exact, 2), E += exact / 9, ++count;
                }
                may += 9 * 0.5 * allowed * (1 + E / mean_light) / kept;
            }
        EXPECT_LT(squares, 1.2 * may);   // sampling stops when the quarters happen to agree, slightly too early
        EXPECT_LT(squares, 0.5 * last);  // with brighter light elsewhere, a twentieth is allowed
        last = squares;
    }
}

}  // namespace
}  // namespace exitance
