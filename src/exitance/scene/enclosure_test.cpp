#include "exitance/scene/enclosure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/scene/sky/sun_position.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// A room of 4 x 3 x 2.5 m with a window of glass of 2 x 1 m in the wall y = 3, under a sky.
struct Room {
    SceneDescription d;

    Room() {
        d.file = "room.obj";
        d.materials = {{"grey", Spectrum(0.5), {}}};
        d.groups = {"all"};
        face({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}});
        face({{0, 0, 2.5}, {0, 3, 2.5}, {4, 3, 2.5}, {4, 0, 2.5}});
        face({{0, 0, 0}, {0, 0, 2.5}, {4, 0, 2.5}, {4, 0, 0}});
        face({{0, 0, 0}, {0, 3, 0}, {0, 3, 2.5}, {0, 0, 2.5}});
        face({{4, 0, 0}, {4, 0, 2.5}, {4, 3, 2.5}, {4, 3, 0}});
        face({{0, 3, 0}, {4, 3, 0}, {4, 3, 1}, {3, 3, 1}, {1, 3, 1}, {0, 3, 1}});
        face({{0, 3, 2}, {1, 3, 2}, {3, 3, 2}, {4, 3, 2}, {4, 3, 2.5}, {0, 3, 2.5}});
        face({{0, 3, 1}, {1, 3, 1}, {1, 3, 2}, {0, 3, 2}});
        face({{3, 3, 1}, {4, 3, 1}, {4, 3, 2}, {3, 3, 2}});
        Pane pane;
        pane.corners = {{1, 3, 1}, {3, 3, 1}, {3, 3, 2}, {1, 3, 2}};
        for (std::size_t b = 0; b < bands; ++b) pane.transmissivity[b] = 0.9 - 0.2 * static_cast<double>(b);
        d.panes = {pane};
        d.distant.domes.push_back({perez_sky({100, 300, 80}, sky_direction(40, 10)), Spectrum(100.0)});
        DistantLight::Dome ground{uniform_sky(), Spectrum(20.0)};
        ground.model.below = true;
        d.distant.domes.push_back(ground);
    }
    void face(std::vector<Point> corners) {
        SceneDescription::Face f;
        for (const Point& p : corners) {
            f.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(p);
        }
        d.faces.push_back(std::move(f));
    }
    Scene scene() const {
        CheckedScene checked = make_scene(SceneDescription(d));
        EXI_CHECK(static_cast<bool>(checked.scene));
        return std::move(*checked.scene);
    }
};

std::size_t held(const Scene& scene) {
    const Enclosure enclosure = find_enclosure(scene);
    std::size_t count = 0;
    for (const RegionId r : scene.regions().ids()) count += enclosure.holds(r);
    return count;
}

}  // namespace

TEST(Enclosure, OfARoomItsWindowIsSeenFromAllSurfaces) {
    Room room;
    EXPECT_EQ(held(room.scene()), room.scene().regions().size());
    const Enclosure enclosure = find_enclosure(room.scene());
    ASSERT_EQ(enclosure.windows.size(), 1u);
    EXPECT_NEAR(enclosure.windows[0].n.y, -1, 1e-12) << "inwards";
    std::reverse(room.d.panes[0].corners.begin(), room.d.panes[0].corners.end());
    EXPECT_NEAR(find_enclosure(room.scene()).windows.at(0).n.y, -1, 1e-12);
}

TEST(Enclosure, FurnitureAndPartitionsAreWithin) {
    Room room;
    room.face({{1, 1, 0.7}, {2, 1, 0.7}, {2, 2, 0.7}, {1, 2, 0.7}});
    room.face({{2, 0, 0}, {2, 2, 0}, {2, 2, 2.5}, {2, 0, 2.5}});
    EXPECT_EQ(held(room.scene()), room.scene().regions().size());
}

TEST(Enclosure, WhatIsNotClosedOrStandsBeforeWindowsHasNone) {
    Room gap;
    for (Point& p : gap.d.points)
        if (p.z == 2.5 && p.y == 0) p.z = 2.4;
    gap.d.faces.erase(gap.d.faces.begin() + 3);  // a wall
    EXPECT_EQ(held(gap.scene()), 0u);
    Room outdoors;
    outdoors.face({{0, 5, 0}, {4, 5, 0}, {4, 5, 2}, {0, 5, 2}});
    EXPECT_EQ(held(outdoors.scene()), 0u) << "a wall across the street";
    Room recessed;
    for (Point& p : recessed.d.panes[0].corners) p.y = 2.9;
    EXPECT_EQ(held(recessed.scene()), 0u);
}

TEST(Enclosure, AFaceThatLeavesTheRoomIsNotWithin) {
    Room room;
    room.face({{-1, 1, 0.7}, {2, 1, 0.7}, {2, 2, 0.7}, {-1, 2, 0.7}});
    const Scene scene = room.scene();
    EXPECT_EQ(held(scene), scene.regions().size() - 1);
}

TEST(Enclosure, TheSkyThroughItsWindowIsThatOfThePartsOfTheSky) {
    Room room;
    room.face({{1, 1, 0.7}, {2, 1, 0.7}, {2, 2, 0.7}, {1, 2, 0.7}});          // a table,
    room.face({{2.2, 2, 0}, {2.2, 2.8, 0}, {2.2, 2.8, 1.6}, {2.2, 2, 1.6}});  // a screen
    const Scene scene = room.scene();
    const Stage stage(scene);
    DirectLight::Workspace workspace;
    ReceiverLight light;
    double worst = 0, sum = 0;
    int count = 0;
    for (const RegionId own : {RegionId(0), RegionId(1), RegionId(2), RegionId(3)}) {
        const Plane& plane = scene.regions()[own].plane;
        for (int i = 0; i < 20; ++i) {
            Point x{0.3 + 0.17 * i, 0.2 + 0.61 * (i % 5), 0.2 + 0.11 * i};
            x = x - plane.signed_distance(x) * plane.n;
            const Spectrum through = stage.direct.irradiance(x, plane.n, own, workspace),
                           sky = stage.direct.irradiance(x + 1e-9 * plane.n, plane.n, RegionId(), workspace);
            stage.direct.prepare(scene.regions()[own].loops[0], plane.n, own, light, workspace);
            EXPECT_NEAR(stage.direct.irradiance(light, x, workspace)[1], through[1], 1e-9 + 1e-6 * through[1]);
            for (std::size_t b = 0; b < bands; ++b) {
                worst = std::max(worst, std::abs(through[b] - sky[b]));
                sum += sky[b], ++count;
                // Parts of the sky take the middle's transmission where it varies by 0.04.
                EXPECT_NEAR(through[b], sky[b], 6e-3 * sky[b] + 1e-4) << own.value << " " << i << " " << b;
            }
        }
    }
    EXPECT_GT(sum / count, 0.1);
    EXPECT_LT(worst, 1e-2 * sum / count);
}

TEST(Enclosure, TheSkyThroughItsWindowIsTheIntegral) {
    const Room room;
    const Scene scene = room.scene();
    const Stage stage(scene);
    DirectLight::Workspace workspace;
    const Pane& pane = scene.panes()[0];
    constexpr int steps = 400;
    for (const Point x : {Point{1, 1, 0}, Point{2, 2.8, 0}, Point{3.7, 0.4, 0}}) {
        Spectrum sum;
        for (int i = 0; i < 2 * steps; ++i)
            for (int k = 0; k < steps; ++k) {
                const Vec3 r = Point{1 + (i + 0.5) / steps, 3, 1 + (k + 0.5) / steps} - x, w = normalized(r);
                const double kernel = w.z * w.y / (pi * squared_norm(r) * steps * steps);
                sum += kernel * (scene.distant().radiosity(w, false) * pane.transmission(w.y));
            }
        const Spectrum E = stage.direct.irradiance(x, {0, 0, 1}, RegionId(0), workspace);
        for (std::size_t b = 0; b < bands; ++b) EXPECT_NEAR(E[b], sum[b], 1e-3 * sum[b]) << x.y << " " << b;
    }
    // From the ceiling the ground is seen.
    const RegionId ceiling(1);
    const Point x{2, 2, 2.5};
    Spectrum sum;
    for (int i = 0; i < 2 * steps; ++i)
        for (int k = 0; k < steps; ++k) {
            const Vec3 r = Point{1 + (i + 0.5) / steps, 3, 1 + (k + 0.5) / steps} - x, w = normalized(r);
            const double kernel = -w.z * w.y / (pi * squared_norm(r) * steps * steps);
            sum += kernel * (scene.distant().radiosity(w, false) * pane.transmission(w.y));
        }
    EXPECT_NEAR(stage.direct.irradiance(x, {0, 0, -1}, ceiling, workspace)[0], sum[0], 1e-3 * sum[0]);
}

}  // namespace exitance
