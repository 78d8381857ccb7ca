#include "exitance/what_if/daylight/daylight_transport.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "exitance/scene/photometric_units.hpp"
#include "exitance/scene/sky/sun_position.hpp"
#include "support/checked_scene.hpp"

namespace exitance {
namespace {

/// Ground of 2 x 2 m under a sky, a sun and panes.
Scene ground(std::vector<Spectrum> transmissivities) {
    SceneDescription d;
    d.file = "ground.obj";
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.groups = {"all"};
    d.points = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    d.faces.push_back({{0, 1, 2, 3}, 0, 0, 0});
    d.distant.domes = {{perez_sky({100, 300, 80}, sky_direction(40, 10)), Spectrum(100.0)}};
    d.distant.discs = {{sky_direction(50, 200), sun_half_angle, Spectrum(500.0)}};
    for (std::size_t i = 0; i < transmissivities.size(); ++i) {
        const double z = 1 + static_cast<double>(i);
        Pane pane;
        pane.corners = {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}}, pane.transmissivity = transmissivities[i];
        d.panes.push_back(std::move(pane));
    }
    return checked_scene(std::move(d));
}

}  // namespace

TEST(DaylightTransport, ReplacesSkyAndSunByARadianceOfOneInAllDirections) {
    const SkyPatches patches(1);
    const DaylightTransport transport(ground({}), patches, nullptr, 1);
    const DistantLight& light = transport.stage().scene.distant();
    EXPECT_TRUE(light.discs.empty());
    for (const Vec3 w : {Vec3{0, 0, 1}, Vec3{0.6, 0, 0.8}, Vec3{0, -0.8, -0.6}, Vec3{0, 0, -1}, sky_direction(50, 200)})
        for (std::size_t b = 0; b < bands; ++b)
            EXPECT_NEAR(light.radiosity(w, true)[b], pi, 1e-12) << w.x << " " << w.y << " " << w.z;
}

/// At right angles, grey glass passes the luminous light of white light that the coloured glass passes.
TEST(DaylightTransport, ReplacesColouredGlassByGreyGlassOfEqualLuminousTransmission) {
    Spectrum green(0.3), red(0.2);
    green[1] = 0.9, red[0] = 0.7;
    const Scene scene = ground({green, red, Spectrum(0.6)});
    const SkyPatches patches(1);
    const DaylightTransport transport(ground({green, red, Spectrum(0.6)}), patches, nullptr, 1);
    const std::vector<Pane>& panes = transport.stage().scene.panes();
    ASSERT_EQ(panes.size(), 3u);
    for (std::size_t i = 0; i < panes.size(); ++i) {
        EXPECT_TRUE(is_grey(panes[i].transmissivity)) << i;
        EXPECT_NEAR(panes[i].transmission(1)[0], luminous_sum(scene.panes()[i].transmission(1)), 1e-9) << i;
    }
    EXPECT_EQ(panes[2].transmissivity[0], 0.6) << "grey glass must not change at all";
}

}  // namespace exitance
