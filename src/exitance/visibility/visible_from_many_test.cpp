#include "exitance/visibility/visible_from_many.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "exitance/base/random.hpp"
#include "support/blockers.hpp"

namespace exitance {
namespace {

using test::box;
using test::sheet;

using Outline = std::vector<Point>;

/// Faces down from z = 2 to the plane z = 0.
const Outline ceiling = {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}};
const PlaneFrame floor_frame({0.3, -0.2, 0}, {0, 0, 1});

std::vector<Vec2> corners_of(const Outline& receiver) {
    std::vector<Vec2> out;
    for (const Point& p : receiver) out.push_back(floor_frame.flat(p));
    return out;
}
Outline floor_square(double x, double y, double half) {
    return {{x - half, y - half, 0}, {x + half, y - half, 0}, {x + half, y + half, 0}, {x - half, y + half, 0}};
}

/// Compares the results at points of a square of the floor with those of single points.
void compare(double x, double y, double half, std::span<const ConvexBlocker* const> blockers, RandomStream& random,
             const std::string& what, const Outline& source = ceiling) {
    const std::vector<Vec2> receiver = corners_of(floor_square(x, y, half));
    VisibleFromMany many;
    VisibleSource alone;
    const auto outlook = many.set(floor_frame, receiver, source, blockers);
    alone.set(source, blockers);
    std::vector<Vec2> points;
    for (int k = 0; k < 21; ++k)
        points.push_back(
            floor_frame.flat({x + half * (2 * random.uniform() - 1), y + half * (2 * random.uniform() - 1), 0}));
    std::vector<double> F(points.size());
    std::vector<Seen> seen(points.size());
    if (outlook == VisibleFromMany::Outlook::partly) many(points, std::array{points.size()}, F, seen);
    for (std::size_t k = 0; k < points.size(); ++k) {
        Seen how;
        const double exact = alone(floor_frame.at(points[k]), floor_frame.n, how);
        if (outlook == VisibleFromMany::Outlook::hidden) {
            EXPECT_EQ(exact, 0) << what;
        } else if (outlook == VisibleFromMany::Outlook::clear) {
            EXPECT_EQ(how, Seen::all) << what;
        } else {
            EXPECT_NEAR(F[k], exact, 2e-14) << what << ' ' << x << ' ' << y << ' ' << half;
            EXPECT_EQ(seen[k], how) << what << ' ' << F[k];
            if (blockers.size() > SightTables::max_blockers || source.size() > SightTables::max_corners) continue;
            // Groups of fewer than five points use registers of four; the result must be bitwise the same.
            double by_itself = 0;
            many(std::span(points).subspan(k, 1), std::array{std::size_t{1}}, std::span(&by_itself, 1),
                 std::span(&how, 1));
            EXPECT_EQ(F[k], by_itself) << what;
            EXPECT_EQ(seen[k], how) << what;
        }
    }
}

TEST(VisibleFromMany, SeesTheSameAtAnyScale) {
    // Coordinates of a town in millimetres exceed a million. Faces of the box turn as the points move, so its edges
    // appear and disappear.
    std::vector<double> expected;
    for (const double scale : {1.0, 1e-4, 1e3, 1e6}) {
        const auto scaled = [&](Outline outline) {
            for (Point& p : outline) p = scale * p;
            return outline;
        };
        const ConvexBlocker body = box(scale * Point{-0.3, -0.2, 0.5}, scale * Point{0.4, 0.3, 0.9});
        const ConvexBlocker* const blocker = &body;
        const Outline source = scaled(ceiling), floor = scaled(floor_square(0, 0, 0.8));
        const PlaneFrame frame(floor[0], {0, 0, 1});
        std::vector<Vec2> receiver, points;
        for (const Point& p : floor) receiver.push_back(frame.flat(p));
        for (int k = 0; k < 25; ++k)
            points.push_back(frame.flat(floor[0] + (0.06 + 0.37 * (k % 5)) * scale * Vec3{1, 0, 0} +
                                        (0.05 + 0.37 * (k / 5)) * scale * Vec3{0, 1, 0}));
        VisibleFromMany many;
        ASSERT_EQ(many.set(frame, receiver, source, std::span(&blocker, 1)), VisibleFromMany::Outlook::partly);
        std::vector<double> F(points.size());
        std::vector<Seen> seen(points.size());
        many(points, std::array{points.size()}, F, seen);
        if (expected.empty()) expected = F;
        for (std::size_t k = 0; k < F.size(); ++k) EXPECT_NEAR(F[k], expected[k], 1e-13) << scale << ' ' << k;
    }
    EXPECT_LT(*std::min_element(expected.begin(), expected.end()), 0.5 * expected[0]);
}

TEST(VisibleFromMany, AgreesWithSinglePoints) {
    const ConvexBlocker a = box({-0.3, -0.2, 0.5}, {0.2, 0.4, 1.1}), b = box({0.3, -0.6, 0.7}, {0.8, 0.1, 0.9});
    const ConvexBlocker c = sheet({{-0.9, -0.5, 1.2}, {-0.4, -0.6, 1.3}, {-0.5, 0.3, 1.1}});
    const ConvexBlocker d = box({-0.5, -0.3, 1.2}, {0.4, 0.5, 1.4}, {0.2, -0.1, 0});
    const ConvexBlocker standing = box({0.1, 0.2, 0}, {0.5, 0.6, 0.8});
    const ConvexBlocker upright = sheet({{0.2, -0.7, 0.1}, {0.2, 0.8, 0.1}, {0.2, 0.8, 0.9}, {0.2, -0.7, 0.9}});
    const std::vector<std::vector<const ConvexBlocker*>> cases = {{&a},
                                                                  {&b},
                                                                  {&c},
                                                                  {&d},
                                                                  {&standing},
                                                                  {&upright},
                                                                  {&a, &b},
                                                                  {&a, &d},
                                                                  {&c, &d},
                                                                  {&a, &upright},
                                                                  {&a, &c, &d},
                                                                  {&a, &b, &c, &d},
                                                                  {&standing, &d},
                                                                  {&standing, &upright, &b},
                                                                  {&a, &b, &c, &d, &standing, &upright}};
    RandomStream random(2, Stream::mesh);
    for (std::size_t i = 0; i < cases.size(); ++i)
        for (int k = 0; k < 100; ++k) {
            const double half = std::pow(10, -2 * random.uniform());
            compare(2 * random.uniform() - 1, 2 * random.uniform() - 1, half, cases[i], random,
                    "case " + std::to_string(i));
        }
}

TEST(VisibleFromMany, IsExactForCoincidentEdges) {
    // A block that hangs from the ceiling's border, two that touch, and one beside another of the same height.
    const ConvexBlocker hanging = box({0.4, -0.5, 1.2}, {1, 0.5, 2}), left = box({-0.4, -0.3, 0.6}, {0, 0.3, 1});
    const ConvexBlocker right = box({0, -0.3, 0.6}, {0.4, 0.3, 1}), above = box({-0.4, -0.3, 1}, {0, 0.3, 1.3});
    const std::vector<std::vector<const ConvexBlocker*>> cases = {
        {&hanging}, {&left, &right}, {&left, &above}, {&left, &right, &above}, {&hanging, &right}};
    RandomStream random(3, Stream::mesh);
    for (std::size_t i = 0; i < cases.size(); ++i)
        for (int k = 0; k < 50; ++k)
            compare(2 * random.uniform() - 1, 2 * random.uniform() - 1, 0.2 * random.uniform(), cases[i], random,
                    "case " + std::to_string(i));
}

/// Turns, scales and moves points.
struct Placement {
    double angle, scale;
    Vec3 offset;

    Point operator()(const Point& p) const {
        const double c = std::cos(angle), s = std::sin(angle);
        const Vec3 q = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
        return Point(scale * Vec3{q.x, c * q.y - s * q.z, s * q.y + c * q.z} + offset);
    }
    Outline operator()(Outline outline) const {
        for (Point& p : outline) p = (*this)(p);
        return outline;
    }
    ConvexBlocker operator()(ConvexBlocker body) const {
        body.points = (*this)(body.points);
        for (std::size_t k = 0; k < body.faces.size(); ++k) {
            Outline face;
            for (std::uint32_t i : body.loops[k]) face.push_back(body.points[i]);
            const Normal n = normalized(area_vector(face));
            body.faces[k] = {n, dot(n, face[0])};
        }
        return body;
    }
};

/// A wall and blocks stand on the receiver, so that their lower edges coincide with the horizon of all its points, and
/// one block touches the wall. Far from the origin they do so up to the rounding of coordinates.
TEST(VisibleFromMany, EdgesOnTheHorizonMayBeOffByTheRoundingOfCoordinates) {
    const Outline wall = {{3, -1, 0}, {3, -1, 2}, {3, 1, 2}, {3, 1, 0}};
    const ConvexBlocker one = box({1.5, -0.5, 0}, {2, 0.25, 0.75}), two = box({2.25, 0, 0}, {3, 0.5, 1});
    const std::vector<std::vector<const ConvexBlocker*>> cases = {{&one}, {&two}, {&one, &two}};
    const Outline floor = floor_square(0, 0, 1);
    for (const auto& blockers : cases)
        for (int k = 0; k < 40; ++k) {
            const bool is_far = k % 2 == 1;
            const Placement place = {0.37 * k, is_far ? 1e-3 : 1.0, is_far ? Vec3{1000, -700, 300} : Vec3{3, -2, 5}};
            std::vector<ConvexBlocker> bodies;
            std::vector<const ConvexBlocker*> pointers;
            for (const ConvexBlocker* b : blockers) bodies.push_back(place(*b));
            for (const ConvexBlocker& b : bodies) pointers.push_back(&b);
            const Outline source = place(wall), receiver = place(floor);
            const PlaneFrame frame(receiver[0], normalized(area_vector(receiver)));
            std::vector<Vec2> corners, points;
            for (const Point& p : receiver) corners.push_back(frame.flat(p));
            std::vector<Point> exact;
            for (int i = 0; i < 25; ++i) {
                exact.push_back({-0.93 + 0.44 * (i % 5), -0.91 + 0.43 * (i / 5), 0});
                points.push_back(frame.flat(place(exact.back())));
            }
            VisibleFromMany many;
            VisibleSource alone;
            ASSERT_EQ(many.set(frame, corners, source, pointers), VisibleFromMany::Outlook::partly);
            alone.set(wall, blockers);
            std::vector<double> F(points.size());
            std::vector<Seen> seen(points.size());
            many(points, std::array{points.size()}, F, seen);
            // A coordinate of 1000 in a model of size 1e-3 has a relative rounding of 1e-10.
            for (std::size_t i = 0; i < F.size(); ++i)
                EXPECT_NEAR(F[i], alone(exact[i], {0, 0, 1}, seen[i]), is_far ? 1e-8 : 1e-13) << k << ' ' << i;
        }
}

TEST(VisibleFromMany, SupportsSourcesWithManyCorners) {
    Outline disc;
    constexpr int corners = 40;
    for (int k = corners; k-- > 0;) {
        const double t = 2 * pi * k / corners;
        disc.push_back({std::cos(t), std::sin(t), 2});
    }
    const ConvexBlocker a = box({-0.3, -0.2, 0.5}, {0.2, 0.4, 1.1}), b = box({0.3, -0.6, 0.7}, {0.8, 0.1, 0.9});
    const std::vector<const ConvexBlocker*> both = {&a, &b};
    RandomStream random(4, Stream::mesh);
    for (int k = 0; k < 30; ++k)
        compare(2 * random.uniform() - 1, 2 * random.uniform() - 1, 0.5 * random.uniform(), both, random, "disc", disc);
}

TEST(VisibleFromMany, DetectsOneBlockerHidingAllAndNoneHidingAny) {
    const ConvexBlocker body = box({-2, -2, 0.9}, {2, 2, 1.1});
    const std::array<const ConvexBlocker*, 1> blockers = {&body};
    VisibleFromMany many;
    EXPECT_EQ(many.set(floor_frame, corners_of(floor_square(0, 0, 0.5)), ceiling, blockers),
              VisibleFromMany::Outlook::hidden);
    EXPECT_EQ(many.set(floor_frame, corners_of(floor_square(3, 0, 0.5)), ceiling, blockers),
              VisibleFromMany::Outlook::partly);
    EXPECT_EQ(many.set(floor_frame, corners_of(floor_square(9, 0, 0.5)), ceiling, blockers),
              VisibleFromMany::Outlook::clear);
}

}  // namespace
}  // namespace exitance
