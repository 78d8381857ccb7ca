#include "exitance/scene/enclosure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/window_room.hpp"

namespace exitance {
namespace {

using Room = test::WindowRoom;
using test::add_pane, test::more_panes, test::MorePanes;

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

}  // namespace exitance
