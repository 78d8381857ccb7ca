#include <algorithm>
#include <cmath>

#include "exitance/base/quadrature.hpp"
#include "exitance/view_factors/occluded_pair.hpp"

namespace exitance {
namespace {

/// Limits on the critical lines by which a part of a receiver is cut, and on the resulting parts.
constexpr std::size_t max_lines = 24, max_cell_parts = 200;
constexpr int max_cell_halvings = 6;  ///< A receiver with more lines is halved up to this number of times.

}  // namespace

/// Cuts a part along a critical line. Returns false if the line, or the range of it where visibility changes, does not
/// cross the part.
bool OccludedExchange::cut(const Part& part, const CriticalLine& line, Part& front, Part& back) const {
    const double near = nearest_line * size_;
    std::array<double, Part::max_corners> d;
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (std::size_t i = 0; i < part.count; ++i) {
        d[i] = line.signed_distance(part.corner[i]);
        if (std::abs(d[i]) <= near) d[i] = 0;
        lowest = std::min(lowest, d[i]), highest = std::max(highest, d[i]);
    }
    if (lowest >= 0 || highest <= 0) return false;
    double enters = HUGE_VAL, leaves = -HUGE_VAL;
    front.count = back.count = 0;
    for (std::size_t i = 0; i < part.count; ++i) {
        const std::size_t j = i + 1 == part.count ? 0 : i + 1;
        if (d[i] >= 0) front.add(part.corner[i]);
        if (d[i] <= 0) back.add(part.corner[i]);
        Vec2 at = part.corner[i];
        if (d[i] * d[j] < 0) {
            at = at + (d[i] / (d[i] - d[j])) * (part.corner[j] - at);
            front.add(at), back.add(at);
        } else if (d[i] != 0) {
            continue;
        }
        enters = std::min(enters, line.along(at)), leaves = std::max(leaves, line.along(at));
    }
    return line.first < leaves - near && line.last > enters + near && front.count >= 3 && back.count >= 3;
}

/// Cuts a part of the receiver along the critical lines where visibility changes, and adds triangles and quadrilaterals
/// to cells_. A part with too many lines is halved first, since each half has fewer.
void OccludedExchange::cut_into_cells(const Part& part, int depth) {
    if (cells_.size() > max_cells_) return;
    finder_.find(frame_, part.corners(), pair_.source, visible_.seen_edges(), nearest_line * size_, max_lines, lines_);
    Part front, back;
    if (lines_.size() >= max_lines && depth < max_cell_halvings) {
        std::size_t longest = 0;
        Vec2 along{};
        for (std::size_t i = 0; i < part.count; ++i) {
            const Vec2 e = part.corner[(i + 1) % part.count] - part.corner[i];
            if (dot(e, e) > dot(along, along)) along = e, longest = i;
        }
        const Vec2 n = (1 / std::sqrt(dot(along, along))) * along;
        const double offset = dot(n, 0.5 * (part.corner[longest] + part.corner[(longest + 1) % part.count]));
        if (cut(part, {n, offset, -HUGE_VAL, HUGE_VAL}, front, back)) {
            const Part other = back;
            cut_into_cells(front, depth + 1);
            cut_into_cells(other, depth + 1);
            return;
        }
    }
    parts_.assign(1, part);
    bool complete = lines_.size() < max_lines;
    for (const CriticalLine& line : lines_) {
        complete &= parts_.size() <= max_cell_parts;
        if (!complete && parts_.size() > max_cell_parts) break;
        for (std::size_t i = 0, count = parts_.size(); i < count; ++i)
            if (cut(parts_[i], line, front, back)) {
                parts_[i] = front;
                parts_.push_back(back);
            }
    }
    for (const Part& convex : parts_) {
        std::size_t first = 1;
        while (convex.count - first >= 2) {  // a fan of quadrilaterals, with a triangle at the end if needed
            Cell piece;
            const std::size_t take = std::min<std::size_t>(3, convex.count - first);
            piece.add(convex.corner[0]);
            for (std::size_t i = 0; i < take; ++i) piece.add(convex.corner[first + i]);
            first += take - 1;
            piece.complete = complete;
            cells_.push_back(piece);
        }
    }
}

/// Adds Gauss points of a triangle or quadrilateral: n x n on a quadrilateral, those of degree 2n - 1 on a triangle.
void OccludedExchange::place_nodes(const Cell& cell, int points) {
    const Vec2 o = cell.corner[0], a = cell.corner[1] - o;
    if (cell.count == 3) {
        const Vec2 b = cell.corner[2] - o;
        const double area = std::abs(cross(a, b)) / 2;
        for (const PlanarNode& k : triangle_rule(points == 2 ? 2 : 2 * points - 1)) {
            nodes_.push_back(o + k.at.x * a + k.at.y * b);
            weights_.push_back(area * k.weight);
        }
        return;
    }
    const Vec2 b = cell.corner[3] - o, c = cell.corner[2] - cell.corner[1] - b;
    for (const PlanarNode& k : square_rule(points)) {
        const double u = k.at.x, v = k.at.y;
        nodes_.push_back(o + u * a + v * b + (u * v) * c);
        weights_.push_back(k.weight * cross(a + v * c, b + u * c));
    }
}

}  // namespace exitance
