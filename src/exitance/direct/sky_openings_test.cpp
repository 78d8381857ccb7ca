// Openings through which rooms see the sky, and light by rays through them.
#include "exitance/direct/sky_openings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "exitance/base/random.hpp"
#include "exitance/error/area_samples.hpp"
#include "exitance/scene/locator.hpp"
#include "exitance/scene/sky/sun_position.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "exitance/transport/stage.hpp"
#include "support/checked_scene.hpp"

namespace exitance {
namespace {

/// Places a scene: scaled, then turned about the vertical, then moved.
struct Placing {
    double scale = 1, turn = 0;
    Vec3 move = {};

    Point operator()(const Point& p) const {
        const double c = std::cos(turn), s = std::sin(turn);
        return scale * Vec3{c * p.x - s * p.y, s * p.x + c * p.y, p.z} + move;
    }
};

/// Rooms of 4 x 5 x 3 m in a row along x, each with a window in the wall at y = 0 and with boxes on the floor.
struct Rooms {
    int count = 1, boxes = 40;
    double left = 1.9, right = 2.2, sill = 1.5, top = 1.8;  ///< Borders of each window, metres.
    double ground = 0;                                      ///< Half of the side of a ground outdoors, metres; 0: none.
    Placing placing = {};
    DistantLight light = {};

    Scene make() const {
        SceneDescription d;
        d.file = "rooms.obj";
        d.materials = {{"grey", Spectrum(0.5), {}}};
        d.groups = {"all"};
        const auto face = [&](const std::vector<Point>& corners) { add_polygon(d, corners, placing); };
        const auto sheet = [&](const std::vector<Point>& corners) {  // a wall with two sides
            face(corners);
            face({corners.rbegin(), corners.rend()});
        };
        for (int i = 0; i < count; ++i) {
            const double x0 = 4.0 * i, x1 = x0 + 4;
            face({{x0, 0, 0}, {x1, 0, 0}, {x1, 5, 0}, {x0, 5, 0}});
            sheet({{x0, 0, 3}, {x0, 5, 3}, {x1, 5, 3}, {x1, 0, 3}});
            sheet({{x0, 5, 0}, {x1, 5, 0}, {x1, 5, 3}, {x0, 5, 3}});
            if (i == 0) sheet({{x0, 0, 0}, {x0, 5, 0}, {x0, 5, 3}, {x0, 0, 3}});
            sheet({{x1, 0, 0}, {x1, 0, 3}, {x1, 5, 3}, {x1, 5, 0}});
            const double a = x0 + left, b = x0 + right;
            sheet({{x0, 0, 0}, {x0, 0, 3}, {a, 0, 3}, {a, 0, 0}});
            sheet({{b, 0, 0}, {b, 0, 3}, {x1, 0, 3}, {x1, 0, 0}});
            sheet({{a, 0, 0}, {a, 0, sill}, {b, 0, sill}, {b, 0, 0}});
            if (top < 3) sheet({{a, 0, top}, {a, 0, 3}, {b, 0, 3}, {b, 0, top}});
            RandomStream random(1, Stream::mesh, static_cast<std::uint64_t>(i));
            for (int k = 0; k < boxes; ++k) {
                const double u = x0 + 0.3 + 3.2 * random.uniform(), v = 0.5 + 4.2 * random.uniform();
                const double s = 0.05 + 0.1 * random.uniform(), h = 0.02 + 1.2 * random.uniform();
                face({{u, v, h}, {u + s, v, h}, {u + s, v + s, h}, {u, v + s, h}});
                face({{u, v, 0}, {u + s, v, 0}, {u + s, v, h}, {u, v, h}});
                face({{u + s, v, 0}, {u + s, v + s, 0}, {u + s, v + s, h}, {u + s, v, h}});
                face({{u + s, v + s, 0}, {u, v + s, 0}, {u, v + s, h}, {u + s, v + s, h}});
                face({{u, v + s, 0}, {u, v, 0}, {u, v, h}, {u, v + s, h}});
            }
        }
        if (ground > 0)
            face({{-ground, -ground, -0.05},
                  {ground, -ground, -0.05},
                  {ground, ground, -0.05},
                  {-ground, ground, -0.05}});
        d.distant = light;
        return checked_scene(std::move(d));
    }
};

DistantLight overcast() {
    SkyModel sky = overcast_sky();
    EXPECT_TRUE(sky.normalize());
    return {{{sky, Spectrum(100.0)}}, {}};
}

SkyOpenings openings_of(const Stage& stage, const DistantLight& light) {
    return SkyOpenings(stage.occluders, stage.tracer, SkyTree(light), {});
}

/// Share of a grid of points of a window through which a line leads to a parallelogram that covers them.
double covered_share(const Rooms& rooms, int room, std::span<const PortalCell> cells) {
    constexpr int steps = 20;
    int covered = 0;
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
            const Point p = rooms.placing({4.0 * room + rooms.left + (rooms.right - rooms.left) * (i + 0.5) / steps, 0,
                                           rooms.sill + (rooms.top - rooms.sill) * (k + 0.5) / steps});
            covered += std::any_of(cells.begin(), cells.end(), [&](const PortalCell& cell) {
                const Vec3 at = p - cell.corner;
                const double s = dot(at, cell.u) / squared_norm(cell.u), t = dot(at, cell.v) / squared_norm(cell.v);
                return s >= 0 && s <= 1 && t >= 0 && t <= 1 && std::abs(dot(at, cell.n)) < 0.05 * std::sqrt(cell.area);
            });
        }
    return static_cast<double>(covered) / (steps * steps);
}

double area_of(std::span<const PortalCell> cells) {
    double out = 0;
    for (const PortalCell& cell : cells) out += cell.area;
    return out;
}

TEST(SkyOpenings, AWindowIsCoveredWhereverTheRoomStands) {
    const std::vector<Placing> placings = {{},
                                           {.turn = 0.7},
                                           {.move = {1000, -1000, 300}},
                                           {.scale = 1e-3},
                                           {.scale = 1e-3, .turn = 2, .move = {1, 1, 1}}};
    for (const Placing& placing : placings) {
        const Rooms rooms{.placing = placing, .light = overcast()};
        const Scene scene = rooms.make();
        const SkyOpenings openings = openings_of(Stage(scene), rooms.light);
        const double window = 0.09 * placing.scale * placing.scale;
        EXPECT_EQ(covered_share(rooms, 0, openings.cells()), 1) << placing.scale << ", " << placing.turn;
        EXPECT_NEAR(area_of(openings.cells()) / window, 1.06 * 1.06, 0.05);  // the cells have a margin of 3% per side
        for (const PortalCell& cell : openings.cells())
            EXPECT_GT(dot(cell.n, rooms.placing({2, -1, 0}) - rooms.placing({2, 0, 0})), 0) << "points indoors";
    }
}

TEST(SkyOpenings, WindowsOfSeveralRoomsAboveAGroundAreCovered) {
    const Rooms rooms{
        .count = 4, .boxes = 10, .left = 1, .right = 3, .sill = 1, .top = 2, .ground = 500, .light = overcast()};
    const Scene scene = rooms.make();
    const SkyOpenings openings = openings_of(Stage(scene), rooms.light);
    for (int room = 0; room < 4; ++room) EXPECT_GT(covered_share(rooms, room, openings.cells()), 0.95) << room;
}

TEST(SkyOpenings, ASlitIsCoveredAsAWhole) {
    const Rooms rooms{.left = 0.1, .right = 3.9, .sill = 2.9, .top = 2.95, .light = overcast()};
    const Scene scene = rooms.make();
    const SkyOpenings openings = openings_of(Stage(scene), rooms.light);
    EXPECT_GT(covered_share(rooms, 0, openings.cells()), 0.99);
    EXPECT_LE(openings.cells().size(), 32u);
}

TEST(SkyOpenings, NoneAreFoundInTheOpen) {
    Rooms rooms{.count = 0, .ground = 10, .light = overcast()};
    const Scene scene = rooms.make();
    const SkyOpenings openings = openings_of(Stage(scene), rooms.light);
    EXPECT_TRUE(openings.cells().empty());
    for (const std::uint32_t n : {4u, 64u, 1024u}) EXPECT_EQ(openings.hidden_sky(0, n), 1.0 / n);
}

TEST(SkyOpenings, RaysIndoorsMissLessThanOneRayShows) {
    const Rooms closed{.light = overcast()};
    const Scene indoors = closed.make();
    const SkyOpenings openings = openings_of(Stage(indoors), closed.light);
    for (const std::uint32_t n : {4u, 64u, 1024u}) {
        const std::uint32_t part = openings.part_at({2, 2.5, 1});
        EXPECT_LT(openings.hidden_sky(part, n), 0.03 / n) << n;
        EXPECT_GT(openings.hidden_sky(part, n), 0) << n;
    }
}

TEST(SkyOpenings, RoomsAreInDifferentPartsOfTheScene) {
    const Rooms rooms{.count = 9, .boxes = 10, .left = 1.9, .right = 2.2, .light = overcast()};
    const Scene scene = rooms.make();
    const SkyOpenings openings = openings_of(Stage(scene), rooms.light);
    std::set<std::uint32_t> parts;
    for (int room = 0; room < 9; ++room) parts.insert(openings.part_at({4.0 * room + 2, 2.5, 1}));
    EXPECT_EQ(parts.size(), 9u);
}

TEST(SkyOpenings, RaysAreNotAimedAtTheWindowsOfFarRooms) {
    for (const Placing& placing : {Placing(), Placing{.turn = 0.7, .move = {100, -100, 30}}, Placing{.scale = 1e-2}}) {
        const Rooms rooms{.count = 6,
                          .boxes = 5,
                          .left = 1,
                          .right = 3,
                          .sill = 1,
                          .top = 2,
                          .placing = placing,
                          .light = overcast()};
        const Scene scene = rooms.make();
        const SkyOpenings openings = openings_of(Stage(scene), rooms.light);
        const Normal to_windows = normalized(rooms.placing({0, -1, 0}) - rooms.placing({0, 0, 0}));
        for (int room = 0; room < 6; ++room) {
            std::vector<PortalCell> cells;
            const double left_out = openings.choose(rooms.placing({4.0 * room + 2, 4.9, 1}), to_windows, cells);
            EXPECT_LT(left_out, 1e-9) << room;
            EXPECT_GT(covered_share(rooms, room, cells), 0.95) << room;
            EXPECT_EQ(covered_share(rooms, (room + 3) % 6, cells), 0) << room;  // next rooms may share a part
        }
    }
}

TEST(RayLight, LightThroughAWindowIsUnbiasedAndItsVarianceIsKnown) {
    const Normal towards = sky_direction(40, 180);
    DistantLight light = overcast();
    light.discs.push_back({towards, sun_half_angle, Spectrum(500.0)});
    for (const int trial : {0, 1, 2}) {
        const bool has_ground = trial == 1;
        Rooms rooms{.ground = has_ground ? 100.0 : 0.0, .light = light};
        if (trial == 2) {  // A slit, without the sun: its penumbrae would need more rays than the maximum.
            rooms.left = 0.1, rooms.right = 3.9, rooms.sill = 2.9, rooms.top = 2.95;
            rooms.light = overcast();
        }
        const Scene scene = rooms.make();
        const Stage stage(scene);
        PlaceLight::Workspace room;
        const Locator locator(scene);
        double bias = 0, squares = 0, variance = 0, exact = 0, rays = 0, count = 0;
        for (const ProbePoint& p : points_uniform_in_area(scene, has_ground ? 300000 : 3000, 5)) {
            const SurfaceId surface = locator.find(p.x, p.n);
            const bool is_inside = p.x.y > 0.001 && p.x.y < 4.999 && p.x.x > 0.001 && p.x.x < 3.999 && p.x.z > -0.001;
            if (surface.is_none() || !is_inside || p.x.z > 2.999) continue;
            const RegionId region = scene.surfaces()[surface].region;
            const double E = mean(stage.direct.irradiance(p.x, p.n, region, room.exact));
            const RayLight::Estimate found = stage.place_light.rays().at(p.x, p.n, region, {.absolute = 0.02}, room);
            const double error = mean(found.irradiance) - E;
            bias += error, squares += error * error, variance += found.variance, exact += E;
            rays += static_cast<double>(found.rays), ++count;
        }
        ASSERT_GT(count, 200);
        EXPECT_LT(std::abs(bias), 3 * std::sqrt(variance) + 2e-3 * exact) << trial;
        EXPECT_LT(squares, 1.5 * variance) << trial;
        EXPECT_LT(variance / count, 0.02 * 0.02) << trial;
        EXPECT_LT(rays / count, 1500) << trial;  // unaimed: the most that are allowed, 8192
    }
}

TEST(RayLight, LightBesideALargeWindowIsNotMissed) {
    // Rays are not aimed at a window that is nearer than its length, unless it is cut into parts.
    for (const Placing& placing : {Placing(), Placing{.turn = 0.7, .move = {100, -100, 30}}, Placing{.scale = 1e-2}}) {
        const Rooms rooms{.boxes = 10,
                          .left = 0.5,
                          .right = 3.5,
                          .sill = 0.9,
                          .top = 2.1,
                          .ground = placing.scale * 30,
                          .placing = placing,
                          .light = overcast()};
        const Scene scene = rooms.make();
        const Stage stage(scene);
        PlaceLight::Workspace room;
        const Locator locator(scene);
        const Normal up{0, 0, 1};
        double bias = 0, squares = 0, variance = 0, exact = 0;
        int count = 0, missed = 0;
        for (int i = 0; i < 20; ++i)
            for (int k = 0; k < 20; ++k) {
                const Point x = rooms.placing({4 * (i + 0.5) / 20, 0.1 + 1.9 * (k + 0.5) / 20, 0});
                const SurfaceId surface = locator.find(x, up);
                ASSERT_FALSE(surface.is_none());
                const RegionId region = scene.surfaces()[surface].region;
                const double E = mean(stage.direct.irradiance(x, up, region, room.exact));
                const RayLight::Estimate found = stage.place_light.rays().at(x, up, region, {.relative = 0.05}, room);
                const double error = mean(found.irradiance) - E;
                bias += error, squares += error * error, variance += found.variance, exact += E;
                missed += mean(found.irradiance) < 0.5 * E, ++count;
            }
        EXPECT_LT(std::abs(bias), 3 * std::sqrt(variance) + 2e-3 * exact);
        EXPECT_LT(squares, 1.5 * variance);
        EXPECT_LE(missed, count / 200);
    }
}

TEST(RayLight, PlacesOfAnElementAreNotTooDarkWhereFewRaysFindAWindow) {
    for (const Placing& placing : {Placing(), Placing{.turn = 0.7, .move = {100, -100, 30}}, Placing{.scale = 1e-2}}) {
        const Rooms rooms{.boxes = 10,
                          .left = 0.2,
                          .right = 3.8,
                          .sill = 0.1,
                          .top = 2.9,
                          .ground = placing.scale * 30,
                          .placing = placing,
                          .light = overcast()};
        const Scene scene = rooms.make();
        const Stage stage(scene);
        const RayLight& rays = stage.place_light.rays();
        PlaceLight::Workspace room;
        const Normal up{0, 0, 1};
        const RegionId region = scene.surfaces()[Locator(scene).find(rooms.placing({2, 2.5, 0}), up)].region;
        constexpr LightAccuracy rough{.absolute = 4};
        double exact = 0, together = 0, variance = 0, alone = 0;
        constexpr int elements = 12, places_across = 3;
        for (int e = 0; e < elements * elements; ++e) {
            std::vector<Point> places;
            for (int k = 0; k < places_across * places_across; ++k) {
                const double u = e % elements + (k % places_across + 0.5) / places_across;
                const double v = e / elements + (k / places_across + 0.5) / places_across;
                places.push_back(rooms.placing({4 * u / elements, 5 * v / elements, 0}));
            }
            const RayLight::Spreads known = rays.spreads(places, up, region, rough, room);
            for (const Point& x : places) {
                exact += mean(stage.direct.irradiance(x, up, region, room.exact));
                const RayLight::Estimate found = rays.at(x, up, region, rough, room, &known);
                together += mean(found.irradiance), variance += found.variance;
                alone += mean(rays.at(x, up, region, rough, room).irradiance);
            }
        }
        EXPECT_LT(std::abs(together - exact), 3 * std::sqrt(variance) + 2e-3 * exact);
        EXPECT_LT(std::sqrt(variance), 0.03 * exact) << "too noisy to find a bias";
        EXPECT_LT(alone, 0.99 * exact) << "rays that decide their own number are too dark here";
    }
}

TEST(DirectProjection, UsesRaysBetweenManySurfacesBelowASky) {
    // Fewer elements than the projection counts as many.
    const Rooms rooms{.count = 1, .boxes = 80, .left = 0.5, .right = 3.5, .sill = 0.5, .top = 2.5, .light = overcast()};
    const Scene scene = rooms.make();
    const Stage stage(scene);
    const DirectProjection direct =
        project_direct_light(stage, {.mesh = {.edge = 4, .grading_levels = 0}, .tolerance = 0.3}, StopRequest());
    const std::vector<ElementId> leaves = direct.tree.leaves();
    EXPECT_LT(leaves.size(), 2000u);
    const auto by_rays =
        std::count_if(leaves.begin(), leaves.end(), [&](ElementId e) { return direct.fit[e].noise_squared > 0; });
    EXPECT_GT(4 * static_cast<std::size_t>(by_rays), leaves.size());
}

}  // namespace
}  // namespace exitance
