#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "exitance/base/processor.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// A source and its convex blockers, as seen from all points of a plane. Coordinates are in metres in a frame in which
/// that plane is z = 0 and its normal +z.
///
/// As seen from x, a point p is on the inner side of an edge (a, b) if det(b - x, a - x, p - x) > 0. That is an affine
/// function of x with three coefficients. These suffice to test, from any point of the receiver, whether a corner of
/// the source is inside the pyramid over a blocker's silhouette.
struct SightTables {
    static constexpr std::size_t max_corners = 12, max_lines = 12, lanes = 8;
    static constexpr std::size_t max_blockers = 4;

    /// c + u x + v y, m^3 (m for face planes).
    struct Affine {
        double c = 0, u = 0, v = 0;
    };
    enum class Outline : std::uint8_t {
        always,           ///< The edge is on the outline from all points, with a known inner side.
        before_a_face,    ///< The edge is on the outline from points in front of face `left`.
        behind_a_face,    ///< The edge is on the outline from points behind face `left`.
        between_two,      ///< From points in front of exactly one of two faces; reversed if it is the second.
        of_a_turning_one  ///< Edge of a sheet seen from both sides; reversed from points behind it.
    };
    struct Line {
        Vec3 a, along;             ///< The edge.
        double none = 0, tie = 0;  ///< m^3: heights below `none` count as zero; below `tie`, two edges may coincide.
        Outline outline = Outline::always;
        std::uint32_t left = 0, right = 0;  ///< Indices into `faces`.
        /// Index into `heights` of the first height for this line. First come the heights of the source's corners over
        /// the line, then, for each edge of the source, those of the line's ends a and b over that edge.
        std::uint32_t over = 0;
        std::uint32_t cuts = 0;    ///< Bit mask of corners of the source that may be outside.
        std::uint32_t cut_by = 0;  ///< Bit mask of edges of the source that may have part of the line outside.
        bool is_drawn = true;      ///< False if the edge never appears in front of the source.
    };
    struct Blocker {
        std::uint32_t first = 0, last = 0;  ///< Range in `lines`.
        std::uint32_t first_face = 0,
                      /// End of the range in `faces` of the faces that are front-facing from some points only.
            last_face = 0;
        bool may_hold = false;  ///< True if a point may be inside the blocker.
        bool is_seen = false;   ///< True if one of its faces is visible from everywhere.
    };

    std::vector<Vec3> corners;  ///< Corners of the source.
    std::vector<Vec3> along;    ///< Edges of the source.
    std::vector<Blocker> blockers;
    std::vector<Line> lines;
    std::vector<Affine> faces, heights;
    /// Index into `heights` of the table of each pair of blockers: the heights of the ends of the lines of one over the
    /// lines of the other. Pairs of lines that coincide from everywhere have `on_one_line` as `u`; `c` > 0 if their
    /// directions agree.
    static constexpr double on_one_line = HUGE_VAL;
    std::array<std::uint32_t, max_blockers * max_blockers> between;
};

/// Results for up to eight points. Masks have one bit per point.
struct Views {
    std::array<double, SightTables::lanes> F{};  ///< Form factors to the visible part.
    int lit = 0;                                 ///< Points from which the whole source is visible.
    int dark = 0;                                ///< Points from which one blocker hides the whole source.
    int doubtful = 0;                            ///< Edges coincide: F must be computed by another method.
};

/// Form factors from points to the visible part, exact except for rounding, by inclusion and exclusion of blockers:
///
///     F = F(source) - sum_k F(source and k) + sum_k<l F(source and k and l) - ...
///
/// The border of the intersection of several convex cones consists of the parts of each cone's edges that are inside
/// all others. The result for a point is bitwise independent of the other points and of the processor. u and v hold
/// eight coordinates, of which the first `count` are used. About 60 ns per point behind one body.
Views look_from_points(const SightTables& tables, const double* u, const double* v, std::size_t count,
                       Processor processor = Processor::fastest);

}  // namespace exitance
