#include "exitance/shadow_lines/three_edge_events.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "exitance/scene/scene.hpp"
#include "exitance/transport/stage.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// An infinite straight line.
struct SightLine {
    Point at;
    Vec3 along;
};

/// Determinant of the three planes through x and each line; 0 if one line of sight from x meets all three lines. It is
/// quadratic in x, since its cubic part vanishes.
double three_line_determinant(const Point& x, const std::array<SightLine, 3>& lines) {
    std::array<Vec3, 3> n;
    for (std::size_t i = 0; i < 3; ++i) n[i] = cross(lines[i].at - x, lines[i].along);
    return dot(n[0], cross(n[1], n[2]));
}

constexpr std::array<SightLine, 3> skew{{{{0, 0, 3}, {1, 0, 0}}, {{0, 0, 2}, {0, 1, 0}}, {{0, 1, 1}, {1, 1, 0}}}};

TEST(ThreeLineDeterminant, IsZeroOnTheConicOfThreeSkewLines) {
    // From x = (x, y, 0): the line through (s, 0, 3) and (0, t, 2) meets the floor at (-2 s, 3 t), and height 1 at (-s,
    // 2 t). That point is on y = 1 + x if t = (1 - s) / 2. The floor's curve is thus (-2 s, 3 (1 - s) / 2), a line.
    for (const double s : {-1.0, 0.3, 2.0})
        EXPECT_NEAR(three_line_determinant({-2 * s, 1.5 * (1 - s), 0}, skew), 0, 1e-12);
    EXPECT_GT(std::abs(three_line_determinant({0.5, 0.2, 0}, skew)), 0.1);
    // The cubic part cancels: third differences along any line are zero.
    double d[4];
    for (int i = 0; i < 4; ++i) d[i] = three_line_determinant({0.1 + 0.7 * i, 0.3 - 0.2 * i, 0.9 * i}, skew);
    EXPECT_NEAR(d[3] - 3 * d[2] + 3 * d[1] - d[0], 0, 1e-9);
}

/// A source 2 m wide at a height of 3 m, and below it two half-planes whose edges cross at an angle as seen from the
/// floor.
Scene two_blades() {
    return test::make({{{{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}}, 0},
                       {{{-1, 1, 3}, {1, 1, 3}, {1, -1, 3}, {-1, -1, 3}}, 100},
                       {{{0, -3, 2}, {0, 3, 2.3}, {-3, 3, 2.3}, {-3, -3, 2}}, 0},
                       {{{-3, -0.4, 1}, {3, 0.4, 1.2}, {3, 3, 1.2}, {-3, 3, 1}}, 0}});
}

TEST(ThreeEdgeEvents, LieOnTheirConicAndBoundTheUmbra) {
    const Scene scene = two_blades();
    const Stage stage(scene);
    const BlockerEdges edges(stage.occluders);
    std::vector<std::uint32_t> all(edges.edges().size());
    std::iota(all.begin(), all.end(), 0u);
    const Region& floor = scene.regions()[RegionId(0)];
    const Region& lamp = scene.regions()[RegionId(1)];
    const PlaneFrame frame({0, 0, 0}, floor.plane.n);
    const EventSource source{lamp.loops, lamp.plane, RegionId(1), false, 2};
    std::vector<ThreeEdgeEvent> events;
    ThreeEdgeEventFinder finder(stage.occluders, edges);
    finder.find({frame, RegionId(0), {-4, -4}, {4, 4}}, source, all, false, 1e-4, events);
    ASSERT_FALSE(events.empty());
    const std::array<SightLine, 2> blades{{{{0, -3, 2}, {0, 6, 0.3}}, {{-3, -0.4, 1}, {6, 0.8, 0.2}}}};
    const std::array<SightLine, 4> sides{
        {{{-1, 1, 3}, {1, 0, 0}}, {{1, 1, 3}, {0, 1, 0}}, {{1, -1, 3}, {1, 0, 0}}, {{-1, -1, 3}, {0, 1, 0}}}};
    std::size_t at_umbra = 0;
    for (const ThreeEdgeEvent& e : events) {
        at_umbra += e.may_bound_umbra;
        for (const Vec2 place : e.places) {
            double least = 1;
            for (const SightLine& side : sides)
                least =
                    std::min(least, std::abs(three_line_determinant(frame.at(place), {side, blades[0], blades[1]})));
            EXPECT_LT(least, 1e-6);
        }
    }
    // Each blade hides half of the source. The corner of the remaining quarter vanishes last, without passing any edge
    // of the source.
    EXPECT_GT(events.size(), at_umbra);
    std::vector<ThreeEdgeEvent> umbra;
    finder.find({frame, RegionId(0), {-4, -4}, {4, 4}}, source, all, true, 1e-4, umbra);
    EXPECT_EQ(umbra.size(), at_umbra);
    // The second derivative of direct light jumps there: the difference between both sides stays when the step is
    // halved, whereas that of smooth light would halve. Next to an umbra, one side is dark.
    DirectLight::Workspace workspace;
    for (const ThreeEdgeEvent& e : events) {
        const Vec2 a = e.places[e.places.size() / 2 - 1], b = e.places[e.places.size() / 2], m = 0.5 * (a + b);
        const double l = std::hypot(b.x - a.x, b.y - a.y);
        const Vec2 across{-(b.y - a.y) / l, (b.x - a.x) / l};
        const auto light = [&](double d) {
            return stage.direct.irradiance(frame.at(m + d * across), floor.plane.n, RegionId(0), workspace)[0];
        };
        const auto jump = [&](double h) {
            const double right = light(h) - 2 * light(2 * h) + light(3 * h);
            const double left = light(-h) - 2 * light(-2 * h) + light(-3 * h);
            return std::abs(right - left) / (h * h);
        };
        constexpr double step = 0.004;
        EXPECT_GT(jump(step / 2), 0.8 * jump(step));
        EXPECT_GT(jump(step / 2), 0.1);
        if (e.may_bound_umbra) {
            EXPECT_NEAR(std::min(light(5 * step), light(-5 * step)), 0, 1e-9);
            EXPECT_GT(std::max(light(5 * step), light(-5 * step)), 1e-6);
        }
    }
}

TEST(NonEmitterEvents, LieInThePlaneOfACornerAndAnEdge) {
    // A triangle's corner beneath the lamp, and a blade above it.
    const Scene scene = test::make({{{{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}}, 0},
                                    {{{-1, 1, 3}, {1, 1, 3}, {1, -1, 3}, {-1, -1, 3}}, 100},
                                    {{{0, -3, 2}, {0, 3, 2.3}, {-3, 3, 2.3}, {-3, -3, 2}}, 0},
                                    {{{0.1, 0.05, 1}, {2, -1, 1}, {2, 1, 1.1}}, 0}});
    const Stage stage(scene);
    const BlockerEdges edges(stage.occluders);
    std::vector<std::uint32_t> all(edges.edges().size());
    std::iota(all.begin(), all.end(), 0u);
    const Region& lamp = scene.regions()[RegionId(1)];
    const PlaneFrame frame({0, 0, 0}, scene.regions()[RegionId(0)].plane.n);
    const EventSource source{lamp.loops, lamp.plane, RegionId(1), false, 2};
    std::vector<ShadowEvent> events;
    ShadowEventFinder(stage.occluders, edges)
        .find_non_emitter(frame, RegionId(0), {-4, -4}, {4, 4}, source, all, events);
    // The event of the corner and the blade's edge is where the lines of sight through both meet the floor.
    const Point corner{0.1, 0.05, 1};
    const auto of_corner = [&](const ShadowEvent& e) {
        for (const Vec2 end : {e.a, e.b}) {
            const Vec3 d = corner - frame.at(end);
            const double t = -frame.at(end).x / d.x;  // where the line crosses x = 0
            const Point at = frame.at(end) + t * d;
            if (std::abs(at.z - (2 + 0.05 * (at.y + 3))) > 1e-9) return false;
            const Point on_lamp = frame.at(end) + (3 / d.z) * d;
            if (std::max(std::abs(on_lamp.x), std::abs(on_lamp.y)) > 1 + 1e-9) return false;
        }
        return true;
    };
    EXPECT_TRUE(std::any_of(events.begin(), events.end(), of_corner));
    for (const ShadowEvent& e : events) EXPECT_TRUE(e.by_blockers_alone);
}

}  // namespace
}  // namespace exitance
