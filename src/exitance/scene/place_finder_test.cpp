#include "exitance/scene/place_finder.hpp"

#include <gtest/gtest.h>

#include <array>

#include "exitance/scene/add_polygon.hpp"

namespace exitance {
namespace {

using Outline = std::vector<Point>;

/// A scene of faces with alternating materials, so that no two are joined to one region, and of panes.
Scene scene_of(const std::vector<Outline>& faces, const std::vector<Outline>& panes = {}) {
    SceneDescription d;
    d.materials = {{"grey", Spectrum(0.5), {}}, {"other", Spectrum(0.4), {}}};
    d.groups = {"all"};
    for (const Outline& outline : faces) {
        const bool is_odd = d.faces.size() % 2 == 1;
        add_polygon(d, outline).material = is_odd ? 1 : 0;
    }
    for (const Outline& outline : panes) {
        Pane pane;
        pane.corners = outline, pane.transmissivity = Spectrum(0.8);
        d.panes.push_back(pane);
    }
    CheckedScene made = make_scene(d);
    EXPECT_TRUE(made.scene);
    return *made.scene;
}

Outline reversed(Outline outline) {
    std::reverse(outline.begin(), outline.end());
    return outline;
}

/// A floor of 4 x 3 m and walls at its left, right and near edge, fronts inside.
std::vector<Outline> open_box() {
    return {{{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}},
            {{0, 0, 0}, {0, 3, 0}, {0, 3, 2.5}, {0, 0, 2.5}},
            {{4, 0, 0}, {4, 0, 2.5}, {4, 3, 2.5}, {4, 3, 0}},
            {{0, 0, 0}, {0, 0, 2.5}, {4, 0, 2.5}, {4, 0, 0}}};
}

/// A large floor under the other objects.
const Outline slab{{-10, -10, 0}, {10, -10, 0}, {10, 10, 0}, {-10, 10, 0}};
/// A partition along y above the centre of the slab, its front towards +x.
const Outline partition{{0, -2, 0}, {0, 2, 0}, {0, 2, 2}, {0, -2, 2}};
const Normal up{0, 0, 1};

TEST(PlaceFinder, APointBelowAWallIsMovedIntoItsOwnFace) {
    const Scene scene = scene_of(open_box());
    const PlaceFinder finder(scene);
    const double step = finder.step();
    EXPECT_NEAR(step / scene.size(), 1e-6, 0.5e-6);
    // Metres; less than a step and than the tolerance of a Locator.
    for (const double off : {-4e-6, -1e-9, 0.0, 1e-9, 1e-6}) {
        const MeasuredPlace left = finder.find({off, 1.5, 0}, up), right = finder.find({4 - off, 1.5, 0}, up);
        EXPECT_NEAR(left.x.x, step, 0.01 * step) << off;
        EXPECT_NEAR(right.x.x, 4 - step, 0.01 * step) << off;
        EXPECT_EQ(left.x.y, 1.5);
        EXPECT_EQ(left.surface, SurfaceId(0));
        EXPECT_FALSE(left.is_between_sides || right.is_between_sides);
    }
    const MeasuredPlace corner = finder.find({0, 0, 0}, up);
    EXPECT_NEAR(corner.x.x, step, 0.01 * step);
    EXPECT_NEAR(corner.x.y, step, 0.01 * step);
    EXPECT_FALSE(corner.is_between_sides);
    // For points at the foot of a wall the floor counts as a wall, and in a corner so does the neighbouring wall.
    const MeasuredPlace on_wall = finder.find({0, 1, 0}, {1, 0, 0}), in_corner = finder.find({0, 0, 1}, {1, 0, 0});
    EXPECT_NEAR(on_wall.x.z, step, 0.01 * step);
    EXPECT_NEAR(in_corner.x.y, step, 0.01 * step);
    EXPECT_EQ(on_wall.surface, SurfaceId(1));
}

TEST(PlaceFinder, APointOffAllWallsIsNotMoved) {
    const Scene scene = scene_of({slab, partition, {{3, -1, 0.7}, {4, -1, 0.7}, {4, 1, 0.7}, {3, 1, 0.7}}});
    const PlaceFinder finder(scene);
    for (const Point& p : {Point{1e-3, 0, 0}, Point{-1e-3, 0, 0}, Point{1, 1, 0}, Point{0, 3, 0}, Point{0, 2.1, 1}}) {
        EXPECT_EQ(finder.find(p, up).x, p);
        EXPECT_FALSE(finder.find(p, up).is_between_sides);
    }
    // Nothing is higher than the edge of a table or of the slab.
    for (const Point& p : {Point{3, 0, 0.7}, Point{3, -1, 0.7}, Point{10, 10, 0}}) EXPECT_EQ(finder.find(p, up).x, p);
    // On the upper edge of the partition, the point is moved up.
    const MeasuredPlace on_top = finder.find({0, 0, 2}, up);
    EXPECT_EQ(on_top.x.x, 0);
    EXPECT_NEAR(on_top.x.z, 2 + finder.step(), 0.01 * finder.step());
    EXPECT_FALSE(on_top.is_between_sides);
}

TEST(PlaceFinder, AResultIsNotMovedAgain) {
    const Scene scene = scene_of({slab, partition, reversed(partition), {{0, 2, 0}, {1, 3, 0}, {1, 3, 2}, {0, 2, 2}}});
    const PlaceFinder finder(scene);
    for (const Point& p : {Point{0, 0, 0}, Point{0, 0, 1}, Point{0, 2, 0}, Point{0, -2, 0}, Point{0.5, 2.5, 0}}) {
        const Point moved = finder.find(p, up).x;
        EXPECT_NE(moved, p);
        EXPECT_EQ(finder.find(moved, up).x, moved);
    }
}

TEST(PlaceFinder, IfTheFloorContinuesThePointIsMovedToTheFront) {
    // The back of the wall is no front: a point on the ground at its back is moved to its front.
    const Scene one = scene_of({slab, partition});
    const MeasuredPlace front = PlaceFinder(one).find({0, 0, 0}, up);
    EXPECT_GT(front.x.x, 0);
    EXPECT_FALSE(front.is_between_sides);
    EXPECT_GT(PlaceFinder(one).find({0, 0, 1}, up).x.x, 0);  // the same holds for a point in free space
    // A wall of 1 cm: the points are moved to its sides, not into it.
    Outline outer = reversed(partition);
    for (Point& p : outer) p.x -= 0.01;
    const Scene thick = scene_of({slab, partition, outer});
    EXPECT_GT(PlaceFinder(thick).find({0, 0, 0}, up).x.x, 0);
    EXPECT_LT(PlaceFinder(thick).find({-0.01, 0, 0}, up).x.x, -0.01);
    EXPECT_LT(PlaceFinder(thick).find({-0.01, 0, 1}, up).x.x, -0.01);
    EXPECT_FALSE(PlaceFinder(thick).find({-0.01, 0, 0}, up).is_between_sides);
}

TEST(PlaceFinder, BelowASheetThePositionDecidesThenTheRequestedSide) {
    const Scene scene = scene_of({slab, partition, reversed(partition)});
    const PlaceFinder finder(scene);
    const double step = finder.step();
    for (const double z : {0.0, 1.0}) {  // a point on the floor, and one in free space
        for (const double side : {-1.0, 1.0}) {
            const Point towards{side, 0.3, 0};
            const MeasuredPlace chosen = finder.find({0, 0, z}, up, &towards);
            EXPECT_NEAR(chosen.x.x, side * step, 0.01 * step);
            EXPECT_TRUE(chosen.is_between_sides);
            const Point away{-side, 0.3, 0};
            EXPECT_NEAR(finder.find({0.1 * side * step, 0, z}, up, &away).x.x, side * step, 0.01 * step);
        }
        EXPECT_NEAR(std::abs(finder.find({0, 0, z}, up).x.x), step, 0.01 * step);
    }
}

TEST(PlaceFinder, APlaneParallelToAWallUsesTheSideOfItsNormal) {
    const Scene scene = scene_of({slab, partition}, {{{5, -1, 0}, {5, 1, 0}, {5, 1, 2}, {5, -1, 2}}});
    const PlaceFinder finder(scene);
    const MeasuredPlace behind = finder.find({0, 0, 1}, {-1, 0, 0});
    EXPECT_TRUE(behind.surface.is_none());
    EXPECT_NEAR(behind.x.x, -finder.step(), 0.01 * finder.step());
    EXPECT_EQ(finder.find({0, 0, 1}, {1, 0, 0}).surface, SurfaceId(1));
    for (const double side : {-1.0, 1.0}) {
        EXPECT_NEAR(finder.find({5, 0, 1}, {side, 0, 0}).x.x, 5 + side * finder.step(), 0.01 * finder.step());
        EXPECT_FALSE(finder.find({5, 0, 1}, {side, 0, 0}).is_between_sides);
    }
    // On the line below a pane that divides its face, the pane's normal decides.
    const Point on_line{5, 0, 0};
    EXPECT_GT(finder.find(on_line, up, &on_line).x.x, 5);
    EXPECT_TRUE(finder.find(on_line, up).is_between_sides);
    EXPECT_TRUE(finder.find({5, 0, 1}, up).is_between_sides);
}

TEST(PlaceFinder, AtTheEndOrBendOfAWallThePointIsFlagged) {
    const Scene scene = scene_of({slab, partition, {{0, 2, 0}, {-2, 2, 0}, {-2, 2, 2}, {0, 2, 2}}});
    const PlaceFinder finder(scene);
    const double step = finder.step();
    const MeasuredPlace end = finder.find({0, -2, 0}, up), bend = finder.find({0, 2, 0}, up);
    EXPECT_NEAR(end.x.x, 0, 1e-3 * step);
    EXPECT_NEAR(end.x.y, -2 - step, 0.01 * step);
    EXPECT_TRUE(end.is_between_sides);
    EXPECT_NEAR(bend.x.x, std::sqrt(0.5) * step, 0.01 * step);
    EXPECT_NEAR(bend.x.y, 2 + std::sqrt(0.5) * step, 0.01 * step);
    EXPECT_TRUE(bend.is_between_sides);
}

TEST(PlaceFinder, FloorsThatMeetBelowAWallAreDistinguished) {
    // Two floors meet at x = 0, with and without a sheet on the line.
    const Outline left{{-3, -2, 0}, {0, -2, 0}, {0, 2, 0}, {-3, 2, 0}},
        right{{0, -2, 0}, {3, -2, 0}, {3, 2, 0}, {0, 2, 0}};
    const Scene open = scene_of({left, right});
    EXPECT_EQ(PlaceFinder(open).find({0, 0, 0}, up).x, (Point{0, 0, 0}));
    const Scene closed = scene_of({left, right, partition, reversed(partition)});
    for (const double side : {-1.0, 1.0}) {
        const Point towards{side, 0, 0};
        const MeasuredPlace place = PlaceFinder(closed).find({0, 0, 0}, up, &towards);
        EXPECT_EQ(place.surface, SurfaceId(side < 0 ? 0 : 1));
        EXPECT_GT(place.x.x * side, 0);
        EXPECT_TRUE(place.is_between_sides);
    }
    // The strip below a wall of 1 cm is a separate floor face, at which no point should be measured.
    Outline outer = reversed(partition), strip{{-0.01, -2, 0}, {0, -2, 0}, {0, 2, 0}, {-0.01, 2, 0}}, rest = left;
    for (Point& p : outer) p.x -= 0.01;
    rest[1].x = rest[2].x = -0.01;
    const Scene thick = scene_of({strip, rest, right, partition, outer});
    EXPECT_EQ(PlaceFinder(thick).find({0, 0, 0}, up).surface, SurfaceId(2));
    EXPECT_EQ(PlaceFinder(thick).find({-0.01, 0, 0}, up).surface, SurfaceId(1));
}

TEST(PlaceFinder, OverlappingWallsAreOneWall) {
    // Two fronts closer than a step, the second a tenth of a step behind the first.
    const double step = PlaceFinder(scene_of({slab, partition})).step();
    Outline behind = partition;
    for (Point& p : behind) p.x -= 0.1 * step, p.y *= 1.1;
    const Scene scene = scene_of({slab, behind, partition});
    for (const double x : {0.0, -0.05 * step, -0.1 * step}) {
        const MeasuredPlace place = PlaceFinder(scene).find({x, 0, 0}, up);
        EXPECT_NEAR(place.x.x, step, 0.02 * step);
        EXPECT_FALSE(place.is_between_sides);
    }
}

/// A rotation about an arbitrary axis, a scale and a translation.
struct Motion {
    std::array<Vec3, 3> rows{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    double scale = 1;
    Vec3 shift;

    Vec3 turned(const Vec3& d) const { return {dot(rows[0], d), dot(rows[1], d), dot(rows[2], d)}; }
    Point operator()(const Point& p) const { return scale * turned(p) + shift; }
};

TEST(PlaceFinder, ResultsMoveWithTheScene) {
    const Frame odd(normalized(Vec3{0.3, -0.5, 0.71}));
    const std::vector<Motion> motions{
        {{Vec3{0, -1, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 1}}, 1, {}},
        {{odd.u, odd.v, odd.n}, 1, {}},
        {{odd.n, odd.u, odd.v}, 1, {1000, -1000, 1000}},
        {{odd.u, odd.v, odd.n}, 1e-3, {}},
        {{odd.u, odd.v, odd.n}, 1e3, {1000, 0, 0}},
    };
    std::vector<Outline> faces = open_box();
    const Outline sheet{{2, 0, 0}, {2, 1, 0}, {2, 1, 2}, {2, 0, 2}};
    faces.push_back(sheet), faces.push_back(reversed(sheet));
    const std::vector<Point> points{{0, 1.5, 0}, {0, 0, 0}, {4, 0, 0}, {2, 0.3, 0}, {2, 0, 0}, {2, 1, 0}, {2, 0.3, 1}};
    const Scene scene = scene_of(faces);
    const PlaceFinder finder(scene);
    for (const Motion& motion : motions) {
        std::vector<Outline> moved = faces;
        for (Outline& outline : moved)
            for (Point& p : outline) p = motion(p);
        const Scene other = scene_of(moved);
        const PlaceFinder moved_finder(other);
        EXPECT_NEAR(moved_finder.step() / (motion.scale * finder.step()), 1, 1e-9);
        for (const Point& p : points) {
            const MeasuredPlace here = finder.find(p, up), there = moved_finder.find(motion(p), motion.turned(up));
            // The rounding error of coordinates 1000 m from the origin is 1e-13 m; the rounding error of the wall's
            // plane is a few times as large.
            EXPECT_LT(norm(there.x - motion(here.x)), 1e-6 * moved_finder.step()) << p.x << ' ' << p.y << ' ' << p.z;
            EXPECT_EQ(here.surface, there.surface);
            EXPECT_EQ(here.is_between_sides, there.is_between_sides);
        }
    }
}

}  // namespace
}  // namespace exitance
