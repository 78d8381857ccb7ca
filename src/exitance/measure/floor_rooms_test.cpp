#include "exitance/measure/floor_rooms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/measure/glare/room_observers.hpp"
#include "exitance/measure/working_plane.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// Builds scenes of boxes, turned, moved and scaled.
class Builder {
  public:
    Builder(double degrees, Vec3 shift, double scale) : shift_(shift), scale_(scale) {
        const double a = degrees * pi / 180;
        x_ = {std::cos(a), std::sin(a), 0}, y_ = {-std::sin(a), std::cos(a), 0};
        d_.materials.push_back({"white", Spectrum(0.5), Spectrum(1)});
    }

    Point at(double x, double y, double z) const { return shift_ + scale_ * (x * x_ + y * y_ + Vec3{0, 0, z}); }

    void face(const std::vector<Vec3>& corners, const std::string& group) {
        SceneDescription::Face f;
        for (const Vec3& p : corners) {
            f.corners.push_back(static_cast<std::uint32_t>(d_.points.size()));
            d_.points.push_back(at(p.x, p.y, p.z));
        }
        f.group = static_cast<std::uint32_t>(d_.groups.size());
        d_.groups.push_back(group);
        d_.faces.push_back(f);
    }
    /// Four walls of a box, pointing inwards.
    void sides(Vec3 lo, Vec3 hi, const std::string& group) {
        face({{lo.x, lo.y, hi.z}, {hi.x, lo.y, hi.z}, {hi.x, lo.y, lo.z}, {lo.x, lo.y, lo.z}}, group);
        face({{hi.x, lo.y, hi.z}, {hi.x, hi.y, hi.z}, {hi.x, hi.y, lo.z}, {hi.x, lo.y, lo.z}}, group);
        face({{hi.x, hi.y, hi.z}, {lo.x, hi.y, hi.z}, {lo.x, hi.y, lo.z}, {hi.x, hi.y, lo.z}}, group);
        face({{lo.x, hi.y, hi.z}, {lo.x, lo.y, hi.z}, {lo.x, lo.y, lo.z}, {lo.x, hi.y, lo.z}}, group);
    }
    /// Four walls of a box and its top, pointing outwards; or `inwards`, with a floor.
    void box(Vec3 lo, Vec3 hi, const std::string& group, bool inwards = false) {
        const auto side = [&](std::vector<Vec3> p, const std::string& name) {
            if (inwards) std::reverse(p.begin(), p.end());
            face(p, name);
        };
        side({{lo.x, lo.y, lo.z}, {hi.x, lo.y, lo.z}, {hi.x, lo.y, hi.z}, {lo.x, lo.y, hi.z}}, group);
        side({{hi.x, lo.y, lo.z}, {hi.x, hi.y, lo.z}, {hi.x, hi.y, hi.z}, {hi.x, lo.y, hi.z}}, group);
        side({{hi.x, hi.y, lo.z}, {lo.x, hi.y, lo.z}, {lo.x, hi.y, hi.z}, {hi.x, hi.y, hi.z}}, group);
        side({{lo.x, hi.y, lo.z}, {lo.x, lo.y, lo.z}, {lo.x, lo.y, hi.z}, {lo.x, hi.y, hi.z}}, group);
        side({{lo.x, lo.y, hi.z}, {hi.x, lo.y, hi.z}, {hi.x, hi.y, hi.z}, {lo.x, hi.y, hi.z}}, group);
    }
    void floor(Vec3 lo, Vec3 hi, const std::string& group) {
        face({{lo.x, lo.y, lo.z}, {hi.x, lo.y, lo.z}, {hi.x, hi.y, lo.z}, {lo.x, hi.y, lo.z}}, group);
    }
    void pane(const std::vector<Vec3>& corners) {
        Pane pane;
        for (const Vec3& p : corners) pane.corners.push_back(at(p.x, p.y, p.z));
        pane.transmissivity = Spectrum(0.9);
        d_.panes.push_back(pane);
    }
    Scene scene() {
        CheckedScene checked = make_scene(std::move(d_));
        EXI_CHECK(static_cast<bool>(checked.scene));
        return std::move(*checked.scene);
    }

  private:
    SceneDescription d_;
    Vec3 shift_, x_, y_;
    double scale_;
};

/// A storey of 10 x 4 m and 2.7 m: a wall 0.2 m thick from x = 6 with a door of 0.9 x 2.1 m, a table, a bed, and a
/// cupboard.
void add_flat(Builder& b, double z) {
    b.box({0, 0, z}, {10, 4, z + 2.7}, "shell", true);
    b.floor({0, 0, z}, {6.1, 4, z}, "kitchen_floor");
    b.floor({6.1, 0, z}, {10, 4, z}, "Hall floor");
    b.box({6, 0, z}, {6.2, 1, z + 2.7}, "wall"), b.box({6, 1.9, z}, {6.2, 4, z + 2.7}, "wall");
    // The lintel above the door has a face at its bottom.
    b.box({6, 1, z + 2.1}, {6.2, 1.9, z + 2.7}, "wall");
    b.face({{6, 1, z + 2.1}, {6, 1.9, z + 2.1}, {6.2, 1.9, z + 2.1}, {6.2, 1, z + 2.1}}, "wall");
    b.box({1, 1, z}, {3, 2.5, z + 0.5}, "bed");
    b.box({8, 0, z}, {10, 0.6, z + 2}, "cupboard");
    b.face({{4, 2, z + 0.75}, {5.5, 2, z + 0.75}, {5.5, 3, z + 0.75}, {4, 3, z + 0.75}}, "table");
}

class FloorRoomsOf : public testing::TestWithParam<double> {};

TEST_P(FloorRoomsOf, AFlatAreSeparatedByTheWallAboveTheDoor) {
    // Turned by an angle that is parallel to nothing, and moved far from the origin.
    const double scale = GetParam();
    Builder b(23, {30, -70, 5}, scale);
    add_flat(b, 0);
    const Scene scene = b.scene();
    const RayTracer tracer(scene);
    const FloorRooms rooms(scene, tracer);
    ASSERT_EQ(rooms.count(), 2u);
    EXPECT_EQ(rooms.label(0), "room 1 (kitchen)");
    EXPECT_EQ(rooms.label(1), "room 2 (Hall)");
    // Cells are 0.1 m wide; the door's threshold belongs to either room.
    EXPECT_NEAR(rooms[0].area, 24 * scale * scale, 0.7 * scale * scale);
    EXPECT_NEAR(rooms[1].area, 14 * scale * scale, 0.7 * scale * scale);  // area without the cupboard
    EXPECT_NEAR(rooms[0].height, 2.7 * scale, 1e-5 * scale);
    // The border keeps points away from the walls, exactly; the bed and the table are within the room.
    const double border = 0.5 * scale, little = 1e-3 * scale;
    EXPECT_TRUE(rooms.holds(0, b.at(5.5, 3, 0) - little * normalized(b.at(1, 0, 0) - b.at(0, 0, 0)), border));
    EXPECT_FALSE(rooms.holds(0, b.at(5.5, 3, 0) + little * normalized(b.at(1, 0, 0) - b.at(0, 0, 0)), border));
    EXPECT_TRUE(rooms.holds(0, b.at(2, 1.5, 0), border));
    EXPECT_TRUE(rooms.holds(0, b.at(4.6, 2.6, 0), border));
    EXPECT_FALSE(rooms.holds(1, b.at(4.6, 2.6, 0), 0));
    EXPECT_EQ(rooms.at(b.at(8, 2, 1.2)), 1u);
    EXPECT_EQ(rooms.at(b.at(8, 2, 3)), 2u);
}

INSTANTIATE_TEST_SUITE_P(OfSize, FloorRoomsOf, testing::Values(1.0, 0.1));

TEST(FloorRooms, EveryStoreyHasItsRoomsAndRoofsHaveNone) {
    Builder b(0, {0, 0, 0}, 1);
    add_flat(b, 0), add_flat(b, 3);
    b.floor({0, 0, 5.9}, {10, 4, 5.9}, "roof");
    b.floor({-40, -40, -0.3}, {40, 40, -0.3}, "meadow");
    const Scene scene = b.scene();
    const RayTracer tracer(scene);
    const FloorRooms rooms(scene, tracer);
    ASSERT_EQ(rooms.count(), 4u);
    for (std::size_t i = 0; i < rooms.count(); ++i) {
        const double z = rooms[i].rectangle.origin.z;
        EXPECT_TRUE(std::abs(z) < 1e-9 || std::abs(z - 3) < 1e-9) << z;
    }
}

/// A hall of 40 x 30 x 8 m, turned by 30 degrees and moved by a kilometre.
Builder hall(double scale = 1) {
    Builder b(30, {1000, -400, 3}, scale);
    b.box({0, 0, 0}, {40, 30, 8}, "shell", true);
    b.floor({0, 0, 0}, {40, 30, 0}, "hall_floor");
    return b;
}

/// A slab of 0.2 m with its top at z.
void add_slab(Builder& b, Vec3 lo, Vec3 hi) {
    b.box(lo, hi, "slab");
    b.face({{lo.x, lo.y, lo.z}, {lo.x, hi.y, lo.z}, {hi.x, hi.y, lo.z}, {hi.x, lo.y, lo.z}}, "slab");
}

/// Heights of the floors of all rooms above the hall's floor, metres, in the order of rooms.
std::vector<double> floor_heights(Builder& b, double scale = 1) {
    const double ground = b.at(0, 0, 0).z;
    const Scene scene = b.scene();
    const RayTracer tracer(scene);
    const FloorRooms rooms(scene, tracer);
    std::vector<double> out;
    for (std::size_t i = 0; i < rooms.count(); ++i)
        out.push_back(std::round((rooms[i].rectangle.origin.z - ground) / scale * 1000) / 1000);
    return out;
}

using FloorHeights = std::vector<double>;

TEST(FloorRooms, RacksInAHallAreNoRooms) {
    for (const double scale : {1.0, 0.1}) {
        Builder b = hall(scale);
        for (int row = 0; row < 5; ++row)
            for (int i = 0; i < 10; ++i) {
                const double x = 2 + 3.6 * i, y = 2 + 5.5 * row;
                b.box({x, y, 0}, {x + 2.7, y + 1.1, 2 + 0.4 * row}, "rack");
            }
        EXPECT_EQ(floor_heights(b, scale), FloorHeights{0}) << scale;
    }
}

TEST(FloorRooms, StoreysOfABuildingWithoutOuterWallsAreRooms) {
    Builder b(30, {1000, -400, 3}, 1);
    b.floor({-40, -40, 0}, {40, 40, 0}, "street");
    for (int storey = 1; storey <= 3; ++storey) add_slab(b, {-30, -30, 3.0 * storey - 0.2}, {30, 30, 3.0 * storey});
    for (const double x : {-20.0, 0.0, 20.0}) b.box({x, -0.2, 0}, {x + 0.4, 0.2, 8.8}, "column");
    EXPECT_EQ(floor_heights(b), (FloorHeights{0, 3, 6}));  // the highest slab is a roof
}

TEST(FloorRooms, MachinesAtWallsAndBesideEachOtherAreNoRooms) {
    Builder b = hall();
    b.box({0, 3, 0}, {1, 13, 2.5}, "rack at a wall");
    b.box({38, 0, 0}, {40, 3, 3}, "machine in a corner");
    b.box({10, 10, 0}, {13, 12, 2.2}, "low"), b.box({13, 10, 0}, {16, 12, 3.1}, "high"),
        b.box({16, 10, 0}, {18, 12, 4}, "high");
    b.box({20, 20, 0}, {26, 24, 3}, "press"), b.box({22, 21, 3}, {24, 23, 4.5}, "tower of the press");
    add_slab(b, {20, 4, 5}, {32, 4.8, 5.5});  // an air duct
    for (int shelf = 0; shelf < 4; ++shelf) add_slab(b, {5, 29, 0.9 * shelf + 0.6}, {15, 30, 0.9 * shelf + 0.64});
    EXPECT_EQ(floor_heights(b), FloorHeights{0});
}

TEST(FloorRooms, AMezzanineAtAWallIsARoom) {
    Builder slab = hall();
    add_slab(slab, {35, 20, 2.8}, {40, 24, 3});
    EXPECT_EQ(floor_heights(slab), (FloorHeights{0, 3}));
    Builder sheet = hall();
    sheet.floor({35, 20, 3}, {40, 24, 3}, "sheet");
    EXPECT_EQ(floor_heights(sheet), (FloorHeights{0, 3}));
}

TEST(FloorRooms, APlatformIsARoomIfItHasARailingOrStairs) {
    const auto platform = [] {
        Builder b = hall();
        add_slab(b, {20, 10, 2.8}, {25, 14, 3});
        return b;
    };
    Builder bare = platform();
    EXPECT_EQ(floor_heights(bare), FloorHeights{0});
    Builder railing = platform();
    for (const auto& [lo, hi] : std::vector<std::pair<Vec3, Vec3>>{{{20, 10, 4}, {25, 10.04, 4.04}},
                                                                   {{20, 13.96, 4}, {25, 14, 4.04}},
                                                                   {{20, 10, 4}, {20.04, 14, 4.04}},
                                                                   {{24.96, 10, 4}, {25, 12.9, 4.04}}})
        add_slab(railing, lo, hi);
    EXPECT_EQ(floor_heights(railing), (FloorHeights{0, 3}));
    Builder parapet = platform();
    parapet.box({20, 10, 3}, {25, 10.15, 4}, "parapet"), parapet.box({20, 13.85, 3}, {25, 14, 4}, "parapet");
    EXPECT_EQ(floor_heights(parapet), (FloorHeights{0, 3}));
    // Stairs of 18 steps, the treads of which are more than 1 m^2.
    Builder stairs = platform();
    for (int i = 1; i < 18; ++i) {
        const double z = 3 - i / 6.0, x = 25 + 0.28 * (i - 1);
        add_slab(stairs, {x, 10, z - 0.05}, {x + 0.28, 14, z});
    }
    EXPECT_EQ(floor_heights(stairs), (FloorHeights{0, 3}));
    // Stairs lead to the top of a solid block.
    Builder block = hall();
    block.box({20, 10, 0}, {25, 14, 3}, "block");
    for (int i = 1; i < 18; ++i) {
        const double z = 3 - i / 6.0, x = 25 + 0.28 * (i - 1);
        block.box({x, 10, 0}, {x + 0.28, 11.2, z}, "stairs");
    }
    EXPECT_EQ(floor_heights(block), (FloorHeights{0, 3}));
}

TEST(FloorRooms, GoodsAlongTheEdgesOfARackAreNoRailing) {
    for (const double scale : {1.0, 0.1})
        for (const double gap : {0.0, 0.3}) {
            Builder b = hall(scale);
            b.box({10, 10, 0}, {22, 11.2, 3}, "rack");
            b.box({28, 10, 0}, {36, 14, 3}, "wide rack");
            for (int i = 0; i < 10; ++i) b.box({10 + 1.2 * i, 10, 3}, {11.2 - gap + 1.2 * i, 11.2, 3.8}, "goods");
            for (const double x : {28.0, 35.3}) b.box({x, 10, 3}, {x + 0.7, 14, 3.9}, "goods");
            for (const double y : {10.0, 13.3}) b.box({28.7 + gap, y, 3}, {35.3 - gap, y + 0.7, 3.9}, "goods");
            EXPECT_EQ(floor_heights(b, scale), FloorHeights{0}) << scale << ", gap " << gap;
        }
}

TEST(FloorRooms, APlatformBehindAThickParapetOrASheetIsARoom) {
    for (const double thickness : {0.1, 0.3, 0.5}) {
        Builder b = hall();
        add_slab(b, {20, 10, 2.8}, {26, 15, 3});
        b.box({20, 10, 3}, {26, 10 + thickness, 4}, "parapet"), b.box({20, 15 - thickness, 3}, {26, 15, 4}, "parapet");
        EXPECT_EQ(floor_heights(b), (FloorHeights{0, 3})) << thickness;
    }
    for (const bool inwards : {false, true}) {  // one-sided sheets with either face to the platform
        Builder b = hall();
        add_slab(b, {20, 10, 2.8}, {26, 15, 3});
        for (const double y : {10.02, 14.98}) {
            std::vector<Vec3> sheet{{20, y, 3}, {26, y, 3}, {26, y, 4}, {20, y, 4}};
            if (inwards) std::reverse(sheet.begin(), sheet.end());
            b.face(sheet, "sheet");
        }
        EXPECT_EQ(floor_heights(b), (FloorHeights{0, 3})) << inwards;
    }
}

TEST(FloorRooms, APavilionBehindGlassIsARoom) {
    Builder b = hall();
    add_slab(b, {20, 10, 2.8}, {25, 14, 3});
    for (const auto& [p, q] : std::vector<std::pair<Vec3, Vec3>>{{{20, 10, 0}, {25, 10, 0}},
                                                                 {{25, 10, 0}, {25, 14, 0}},
                                                                 {{25, 14, 0}, {20, 14, 0}},
                                                                 {{20, 14, 0}, {20, 10, 0}}})
        b.pane({{p.x, p.y, 3}, {q.x, q.y, 3}, {q.x, q.y, 5.5}, {p.x, p.y, 5.5}});
    EXPECT_EQ(floor_heights(b), (FloorHeights{0, 3}));
}

TEST(FloorRooms, InAnOpenModelATerraceWithParapetsIsARoomAndARoofIsNone) {
    Builder b(30, {1000, -400, 3}, 1);
    b.floor({-40, -40, 0}, {40, 40, 0}, "meadow");
    b.box({0, 0, 0}, {10, 8, 3}, "house"), b.box({20, 0, 0}, {30, 8, 6}, "house");
    b.box({10, 0, 0}, {18, 8, 5}, "higher house beside it");
    for (const auto& [lo, hi] : std::vector<std::pair<Vec3, Vec3>>{{{20, 0, 6}, {30, 0.3, 7}},
                                                                   {{20, 7.7, 6}, {30, 8, 7}},
                                                                   {{20, 0.3, 6}, {20.3, 7.7, 7}},
                                                                   {{29.7, 0.3, 6}, {30, 7.7, 7}}})
        b.box(lo, hi, "parapet");
    EXPECT_EQ(floor_heights(b), (FloorHeights{0, 6}));
}

TEST(FloorRooms, LevelsAroundOrBesideLowerFloorsAreRooms) {
    // A deck around a basin of 2 m depth, and a hall of two levels without railing or stairs.
    Builder pool(30, {1000, -400, 3}, 1);
    pool.box({0, 0, 2}, {35, 20, 8}, "walls", true);
    pool.face({{0, 0, 2}, {35, 0, 2}, {35, 4, 2}, {0, 4, 2}}, "deck"),
        pool.face({{0, 16, 2}, {35, 16, 2}, {35, 20, 2}, {0, 20, 2}}, "deck");
    pool.face({{0, 4, 2}, {5, 4, 2}, {5, 16, 2}, {0, 16, 2}}, "deck"),
        pool.face({{30, 4, 2}, {35, 4, 2}, {35, 16, 2}, {30, 16, 2}}, "deck");
    pool.sides({5, 4, 0}, {30, 16, 2}, "basin"), pool.floor({5, 4, 0}, {30, 16, 0}, "basin");
    EXPECT_EQ(floor_heights(pool), (FloorHeights{2, 0}));
    Builder split(30, {1000, -400, 3}, 1);
    split.sides({0, 0, 0}, {10, 10, 6}, "walls"), split.floor({0, 0, 0}, {10, 10, 0}, "floor");
    split.face({{0, 0, 6}, {0, 10, 6}, {10, 10, 6}, {10, 0, 6}}, "ceiling");
    split.box({0, 6, 0}, {10, 10, 2.2}, "upper level");
    EXPECT_EQ(floor_heights(split), (FloorHeights{0, 2.2}));
}

TEST(FloorRooms, RacksOnAnUpperStoreyAreNoRooms) {
    Builder b = hall();
    b.box({0, 0, -4}, {40, 30, -0.3}, "lower hall", true), b.floor({0, 0, -4}, {40, 30, -4}, "lower floor");
    for (const double y : {0.0, 12.0}) {  // at a wall, and free
        b.box({10, y, 0.001}, {20, y + 1.2, 2.6}, "rack");
        b.face({{10, y, 0.001}, {10, y + 1.2, 0.001}, {20, y + 1.2, 0.001}, {20, y, 0.001}}, "rack");
    }
    EXPECT_EQ(floor_heights(b), (FloorHeights{-4, 0}));
}

TEST(FloorRooms, OfficesInAHallAreRoomsAndTheirRoofsAreNot) {
    Builder b = hall();
    b.box({10, 10, 0}, {16, 14, 2.9}, "office");
    b.box({10.1, 10.1, 0}, {15.9, 13.9, 2.7}, "office inside", true);
    b.box({12, 11, 0}, {13.6, 11.8, 0.75}, "desk");
    EXPECT_EQ(floor_heights(b), (FloorHeights{0, 0}));
}

TEST(FloorRooms, ThePlanesOfTwoRoomsEndAtTheWall) {
    Builder b(0, {0, 0, 0}, 1);
    add_flat(b, 0);
    const Scene scene = b.scene();
    const RayTracer tracer(scene);
    PlaneRequest request;
    request.height = 0.75;
    const auto planes = make_working_planes(scene, FloorRooms(scene, tracer), request);
    ASSERT_TRUE(planes) << planes.error().message;
    ASSERT_EQ(planes->size(), 2u);
    EXPECT_EQ((*planes)[0].name, "0.75 m above room 1 (kitchen)");
    EXPECT_EQ((*planes)[1].room, 1u);
    // Walls are exact to the rays' accuracy, 1e-7 of the scene's size.
    EXPECT_NEAR(norm((*planes)[0].plane.u), 6, 1e-5);
    EXPECT_NEAR((*planes)[1].plane.origin.x, 6.2, 1e-5);
    EXPECT_NEAR(norm((*planes)[1].plane.v), 4, 1e-9);
    for (const GridLight& plane : *planes)
        for (std::size_t i = 0; i < plane.points.size(); ++i) {
            const Point& p = plane.points[i];
            const bool in_kitchen = p.x > 0.5 && p.x<5.5, in_hall = p.x> 6.7 && p.x < 9.5;
            EXPECT_TRUE(!plane.counts[i] || (plane.room == 0u ? in_kitchen : in_hall)) << p.x;
        }
}

TEST(RoomObservers, StandInRoomsAndNotInFurniture) {
    Builder b(23, {30, -70, 5}, 1);
    add_flat(b, 0);
    const Scene scene = b.scene();
    const Stage stage(scene);
    const FloorRooms rooms(scene, stage.tracer);
    const std::vector<Observer> observers = room_observers(stage, rooms);
    ASSERT_EQ(observers.size(), 8u);
    EXPECT_EQ(observers[0].name, "room 1 (kitchen), looking 23°");
    for (const Observer& o : observers) {
        ASSERT_TRUE(o.room);
        EXPECT_EQ(rooms.at(o.eye), *o.room) << o.name;
        const Vec3 d = o.eye - b.at(0, 0, 0);
        const double x = dot(d, b.at(1, 0, 0) - b.at(0, 0, 0)), y = dot(d, b.at(0, 1, 0) - b.at(0, 0, 0));
        EXPECT_FALSE(x > 8 && y < 0.6 + observer_clearance - 1e-9) << o.name << " stands in the cupboard";
    }
}

}  // namespace
}  // namespace exitance
