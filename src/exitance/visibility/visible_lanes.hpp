#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "exitance/base/processor.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// A source and the convex things before it, as all points of a plane see them. Lengths and places are those of a frame
/// in which that plane is z = 0 and its normal +z.
///
/// A line of sight from x over an edge (a, b) has a place p on its inner side where det(b - x, a - x, p - x) > 0. That
/// is an affine function of x: with three coefficients a corner of the source is told to lie within the pyramid over a
/// blocker's silhouette, or not, from any point of the receiver.
struct SightTables {
    static constexpr std::size_t most_corners = 12, most_lines = 12, lanes = 8;
    static constexpr std::size_t most_blockers = 4;

    /// c + u x + v y, m^3 (m for planes of faces).
    struct Affine {
        double c = 0, u = 0, v = 0;
    };
    enum class Outline : std::uint8_t {
        always,           ///< Of the silhouette from everywhere, its inner side known.
        before_a_face,    ///< Where one face is seen from its front.
        behind_a_face,    ///< Where it is not.
        between_two,      ///< Where one of two faces is seen; reversed where that is the second.
        of_a_turning_one  ///< A sheet's, of which both sides are seen; reversed where it is seen from behind.
    };
    struct Line {
        Vec3 a, along;             ///< The edge.
        double none = 0, tie = 0;  ///< m^3: below it a height is none; two edges may be one.
        Outline outline = Outline::always;
        std::uint32_t left = 0, right = 0;  ///< In faces.
        std::uint32_t over = 0;    ///< In heights: of the source's corners over this line, then of a and of b over
                                   ///< each of the source's edges, two an edge.
        std::uint32_t cuts = 0;    ///< Corners of the source that may lie outside, a bit each.
        std::uint32_t cut_by = 0;  ///< Edges of the source that may have some of it outside.
        bool is_drawn = true;      ///< May the edge lie before the source?
    };
    struct Blocker {
        std::uint32_t first = 0, last = 0;            ///< In lines.
        std::uint32_t first_face = 0, last_face = 0;  ///< Those that turn.
        bool may_hold = false;                        ///< May a point lie inside?
        bool is_seen = false;                         ///< Is one of its faces seen from everywhere?
    };

    std::vector<Vec3> corners;  ///< Of the source.
    std::vector<Vec3> along;    ///< Its edges.
    std::vector<Blocker> blockers;
    std::vector<Line> lines;
    std::vector<Affine> faces, heights;
    /// Of the ends of a line over the lines of another blocker: where the table of two blockers begins in `heights`.
    /// Lines that fall together from everywhere have `on_one_line` as `u`; positive `c` says that they run alike.
    static constexpr double on_one_line = HUGE_VAL;
    std::array<std::uint32_t, most_blockers * most_blockers> between;
};

/// What up to eight points see; a bit a point.
struct Views {
    std::array<double, SightTables::lanes> F{};  ///< Form factors to the visible part.
    int lit = 0;                                 ///< Sees all.
    int dark = 0;                                ///< One blocker hides all.
    int doubtful = 0;                            ///< Edges fall together: F is to be found otherwise.
};

/// Form factors from points to the visible part, exact but for rounding: by inclusion and exclusion of blockers,
///
///     F = F(source) - sum_k F(source and k) + sum_k<l F(source and k and l) - ...
///
/// where the border of what lies in several convex cones at once consists of the parts of each cone's edges that lie in
/// all others. A point is given the same bits whatever the others are and whatever the processor offers. u and v have
/// eight entries, of which `count` are wanted. About 60 ns a point behind one body.
Views look_from_points(const SightTables& tables, const double* u, const double* v, std::size_t count,
                       Processor processor = Processor::fastest);

}  // namespace exitance
