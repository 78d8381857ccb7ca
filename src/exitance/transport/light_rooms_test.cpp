#include "exitance/transport/light_rooms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/transport/stage.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

LightRooms rooms_of(const Scene& scene) {
    return find_light_rooms(Stage(scene), 1, StopRequest());
}

/// Adds a closed box whose faces have their fronts inside.
void add_box(SceneDescription& d, Point lo, Point hi, std::uint32_t material) {
    const auto at = [&](int x, int y, int z) {
        d.points.push_back({x ? hi.x : lo.x, y ? hi.y : lo.y, z ? hi.z : lo.z});
        return static_cast<std::uint32_t>(d.points.size() - 1);
    };
    const auto face = [&](std::vector<std::uint32_t> corners) {
        d.faces.push_back({std::move(corners), material, 0, 0});
    };
    face({at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0)});
    face({at(0, 0, 1), at(0, 1, 1), at(1, 1, 1), at(1, 0, 1)});
    face({at(0, 0, 0), at(0, 0, 1), at(1, 0, 1), at(1, 0, 0)});
    face({at(0, 1, 0), at(1, 1, 0), at(1, 1, 1), at(0, 1, 1)});
    face({at(0, 0, 0), at(0, 1, 0), at(0, 1, 1), at(0, 0, 1)});
    face({at(1, 0, 0), at(1, 0, 1), at(1, 1, 1), at(1, 1, 0)});
}

Scene boxes(const std::vector<std::pair<Point, Point>>& corners) {
    SceneDescription d;
    d.groups = {"all"};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(1)}};
    for (const auto& [lo, hi] : corners) add_box(d, lo, hi, 0);
    return std::move(*make_scene(std::move(d)).scene);
}

TEST(LightRooms, AClosedRoomATubeAndAnOpenSceneAreOneRoom) {
    for (const char* name : {"furnace", "tube", "chair", "cornell", "complex"})
        EXPECT_EQ(rooms_of(built_scene(name)).count(), 0u) << name;
}

/// Closed rooms of a building are counted as spaces even if each is too small to be judged on its own.
TEST(LightRooms, CountsTheSpacesOfManyRooms) {
    std::vector<std::pair<Point, Point>> many;
    for (int k = 0; k < 48; ++k)
        many.push_back({{5.0 * (k % 8), 6.0 * (k / 8), 0}, {5.0 * (k % 8) + 4, 6.0 * (k / 8) + 5, 3}});
    EXPECT_NEAR(rooms_of(boxes(many)).spaces(), 48, 0.5);
    EXPECT_NEAR(rooms_of(boxes(many)).multiplicity(), 48.0 / 20, 0.05);
    many.push_back({{0, -1000, 0}, {400, -600, 100}});  // a hall that is far larger than all other rooms
    EXPECT_NEAR(rooms_of(boxes(many)).spaces(), 1, 0.1);
    // Rooms with thick walls: the space between their outsides, which no light reaches, does not count.
    SceneDescription d;
    d.groups = {"all"};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(1)}, {"outside", Spectrum(0.5), Spectrum()}};
    for (int k = 0; k < 30; ++k) {
        add_box(d, {5.0 * k, 0, 0}, {5.0 * k + 4, 5, 3}, 0);
        add_box(d, {5.0 * k + 4.2, 5.2, 3.2}, {5.0 * k - 0.2, -0.2, -0.2}, 1);
    }
    EXPECT_NEAR(rooms_of(*make_scene(std::move(d)).scene).spaces(), 30, 0.5);
    for (const char* name : {"furnace", "tube", "chair", "cornell", "complex"})
        EXPECT_LT(rooms_of(built_scene(name)).spaces(), 1.5) << name;
}

TEST(LightRooms, RoomsConnectedByADoorAreTwo) {
    const Scene scene = built_scene("office", {{"nx", "2"}, {"ny", "1"}});
    const LightRooms rooms = rooms_of(scene);
    ASSERT_EQ(rooms.count(), 2u);
    EXPECT_NEAR(rooms.area(0), rooms.area(1), 0.05 * rooms.area(0));
}

TEST(LightRooms, GroundThatNoLightReachesDoesNotWeighTheRoom) {
    // Two equal rooms beside 1 km of ground. If the ground counted as a room, each element would weigh 10^4.
    SceneDescription d;
    d.groups = {"all"};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(1)}, {"ground", Spectrum(0.5), Spectrum()}};
    add_box(d, {0, 0, 0}, {4, 4, 3}, 0);
    add_box(d, {10, 0, 0}, {14, 4, 3}, 0);
    for (const Point& p : {Point{-500, -500, -1}, {500, -500, -1}, {500, 500, -1}, {-500, 500, -1}})
        d.points.push_back(p);
    d.faces.push_back({{48, 49, 50, 51}, 1, 0, 0});
    const Scene scene = std::move(*make_scene(std::move(d)).scene);
    Stage stage(scene);
    Field<RegionId, std::uint8_t> unlit(scene.regions().size());
    unlit[scene.surfaces()[SurfaceId(12)].region] = 1;
    stage.set_unlit_sides(std::move(unlit));
    const StopRequest stop;
    const LightRooms rooms = find_light_rooms(stage, 1, stop);
    ASSERT_GE(rooms.count(), 2u);
    const ElementTree tree = stage.make_elements({1, 0});
    for (ElementId e : tree.leaves()) {
        if (stage.is_unlit(tree.region(e))) continue;
        EXPECT_NEAR(rooms.weight(tree, e), 1, 0.1);
    }
}

TEST(LightRooms, LeavesThatSeeNoFrontBelongToTheRoomBesideThem) {
    // A board lies 1 mm above the floor of the smaller room: no ray from below it hits a front.
    SceneDescription d;
    d.groups = {"all"};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(1)}};
    add_box(d, {0, 0, 0}, {4, 4, 4}, 0);
    add_box(d, {10, 0, 0}, {12, 2, 2}, 0);
    for (const Point& p : {Point{10.5, 0.5, 0.001}, {11.5, 0.5, 0.001}, {11.5, 1.5, 0.001}, {10.5, 1.5, 0.001}})
        d.points.push_back(p);
    d.faces.push_back({{48, 49, 50, 51}, 0, 0, 0});
    const Scene scene = std::move(*make_scene(std::move(d)).scene);
    const LightRooms rooms = rooms_of(scene);
    ASSERT_EQ(rooms.count(), 2u);
    const RegionId floor = scene.surfaces()[SurfaceId(6)].region;
    EXPECT_EQ(rooms.at(floor, {10.2, 0.2, 0}), 1u);
    EXPECT_EQ(rooms.at(floor, {11, 1, 0}), 1u);
}

TEST(LightRooms, SurfacesBehindThingsAreNotOutdoorsIfThereIsASky) {
    // The rays of a ceiling behind a lamp, or of a wall behind a board, hit backs. They must not count as rays to the
    // sky, which would make a room of its own of the gap, with nearly no light.
    SkyModel sky = overcast_sky();
    ASSERT_TRUE(sky.normalize());
    for (const double scale : {1.0, 1e-2})
        for (const double turn : {0.0, 0.7}) {
            SceneDescription d;
            d.groups = {"all"};
            d.materials = {{"grey", Spectrum(0.5), Spectrum(1)}};
            add_box(d, {0, 0, 0}, {5, 3, 3}, 0);
            const auto face = [&](const std::array<Point, 4>& corners) {
                const auto first = static_cast<std::uint32_t>(d.points.size());
                d.points.insert(d.points.end(), corners.begin(), corners.end());
                d.faces.push_back({{first, first + 1, first + 2, first + 3}, 0, 0, 0});
            };
            face({Point{2, 1, 2.999}, {2, 1.4, 2.999}, {3.2, 1.4, 2.999}, {3.2, 1, 2.999}});
            face({Point{1, 2.998, 1}, {2, 2.998, 1}, {2, 2.998, 2}, {1, 2.998, 2}});
            for (Point& p : d.points)
                p = scale * Vec3{std::cos(turn) * p.x - std::sin(turn) * p.y,
                                 std::sin(turn) * p.x + std::cos(turn) * p.y, p.z + 100};
            d.distant.domes = {{sky, Spectrum(100.0)}};
            EXPECT_EQ(rooms_of(std::move(*make_scene(std::move(d)).scene)).count(), 0u) << scale << ", " << turn;
        }
}

TEST(LightRooms, CoveredFacesAreNoRoom) {
    SceneDescription d;
    d.groups = {"all"};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(1)}};
    add_box(d, {0, 0, 0}, {2, 2, 1}, 0);
    const std::size_t walls = d.faces.size();
    add_box(d, {0.5, 0.5, 0}, {1.5, 1.5, 0.4}, 0);
    for (std::size_t i = walls; i < d.faces.size(); ++i)  // turn the faces of the inner box outwards
        std::reverse(d.faces[i].corners.begin(), d.faces[i].corners.end());
    EXPECT_EQ(rooms_of(*make_scene(std::move(d)).scene).count(), 0u);
}

/// Leaves of a tree that intersect each other enclose pockets that little light enters. They are not rooms.
TEST(LightRooms, APocketBetweenIntersectingPolygonsIsNoRoom) {
    SceneDescription d;
    d.groups = {"all"};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(1)}};
    add_box(d, {-3, -3, -3}, {3, 3, 3}, 0);
    // Six boards around a cube of 10 cm face its inside and extend 10 cm beyond it.
    for (const int axis : {0, 1, 2})
        for (const double side : {-0.05, 0.05}) {
            const auto first = static_cast<std::uint32_t>(d.points.size());
            const double turn = side < 0 ? 1 : -1;
            for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
                std::array<double, 3> p{};
                p[static_cast<std::size_t>(axis)] = side;
                p[static_cast<std::size_t>((axis + 1) % 3)] = 0.15 * u * turn;
                p[static_cast<std::size_t>((axis + 2) % 3)] = 0.15 * v;
                d.points.push_back({p[0], p[1], p[2]});
            }
            d.faces.push_back({{first, first + 1, first + 2, first + 3}, 0, 0, 0});
        }
    EXPECT_EQ(rooms_of(std::move(*make_scene(std::move(d)).scene)).count(), 0u);
}

TEST(LightRooms, AStopBeforeTheRaysGivesNoRoomsAndNoLoss) {
    const Scene scene = boxes({{{0, 0, 0}, {4, 4, 4}}, {{10, 0, 0}, {12, 2, 2}}});
    StopRequest stop;
    stop.interrupt();
    const LightRooms rooms = find_light_rooms(Stage(scene), 1, stop);
    EXPECT_EQ(rooms.count(), 0u);
    EXPECT_EQ(rooms.lost_share(RegionId(0), {1, 1, 0}), 0);
}

TEST(LightRooms, SealedRoomsAreSeparateAndHaveEqualWeight) {
    const Scene scene = boxes({{{0, 0, 0}, {4, 4, 4}}, {{10, 0, 0}, {12, 2, 2}}});
    const Stage stage(scene);
    const LightRooms rooms = find_light_rooms(stage, 1, StopRequest());
    ASSERT_EQ(rooms.count(), 2u);
    EXPECT_NEAR(rooms.area(0), 96, 1e-9);
    EXPECT_NEAR(rooms.area(1), 24, 1e-9);
    EXPECT_EQ(rooms.at(RegionId(0), {1, 1, 0}), 0u);
    EXPECT_EQ(rooms.at(RegionId(6), {11, 1, 0}), 1u);
    const ElementTree tree = stage.make_elements({1, 0});
    double counted = 0;
    for (ElementId e : tree.leaves()) counted += tree.area(e) * rooms.weight(tree, e);
    EXPECT_NEAR(counted, 120, 1e-9);
}

TEST(LightRooms, SmallRoomsBelongToTheirNeighbourUnlessThatIsGroundOrSky) {
    // 0.7% of the area: too small for a room, except next to a box as large as a landscape.
    EXPECT_EQ(rooms_of(boxes({{{0, 0, 0}, {12, 12, 12}}, {{5, 5, 5}, {6, 6, 6}}})).count(), 0u);
    EXPECT_EQ(rooms_of(boxes({{{0, 0, 0}, {900, 900, 900}}, {{5, 5, 5}, {6, 6, 6}}})).count(), 2u);
}

/// Grey polygons under an even sky.
Scene under_sky(const std::vector<std::vector<Point>>& faces) {
    SceneDescription d;
    d.groups = {"all"};
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.distant.domes.push_back({uniform_sky(), Spectrum(1.0)});
    for (const std::vector<Point>& corners : faces) {
        SceneDescription::Face face;
        for (const Point& p : corners) {
            face.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(p);
        }
        d.faces.push_back(face);
    }
    return std::move(*make_scene(std::move(d)).scene);
}

/// A house without a floor on ground under an even sky: 5 x 4 x 2.5 m, with a slit of 5 x 0.4 m in one wall. The ground
/// extends from -half to half metres.
Scene house_on_ground(double half) {
    std::vector<std::vector<Point>> faces;
    const auto face = [&](const std::vector<Point>& corners) { faces.push_back(corners); };
    const auto wall = [&](std::vector<Point> corners) {
        face(corners);
        std::reverse(corners.begin(), corners.end());
        face(corners);
    };
    face({{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}});
    wall({{0, 0, 0}, {5, 0, 0}, {5, 0, 1}, {0, 0, 1}});
    wall({{0, 0, 1.4}, {5, 0, 1.4}, {5, 0, 2.5}, {0, 0, 2.5}});
    wall({{5, 0, 0}, {5, 4, 0}, {5, 4, 2.5}, {5, 0, 2.5}});
    wall({{5, 4, 0}, {0, 4, 0}, {0, 4, 2.5}, {5, 4, 2.5}});
    wall({{0, 4, 0}, {0, 0, 0}, {0, 0, 2.5}, {0, 4, 2.5}});
    wall({{0, 0, 2.5}, {5, 0, 2.5}, {5, 4, 2.5}, {0, 4, 2.5}});
    return under_sky(faces);
}

TEST(LightRooms, AHouseOnGroundUnderTheSkyIsARoom) {
    for (const double half : {30, 60, 150, 500}) {
        const Scene scene = house_on_ground(half);
        const Stage stage(scene);
        for (std::uint64_t seed = 1; seed <= 6; ++seed) {
            const LightRooms rooms = find_light_rooms(stage, seed, StopRequest());
            ASSERT_EQ(rooms.count(), 2u) << half << ", seed " << seed;
            // Floor, ceiling and walls without the slit. The ground's elements do not end at the walls.
            EXPECT_NEAR(rooms.area(1), 83, 1e-6) << half << ", seed " << seed;
        }
    }
}

/// A room of 5 x 4 x 3 m below a ground of 2 `half` metres, with a roof light of 0.4 m.
Scene basement(double half) {
    std::vector<std::vector<Point>> faces;
    const auto face = [&](const std::vector<Point>& corners) { faces.push_back(corners); };
    const auto around_hole = [&](double x, double y, bool upwards) {  // four rectangles up to |x|, |y|
        for (std::vector<Point> corners : {std::vector<Point>{{-x, -y, 0}, {x, -y, 0}, {x, -0.2, 0}, {-x, -0.2, 0}},
                                           {{-x, 0.2, 0}, {x, 0.2, 0}, {x, y, 0}, {-x, y, 0}},
                                           {{-x, -0.2, 0}, {-0.2, -0.2, 0}, {-0.2, 0.2, 0}, {-x, 0.2, 0}},
                                           {{0.2, -0.2, 0}, {x, -0.2, 0}, {x, 0.2, 0}, {0.2, 0.2, 0}}}) {
            if (!upwards) std::reverse(corners.begin(), corners.end());
            face(corners);
        }
    };
    around_hole(half, half, true);
    around_hole(2.5, 2, false);
    face({{-2.5, -2, -3}, {2.5, -2, -3}, {2.5, 2, -3}, {-2.5, 2, -3}});
    face({{-2.5, -2, -3}, {-2.5, 2, -3}, {-2.5, 2, 0}, {-2.5, -2, 0}});
    face({{2.5, -2, -3}, {2.5, -2, 0}, {2.5, 2, 0}, {2.5, 2, -3}});
    face({{-2.5, -2, -3}, {-2.5, -2, 0}, {2.5, -2, 0}, {2.5, -2, -3}});
    face({{-2.5, 2, -3}, {2.5, 2, -3}, {2.5, 2, 0}, {-2.5, 2, 0}});
    return under_sky(faces);
}

TEST(LightRooms, ARoomBelowAGroundOfAnySizeIsARoom) {
    constexpr double area = 2 * 20 - 0.16 + 2 * 3 * (5 + 4);  // m^2
    for (const double half : {2.6, 3.0, 5.0, 100.0}) {
        const Scene scene = basement(half);
        const Stage stage(scene);
        const LightRooms rooms = find_light_rooms(stage, 1, StopRequest());
        ASSERT_EQ(rooms.count(), 2u) << half;
        const std::size_t room = 4 * half * half - 0.16 < area ? 0 : 1;
        EXPECT_NEAR(rooms.area(room), area, 0.03 * area) << half;
    }
}

TEST(LightRooms, SeveralGapsAreNoRoom) {
    // The gaps over the lamp and behind the board receive light and are far apart, but both are centimetres high.
    for (const char* lamp : {"0.01", "0.03"})
        EXPECT_EQ(rooms_of(built_scene("gaps", {{"lamp", lamp}, {"boxes", "0.02"}})).count(), 0u) << lamp;
}

}  // namespace
}  // namespace exitance
