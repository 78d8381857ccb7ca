#include "exitance/what_if/daylight/daylight_provision.hpp"

#include <gtest/gtest.h>

#include "exitance/scene/add_polygon.hpp"
#include "exitance/what_if/daylight/sensor_places.hpp"
#include "exitance/what_if/daylight/view_out.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// Eight hours; the four with diffuse light are the daylight hours.
std::vector<DaylightHour> hours() {
    std::vector<DaylightHour> out(8);
    for (std::size_t h = 0; h < 4; ++h) out[2 + h].diffuse_horizontal = 100 + 10 * static_cast<double>(h);
    return out;
}

TEST(DaylightProvision, LevelsAgreeWithTheStandard) {
    // Twenty sensors. In half of the daylight hours, eleven reach 400 lx, eight 120 lx and one 90 lx.
    ProvisionCount count(hours(), {});
    for (std::size_t i = 0; i < 20; ++i) {
        const double lux = i < 11 ? 400 : i < 19 ? 120 : 90;
        const double reached = reached_by_half({0, lux, 0, 2 * lux});  // two of the four hours of daylight
        EXPECT_EQ(reached, lux);
        count.add(reached, 5);
    }
    EXPECT_EQ(daylight_hours(hours()), (std::vector<std::size_t>{5, 4, 3, 2}));
    const DaylightProvision p = count.provision();
    EXPECT_EQ(p.hours, 4u);
    EXPECT_NEAR(p.by_illuminance.at_target[0], 0.55, 1e-12);
    EXPECT_NEAR(p.by_illuminance.at_minimum[0], 0.95, 1e-12);
    EXPECT_EQ(p.by_illuminance.level(), 1);
    // 5% of the 120 W/m^2 x 120 lm/W that half of the hours reach: 720 lx.
    EXPECT_NEAR(p.median_diffuse, 120 * 120, 1e-9);
    EXPECT_NEAR(p.by_factor.at_target[1], 1, 1e-12);
    EXPECT_EQ(p.by_factor.level(), 2);
}

/// A room that is open to the south, optionally with a window in the opening, and a wall 10 m away.
Scene porch(bool pane) {
    SceneDescription d;
    d.groups = {"all"}, d.materials = {{"grey", Spectrum(0.5), Spectrum()}};
    const auto face = [&](const std::vector<Point>& corners) { add_polygon(d, corners); };
    // A room of 4 x 4 x 3 m. Its wall at y = 0 has an opening 2 m wide.
    face({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
    face({{0, 0, 3}, {0, 4, 3}, {4, 4, 3}, {4, 0, 3}});
    face({{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
    face({{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}});
    face({{4, 0, 0}, {4, 0, 3}, {4, 4, 3}, {4, 4, 0}});
    face({{0, 0, 0}, {0, 0, 3}, {1, 0, 3}, {1, 0, 0}});
    face({{3, 0, 0}, {3, 0, 3}, {4, 0, 3}, {4, 0, 0}});
    face({{-50, -10, 0}, {-50, -10, 2.5}, {50, -10, 2.5}, {50, -10, 0}});  // a wall along the street
    if (pane) d.panes.push_back({{{1, 0, 0}, {3, 0, 0}, {3, 0, 3}, {1, 0, 3}}, {0, -1, 0}, Spectrum(0.9)});
    CheckedScene made = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(made.scene));
    return std::move(*made.scene);
}

TEST(ViewOut, AnglesDistancesAndLayersAgreeWithTheWindow) {
    const std::vector<Point> eyes{{2, 3, 1.2}, {2, 1, 1.2}};
    const std::vector<ViewOut> views = views_out(porch(true), eyes);
    // The window is 2 m wide: 2 atan(1/3) and 2 atan(1/1).
    EXPECT_NEAR(views[0].sight_angle, 36.87, 0.26);
    EXPECT_NEAR(views[1].sight_angle, 90, 0.26);
    // 13 m straight ahead, 1 / cos of the angle at the sides; the median is half-way to the edge.
    EXPECT_NEAR(views[0].distance, 13 / std::cos(0.5 * std::atan(1.0 / 3)), 0.05);
    EXPECT_TRUE(views[0].landscape);
    EXPECT_TRUE(views[0].sky);
    EXPECT_EQ(views[0].level(), 1);
    EXPECT_EQ(ViewOut().level(), 0);
    EXPECT_EQ((ViewOut{60, HUGE_VAL, true, true, true}.level()), 3);
    // Without a pane, the wall along the street counts as one of the room.
    EXPECT_FALSE(views_out(porch(false), eyes)[0].landscape);
}

TEST(SunlightHours, AgreeWithTheSunThroughAWindow) {
    // The window faces south: in front of it the sun is visible all day, deeper in the room for shorter times.
    const DaylightSite site{.place = {47.4, 8.5, 400}, .zone = 1};
    const Scene room = porch(true);
    const Occluders occluders(room);
    const std::vector<ProbePoint> sensors{{{2, -1, 1}, {0, 0, 1}}, {{2, 3.9, 0.1}, {0, 0, 1}}, {{2, 1, 0}, {0, 0, 1}}};
    const std::vector<SurfacePoint> places = sensor_places(room, occluders, sensors);
    const SunlightHours sunlight(occluders, site, {}), high(occluders, site, {3, 21, 40});
    std::vector<double> hours;
    for (const SurfacePoint& place : places) hours.push_back(sunlight.at(place));
    EXPECT_NEAR(hours[0], 12.15, 0.1);  // the whole day of the equinox
    EXPECT_GT(hours[2], 1);
    EXPECT_LT(hours[1], hours[2]);
    // cos H = (sin 39.98 - sin 47.4 sin 0.43) / (cos 47.4 cos 0.43): H = 19.8 degrees on either side of noon, where
    // 0.43 is the declination, and refraction raises the sun by 0.02.
    EXPECT_NEAR(high.at(places[0]), 2 * 19.8 / 15, 0.05);
}

}  // namespace
}  // namespace exitance
