#include "exitance/scene/enclosure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/scene/sky/sun_position.hpp"
#include "exitance/transport/stage.hpp"
#include "exitance/visibility/glazed_part.hpp"

namespace exitance {
namespace {

/// A room of 4 x 3 x 2.5 m with a glass window of 2 x 1 m in the wall y = 3, under a sky.
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
    /// Moves the pane `depth` behind the inner wall. The reveals extend `beyond` farther and are split at the pane if
    /// `cut`.
    void set_back(double depth, double beyond, bool cut) {
        for (Point& p : d.panes[0].corners) p.y = 3 + depth;
        if (cut) reveals(3, 3 + depth), reveals(3 + depth, 3 + depth + beyond);
        if (!cut) reveals(3, 3 + depth + beyond);
    }
    void reveals(double from, double to) {
        if (!(to > from)) return;
        face({{1, from, 1}, {3, from, 1}, {3, to, 1}, {1, to, 1}});
        face({{1, from, 2}, {1, to, 2}, {3, to, 2}, {3, from, 2}});
        face({{1, from, 1}, {1, to, 1}, {1, to, 2}, {1, from, 2}});
        face({{3, from, 1}, {3, from, 2}, {3, to, 2}, {3, to, 1}});
    }
    /// Adds outer walls, floor and roof around the room, at a distance of `thick`, with the window's opening.
    void shell(double thick) {
        const double a = -thick, x = 4 + thick, y = 3 + thick, z = 2.5 + thick;
        face({{a, a, a}, {a, y, a}, {x, y, a}, {x, a, a}});
        face({{a, a, z}, {x, a, z}, {x, y, z}, {a, y, z}});
        face({{a, a, a}, {x, a, a}, {x, a, z}, {a, a, z}});
        face({{a, a, a}, {a, a, z}, {a, y, z}, {a, y, a}});
        face({{x, a, a}, {x, y, a}, {x, y, z}, {x, a, z}});
        face({{a, y, a}, {a, y, 1}, {1, y, 1}, {3, y, 1}, {x, y, 1}, {x, y, a}});
        face({{a, y, 2}, {a, y, z}, {x, y, z}, {x, y, 2}, {3, y, 2}, {1, y, 2}});
        face({{a, y, 1}, {a, y, 2}, {1, y, 2}, {1, y, 1}});
        face({{3, y, 1}, {3, y, 2}, {x, y, 2}, {x, y, 1}});
    }
    /// Adds a lawn and a house across the street.
    void outdoors() {
        face({{-20, 3.4, -0.5}, {20, 3.4, -0.5}, {20, 30, -0.5}, {-20, 30, -0.5}});
        face({{1, 9, -0.5}, {8, 9, -0.5}, {8, 9, 4}, {1, 9, 4}});
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

TEST(Enclosure, AllSurfacesOfARoomAreInside) {
    Room room;
    EXPECT_EQ(held(room.scene()), room.scene().regions().size());
    const Enclosure enclosure = find_enclosure(room.scene());
    ASSERT_EQ(enclosure.windows.size(), 1u);
    EXPECT_NEAR(enclosure.windows[0].n.y, -1, 1e-12) << "inwards";
    std::reverse(room.d.panes[0].corners.begin(), room.d.panes[0].corners.end());
    EXPECT_NEAR(find_enclosure(room.scene()).windows.at(0).n.y, -1, 1e-12);
}

TEST(Enclosure, FurnitureAndPartitionsAreInside) {
    Room room;
    room.face({{1, 1, 0.7}, {2, 1, 0.7}, {2, 2, 0.7}, {1, 2, 0.7}});
    room.face({{2, 0, 0}, {2, 2, 0}, {2, 2, 2.5}, {2, 0, 2.5}});
    EXPECT_EQ(held(room.scene()), room.scene().regions().size());
}

/// Adds the back of every face, as in formats whose faces reflect on both sides.
void add_backs(Room& room) {
    const std::vector<SceneDescription::Face> faces = room.d.faces;
    for (SceneDescription::Face f : faces) {
        std::reverse(f.corners.begin(), f.corners.end());
        room.d.faces.push_back(std::move(f));
    }
}

TEST(Enclosure, FacesMayHaveLightOnBothSides) {
    Room room;
    const std::size_t indoors = room.scene().regions().size();
    add_backs(room);
    EXPECT_EQ(held(room.scene()), indoors) << "their backs are outside";
    EXPECT_NEAR(find_enclosure(room.scene()).windows.at(0).n.y, -1, 1e-12) << "inwards";
    Room shaded;
    shaded.face({{0, 3, 2.5}, {0, 4, 2.5}, {4, 4, 2.5}, {4, 3, 2.5}});
    add_backs(shaded);
    EXPECT_EQ(held(shaded.scene()), indoors - 1) << "but for the ceiling, of which a part is a roof that juts out";
    Room open;
    open.d.faces.erase(open.d.faces.begin() + 3);
    add_backs(open);
    EXPECT_EQ(held(open.scene()), 0u) << "without a wall";
}

TEST(Enclosure, RoomsMayShareAWallOfOneFaceWithTwoSides) {
    Room rooms;
    const std::vector<SceneDescription::Face> faces = rooms.d.faces;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (i == 3) continue;  // omit the wall at x = 0: the other room's wall replaces it
        std::vector<Point> corners;
        for (const std::uint32_t c : faces[i].corners) corners.push_back(rooms.d.points[c] + Vec3{4, 0, 0});
        rooms.face(corners);
    }
    Pane other = rooms.d.panes[0];
    for (Point& p : other.corners) p.x += 4;
    rooms.d.panes.push_back(other);
    const std::size_t before = rooms.scene().regions().size();
    add_backs(rooms);
    EXPECT_EQ(held(rooms.scene()), before + 1) << "and the back of the wall between";
}

TEST(Enclosure, OpenRoomsAndRecessedPanesHaveNone) {
    Room gap;
    for (Point& p : gap.d.points)
        if (p.z == 2.5 && p.y == 0) p.z = 2.4;
    gap.d.faces.erase(gap.d.faces.begin() + 3);  // removes a wall
    EXPECT_EQ(held(gap.scene()), 0u);
    Room recessed;
    for (Point& p : recessed.d.panes[0].corners) p.y = 2.9;
    EXPECT_EQ(held(recessed.scene()), 0u);
}

TEST(Enclosure, PanesInRevealsCloseTheRoom) {
    Room flush;
    const std::size_t indoors = flush.scene().regions().size();
    flush.reveals(3, 3.3), flush.shell(0.3);
    EXPECT_EQ(held(flush.scene()), indoors) << "at the inner edge of a thick wall";
    Room outer;
    outer.set_back(0.3, 0, true), outer.shell(0.3);
    EXPECT_EQ(held(outer.scene()), indoors + 4) << "at its outer edge";
    Room thin;
    thin.set_back(0.2, 0, true);
    EXPECT_EQ(held(thin.scene()), indoors + 4) << "of walls without an outside";
    Room within;
    within.set_back(0.1, 0.2, false), within.shell(0.3);
    EXPECT_EQ(held(within.scene()), indoors) << "across reveals, of which a part lies outside";
    for (Room* room : {&flush, &outer, &within}) {
        std::reverse(room->d.panes[0].corners.begin(), room->d.panes[0].corners.end());
        EXPECT_NEAR(find_enclosure(room->scene()).windows.at(0).n.y, -1, 1e-12) << "inwards";
    }
    within.outdoors();
    EXPECT_EQ(held(within.scene()), indoors) << "a lawn and a house are outside";
}

TEST(Enclosure, WindowsThatFaceEachOtherHaveNone) {
    Room room;
    Pane other = room.d.panes[0];
    other.corners = {{3, 8, 1}, {1, 8, 1}, {1, 8, 2}, {3, 8, 2}};
    EXPECT_EQ(held(room.scene()), room.scene().regions().size());
    // Adds a rotated copy of the room across a courtyard.
    const std::vector<SceneDescription::Face> faces = room.d.faces;
    for (const SceneDescription::Face& f : faces) {
        std::vector<Point> corners;
        for (const std::uint32_t c : f.corners)
            corners.push_back({4 - room.d.points[c].x, 11 - room.d.points[c].y, room.d.points[c].z});
        room.face(corners);
    }
    room.d.panes.push_back(other);
    EXPECT_EQ(held(room.scene()), 0u) << "a way may lead in again";
}

namespace {

/// Adds a pane of clear glass that is darker in one band than in the others.
void add_pane(Room& room, std::vector<Point> corners) {
    Pane pane;
    pane.corners = std::move(corners);
    for (std::size_t b = 0; b < bands; ++b) pane.transmissivity[b] = 0.5 + 0.2 * static_cast<double>(b);
    room.d.panes.push_back(pane);
}

/// Adds a second room of the same size at x > 4 without a window. The wall between has a pane of 1 x 1.5 m.
void add_room_behind_a_pane(Room& room) {
    room.d.faces.erase(room.d.faces.begin() + 4);  // the wall at x = 4
    const std::size_t first = room.d.faces.size();
    room.face({{4, 0, 0}, {4, 3, 0}, {4, 3, 0.5}, {4, 0, 0.5}});
    room.face({{4, 0, 2}, {4, 3, 2}, {4, 3, 2.5}, {4, 0, 2.5}});
    room.face({{4, 0, 0.5}, {4, 1, 0.5}, {4, 1, 2}, {4, 0, 2}});
    room.face({{4, 2, 0.5}, {4, 3, 0.5}, {4, 3, 2}, {4, 2, 2}});
    for (std::size_t i = first, end = room.d.faces.size(); i < end; ++i) {
        SceneDescription::Face back = room.d.faces[i];
        std::reverse(back.corners.begin(), back.corners.end());
        room.d.faces.push_back(std::move(back));
    }
    room.face({{4, 0, 0}, {8, 0, 0}, {8, 3, 0}, {4, 3, 0}});
    room.face({{4, 0, 2.5}, {4, 3, 2.5}, {8, 3, 2.5}, {8, 0, 2.5}});
    room.face({{4, 0, 0}, {4, 0, 2.5}, {8, 0, 2.5}, {8, 0, 0}});
    room.face({{4, 3, 0}, {8, 3, 0}, {8, 3, 2.5}, {4, 3, 2.5}});
    room.face({{8, 0, 0}, {8, 0, 2.5}, {8, 3, 2.5}, {8, 3, 0}});
    add_pane(room, {{4, 1, 0.5}, {4, 2, 0.5}, {4, 2, 2}, {4, 1, 2}});
}

/// Adds a box of glass over a block that stands free in the room.
void add_glass_case(Room& room) {
    const Point lo{1, 1, 0.5}, hi{2, 2, 1.5};
    add_pane(room, {{lo.x, lo.y, lo.z}, {lo.x, hi.y, lo.z}, {hi.x, hi.y, lo.z}, {hi.x, lo.y, lo.z}});
    add_pane(room, {{lo.x, lo.y, hi.z}, {hi.x, lo.y, hi.z}, {hi.x, hi.y, hi.z}, {lo.x, hi.y, hi.z}});
    add_pane(room, {{lo.x, lo.y, lo.z}, {hi.x, lo.y, lo.z}, {hi.x, lo.y, hi.z}, {lo.x, lo.y, hi.z}});
    add_pane(room, {{hi.x, hi.y, lo.z}, {lo.x, hi.y, lo.z}, {lo.x, hi.y, hi.z}, {hi.x, hi.y, hi.z}});
    add_pane(room, {{lo.x, hi.y, lo.z}, {lo.x, lo.y, lo.z}, {lo.x, lo.y, hi.z}, {lo.x, hi.y, hi.z}});
    add_pane(room, {{hi.x, lo.y, lo.z}, {hi.x, hi.y, lo.z}, {hi.x, hi.y, hi.z}, {hi.x, lo.y, hi.z}});
    room.face({{1.2, 1.2, 0.7}, {1.8, 1.2, 0.7}, {1.8, 1.8, 0.7}, {1.2, 1.8, 0.7}});
}

/// A case of panes besides the window, and the number of them.
struct MorePanes {
    const char* name;
    std::size_t others;
    void (*add)(Room&);
};
const MorePanes more_panes[] = {
    {"between two rooms", 1, add_room_behind_a_pane},
    {"a table", 1,
     [](Room& room) {
         add_pane(room, {{1, 1, 0.7}, {3, 1, 0.7}, {3, 2, 0.7}, {1, 2, 0.7}});
     }},
    {"an oblique pane", 1,
     [](Room& room) {
         add_pane(room, {{0.5, 1, 0.2}, {3.5, 2, 0.2}, {3.5, 2.3, 2.2}, {0.5, 1.3, 2.2}});
     }},
    {"a second pane in front", 1,
     [](Room& room) {
         add_pane(room, {{1, 3.02, 1}, {3, 3.02, 1}, {3, 3.02, 2}, {1, 3.02, 2}});
     }},
    {"a railing outdoors", 1,
     [](Room& room) {
         add_pane(room, {{0, 4, 0}, {4, 4.8, 0}, {4, 4.8, 1.6}, {0, 4, 1.6}});
     }},
    {"a glass case", 6, add_glass_case},
    {"two panes in a reveal", 1,
     [](Room& room) {
         room.reveals(3, 3.02);
         add_pane(room, {{1, 3.02, 1}, {3, 3.02, 1}, {3, 3.02, 2}, {1, 3.02, 2}});
     }},
};

}  // namespace

TEST(Enclosure, OnlyPanesBetweenInsideAndOutsideAreWindows) {
    for (const MorePanes& more : more_panes) {
        SCOPED_TRACE(more.name);
        Room room;
        more.add(room);
        const Enclosure enclosure = find_enclosure(room.scene());
        ASSERT_EQ(enclosure.windows.size(), 1u);
        EXPECT_NEAR(enclosure.windows[0].n.y, -1, 1e-12) << "inwards";
        EXPECT_EQ(enclosure.others.size(), more.others);
        EXPECT_EQ(held(room.scene()), room.scene().regions().size());
    }
    Room railed;
    railed.d.panes.clear();
    add_pane(railed, {{0, 4, 0}, {4, 4, 0}, {4, 4, 1.6}, {0, 4, 1.6}});
    EXPECT_EQ(held(railed.scene()), 0u) << "without windows";
}

TEST(Enclosure, AFaceThatLeavesTheRoomIsNotInside) {
    Room room;
    room.face({{-1, 1, 0.7}, {2, 1, 0.7}, {2, 2, 0.7}, {-1, 2, 0.7}});
    const Scene scene = room.scene();
    EXPECT_EQ(held(scene), scene.regions().size() - 1);
}

TEST(Enclosure, TheSkyThroughItsWindowAgreesWithThePartsOfTheSky) {
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
TEST(Enclosure, WhatStandsOutdoorsIsCutFromTheSky) {
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
TEST(Enclosure, TheSkyThroughItsWindowPassesTheOtherPanes) {
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

}  // namespace exitance
