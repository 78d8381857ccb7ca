#include "exitance/visibility/glazed_part.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/transport/stage.hpp"
#include "support/window_room.hpp"

namespace exitance {
namespace {

using Room = test::WindowRoom;
using test::more_panes, test::MorePanes;

}  // namespace

TEST(WindowSky, AgreesWithThePartsOfTheSky) {
    Room room;
    room.face({{1, 1, 0.7}, {2, 1, 0.7}, {2, 2, 0.7}, {1, 2, 0.7}});          // a table
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
                // Both values have an error of at most 1e-3.
                EXPECT_NEAR(through[b], sky[b], 2e-3 * sky[b] + 1e-4) << own.value << " " << i << " " << b;
            }
        }
    }
    EXPECT_GT(sum / count, 0.1);
    EXPECT_LT(worst, 1e-2 * sum / count);
}

TEST(WindowSky, IsTheIntegral) {
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
    // The ground is visible from the ceiling.
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

namespace {

/// True if a face blocks the ray from x along w.
bool is_hidden(const Scene& scene, const Point& x, const Vec3& w) {
    for (const SurfaceId s : scene.surfaces().ids()) {
        const auto outline = scene.outline(s);
        const Normal& n = scene.surfaces()[s].normal;
        const double t = dot(n, outline[0] - x) / dot(n, w);
        if (!(t > 1e-9) || !std::isfinite(t)) continue;
        const Point at = x + t * w;
        bool inside = true;
        for (std::size_t i = 0; i < outline.size(); ++i)
            inside = inside && dot(cross(n, outline[(i + 1) % outline.size()] - outline[i]), at - outline[i]) > 0;
        if (inside) return true;
    }
    return false;
}

/// Integrates the light of the sky over the pane, which faces -y, by one random point in each cell. Points are random
/// because edges of shadows are parallel to rows of cells.
Spectrum sum_over_pane(const Scene& scene, const Point& x, const Normal& n, int steps) {
    const Pane& pane = scene.panes()[0];
    const double y = pane.corners[0].y;
    RandomStream random(1, Stream::mesh);
    Spectrum sum;
    for (int i = 0; i < 2 * steps; ++i)
        for (int k = 0; k < steps; ++k) {
            const double u = random.uniform(), v = random.uniform();
            const Vec3 r = Point{1 + (i + u) / steps, y, 1 + (k + v) / steps} - x, w = normalized(r);
            const double kernel = dot(n, w) * w.y / (pi * squared_norm(r) * steps * steps);
            if (kernel > 0 && !is_hidden(scene, x, w))
                sum += kernel * (scene.distant().radiosity(w, false) * pane.transmission(w.y));
        }
    return sum;
}

}  // namespace

/// About a thousand of 400 x 200 cells are on the edge of a shadow and either lit or not: this causes an error of 2e-4
/// of a window's light.
TEST(WindowSky, WhatStandsOutdoorsIsCutFromTheSky) {
    struct Case {
        double depth, beyond;
        bool cut, outdoors;
    };
    for (const Case& c : {Case{0, 0.25, true, true}, Case{0.3, 0, true, true}, Case{0.1, 0.2, false, true},
                          Case{0.15, 0.15, true, false}}) {
        SCOPED_TRACE(c.depth);
        Room room;
        room.set_back(c.depth, c.beyond, c.cut);
        room.shell(c.depth + c.beyond);
        if (c.outdoors) room.outdoors();
        const Scene scene = room.scene();
        const Stage stage(scene);
        const Enclosure& enclosure = stage.occluders.enclosure();
        DirectLight::Workspace workspace;
        ReceiverLight light, nearer;
        for (const RegionId own : {RegionId(0), RegionId(1), RegionId(2), RegionId(3)}) {
            ASSERT_TRUE(enclosure.holds(own));
            const Plane& plane = scene.regions()[own].plane;
            for (Point x : {Point{1, 1, 1}, Point{2, 2.8, 0.3}, Point{3.7, 0.4, 2.2}, Point{1.7, 1.9, 1.3}}) {
                x = x - plane.signed_distance(x) * plane.n;
                const Spectrum exact = sum_over_pane(scene, x, plane.n, 200),
                               E = stage.direct.irradiance(x, plane.n, own, workspace);
                stage.direct.prepare(scene.regions()[own].loops[0], plane.n, own, light, workspace);
                const Spectrum prepared = stage.direct.irradiance(light, x, workspace);
                const Frame frame(plane.n);
                const std::vector<Point> around{x + 0.1 * frame.u, x + 0.1 * frame.v, x - 0.1 * (frame.u + frame.v)};
                stage.direct.prepare(around, light, nearer, workspace);
                EXPECT_NEAR(stage.direct.irradiance(nearer, x, workspace)[0], E[0], 1e-9 + 1e-6 * E[0]);
                for (std::size_t b = 0; b < bands; ++b) {
                    EXPECT_NEAR(E[b], exact[b], 1.5e-3 * exact[b] + 1e-3) << own.value << " " << x.x << " " << b;
                    EXPECT_NEAR(prepared[b], E[b], 1e-9 + 1e-6 * E[b]) << own.value << " " << x.x << " " << b;
                }
            }
        }
    }
}

/// Light at places of all regions, exactly, for whole polygons, and by rays, against a sum over 400 x 200 parts of the
/// window. Its error comes from the parts on the border of a pane, as above.
TEST(WindowSky, PassesTheOtherPanes) {
    for (const MorePanes& more : more_panes) {
        SCOPED_TRACE(more.name);
        Room room;
        more.add(room);
        const Scene scene = room.scene();
        const Stage stage(scene);
        const Enclosure& enclosure = stage.occluders.enclosure();
        ASSERT_EQ(enclosure.windows.size(), 1u);
        const Pane& window = enclosure.windows[0];
        const double y_window = window.corners[0].y;
        DirectLight::Workspace workspace;
        PlaceLight::Workspace place;
        ReceiverLight light;
        Spectrum lit;
        for (const RegionId own : scene.regions().ids()) {
            if (!enclosure.holds(own)) continue;
            const Region& region = scene.regions()[own];
            const Normal& n = region.plane.n;
            const Point x = 0.3 * (region.loops[0][0] - Point()) + 0.6 * (region.loops[0][1] - Point()) +
                            0.1 * (region.loops[0][2] - Point()) + Point();
            constexpr double too_near = 0.1;  // m, from 20 parts of the window: the sum is not accurate there
            if (std::abs(x.y - y_window) < too_near && std::abs(n.y) < 0.5) continue;
            constexpr int steps = 200;
            RandomStream random(1, Stream::mesh);
            Spectrum sum;
            for (int i = 0; i < 2 * steps; ++i)
                for (int k = 0; k < steps; ++k) {
                    const double u = random.uniform(), v = random.uniform();
                    const Vec3 r = Point{1 + (i + u) / steps, y_window, 1 + (k + v) / steps} - x, w = normalized(r);
                    const double kernel = dot(n, w) * w.y / (pi * squared_norm(r) * steps * steps);
                    if (!(kernel > 0) || is_hidden(scene, x, w)) continue;
                    const Spectrum through =
                        window.transmission(w.y) * transmission_between(enclosure.others, x, x + 2 * scene.size() * w);
                    sum += kernel * (scene.distant().radiosity(w, false) * through);
                }
            const Spectrum E = stage.direct.irradiance(x, n, own, workspace);
            stage.direct.prepare(region.loops[0], n, own, light, workspace);
            const Spectrum prepared = stage.direct.irradiance(light, x, workspace);
            const PlaceLight::Estimate by_rays = stage.place_light.rays().at(x, n, own, {.relative = 2e-3}, place);
            const double error = 4 * std::sqrt(by_rays.variance);
            for (std::size_t b = 0; b < bands; ++b) {
                EXPECT_NEAR(E[b], sum[b], 2e-3 * sum[b] + 1e-3) << own.value << " " << b;
                EXPECT_NEAR(prepared[b], E[b], 1e-9 + 1e-6 * E[b]) << own.value << " " << b;
                EXPECT_NEAR(by_rays.irradiance[b], E[b], error + 3e-3 * E[b] + 1e-3) << own.value << " " << b;
            }
            lit += E;
        }
        EXPECT_GT(mean(lit), 1);
    }
}

/// Sky behind a pavilion with coloured glass on two sides, which is seen through a coloured window.
TEST(WindowSky, HasTheColoursOfAllWindowsThatLightCrosses) {
    Room room;
    const Point lo{-4, 5, -6}, hi{8, 8, 9};
    room.face({{lo.x, lo.y, lo.z}, {hi.x, lo.y, lo.z}, {hi.x, hi.y, lo.z}, {lo.x, hi.y, lo.z}});
    room.face({{lo.x, lo.y, hi.z}, {lo.x, hi.y, hi.z}, {hi.x, hi.y, hi.z}, {hi.x, lo.y, hi.z}});
    room.face({{lo.x, lo.y, lo.z}, {lo.x, hi.y, lo.z}, {lo.x, hi.y, hi.z}, {lo.x, lo.y, hi.z}});
    room.face({{hi.x, lo.y, lo.z}, {hi.x, lo.y, hi.z}, {hi.x, hi.y, hi.z}, {hi.x, hi.y, lo.z}});
    test::add_pane(room, {{lo.x, lo.y, lo.z}, {lo.x, lo.y, hi.z}, {hi.x, lo.y, hi.z}, {hi.x, lo.y, lo.z}});
    test::add_pane(room, {{lo.x, hi.y, lo.z}, {hi.x, hi.y, lo.z}, {hi.x, hi.y, hi.z}, {lo.x, hi.y, hi.z}});
    const Scene scene = room.scene();
    const Stage stage(scene);
    PlaceLight::Workspace place;
    for (const RegionId own : {RegionId(0), RegionId(1), RegionId(2)}) {
        SCOPED_TRACE(own.value);
        const Region& region = scene.regions()[own];
        const Normal& n = region.plane.n;
        const Point x = region.loops[0][0] + 0.3 * (region.loops[0][1] - region.loops[0][0]) +
                        0.4 * (region.loops[0][3] - region.loops[0][0]);
        constexpr int steps = 200;
        RandomStream random(1, Stream::mesh);
        Spectrum sum, behind_three;
        for (int i = 0; i < 2 * steps; ++i)
            for (int k = 0; k < steps; ++k) {
                const double u = random.uniform(), v = random.uniform();
                const Vec3 r = Point{1 + (i + u) / steps, 3, 1 + (k + v) / steps} - x, w = normalized(r);
                const double kernel = dot(n, w) * w.y / (pi * squared_norm(r) * steps * steps);
                if (!(kernel > 0) || is_hidden(scene, x, w)) continue;
                const Point end = x + 2 * scene.size() * w;
                const Spectrum light =
                    kernel * (scene.distant().radiosity(w, false) * transmission_between(scene.panes(), x, end));
                sum += light;
                const auto is_crossed = [&](const Pane& pane) { return crosses(pane, x, end); };
                if (std::all_of(scene.panes().begin(), scene.panes().end(), is_crossed)) behind_three += light;
            }
        EXPECT_GT(mean(behind_three), 0.2 * mean(sum));
        const Spectrum E = stage.direct.irradiance(x, n, own, place.exact);
        const PlaceLight::Estimate by_rays = stage.place_light.rays().at(x, n, own, {.relative = 2e-3}, place);
        const double error = 4 * std::sqrt(by_rays.variance);
        for (std::size_t b = 0; b < bands; ++b) {
            EXPECT_NEAR(E[b], sum[b], 2e-3 * sum[b] + 1e-3) << b;
            EXPECT_NEAR(by_rays.irradiance[b], E[b], error + 3e-3 * E[b] + 1e-3) << b;
        }
    }
}

}  // namespace exitance
