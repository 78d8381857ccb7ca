#include "exitance/visibility/critical_lines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace exitance {
namespace {

using Outline = std::vector<Point>;

std::vector<CriticalLine> lines_of(const Outline& receiver, const Outline& source,
                                   const std::vector<const ConvexBlocker*>& blockers) {
    const PlaneFrame frame(receiver[0], normalized(area_vector(receiver)));
    std::vector<Vec2> flat;
    for (const Point& p : receiver) flat.push_back(frame.flat(p));
    std::vector<std::vector<std::uint32_t>> all;
    std::vector<SeenEdges> seen;
    for (const ConvexBlocker* blocker : blockers) {
        all.emplace_back(blocker->edges.size());
        std::iota(all.back().begin(), all.back().end(), 0u);
    }
    for (std::size_t k = 0; k < blockers.size(); ++k) seen.push_back({blockers[k], all[k], {}, {}});
    std::vector<CriticalLine> lines;
    CriticalLineFinder().find(frame, flat, source, seen, 1e-6, 64, lines);
    return lines;
}

const Outline floor_square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const Outline unit_ceiling = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};

TEST(CriticalLines, AStripYieldsThePenumbraLinesOfItsTwoEdges) {
    // A strip x in [0.4, 0.7], longer than the receiver in y. The ends of the source at x = 0 and 1 appear on its edges
    // at x = 0.8 and 0.4 (edges 0.4 and 0.7); -0.2 and 1.4 are outside.
    const ConvexBlocker strip =
        make_sheet(Outline{{0.4, -2, 0.5}, {0.7, -2, 0.5}, {0.7, 3, 0.5}, {0.4, 3, 0.5}}, {{0, 0, 1}, 0.5});
    const std::vector<CriticalLine> lines = lines_of(floor_square, unit_ceiling, {&strip});
    const PlaneFrame frame(floor_square[0], {0, 0, 1});
    std::vector<double> places;
    for (const CriticalLine& line : lines) {
        const Point foot = frame.at(line.offset * line.n);
        EXPECT_NEAR(foot.y, 0, 1e-12);  // all lines are parallel to the y axis
        places.push_back(foot.x);
    }
    std::sort(places.begin(), places.end());
    ASSERT_EQ(places.size(), 2u);
    EXPECT_NEAR(places[0], 0.4, 1e-12);
    EXPECT_NEAR(places[1], 0.8, 1e-12);
}

TEST(CriticalLines, AFinOnTheReceiverYieldsALineAlongItsFoot) {
    const ConvexBlocker fin =
        make_sheet(Outline{{0.5, 0, 0}, {0.5, 1, 0}, {0.5, 1, 0.6}, {0.5, 0, 0.6}}, {{1, 0, 0}, 0.5});
    const PlaneFrame frame(floor_square[0], {0, 0, 1});
    bool foot = false;
    for (const CriticalLine& line : lines_of(floor_square, unit_ceiling, {&fin}))
        foot |= std::abs(frame.at(line.offset * line.n).x - 0.5) < 1e-12;
    EXPECT_TRUE(foot);
}

TEST(CriticalLines, ABlockerOutsideTheShaftYieldsNoLine) {
    const ConvexBlocker aside = make_sheet(Outline{{3, 0, 0.5}, {4, 0, 0.5}, {4, 1, 0.5}}, {{0, 0, 1}, 0.5});
    EXPECT_TRUE(lines_of(floor_square, unit_ceiling, {&aside}).empty());
}

TEST(CriticalLines, TheGapBetweenTwoPlatesClosesOnALine) {
    // Plates with edges x = 0.5 at height 0.3 (on the left) and x = 0.6 at height 0.6 (on the right): the line of sight
    // along both edges ends at x = 0.4.
    const ConvexBlocker low =
        make_sheet(Outline{{-3, -3, 0.3}, {0.5, -3, 0.3}, {0.5, 4, 0.3}, {-3, 4, 0.3}}, {{0, 0, 1}, 0.3});
    const ConvexBlocker high =
        make_sheet(Outline{{0.6, -3, 0.6}, {4, -3, 0.6}, {4, 4, 0.6}, {0.6, 4, 0.6}}, {{0, 0, 1}, 0.6});
    const PlaneFrame frame(floor_square[0], {0, 0, 1});
    bool closes = false;
    for (const CriticalLine& line : lines_of(floor_square, unit_ceiling, {&low, &high}))
        closes |= std::abs(frame.at(line.offset * line.n).x - 0.4) < 1e-12;
    EXPECT_TRUE(closes);
}

}  // namespace
}  // namespace exitance
