#include "exitance/transport/visible_lanes.hpp"

#include <cmath>

#include "exitance/transport/four.hpp"

namespace exitance {
namespace {

using namespace four;
constexpr std::size_t most_corners = SightTables::most_corners, most_lines = SightTables::most_lines;
constexpr std::size_t most_blockers = SightTables::most_blockers;
constexpr int all_lanes = 15;
static_assert(SightTables::lanes == four::lanes);

/// The part of an edge that lies within something convex: from + t (to - from).
struct Part {
    Real from, to;
};

/// Takes away what lies outside a plane, by the heights of the edge's ends over it.
EXITANCE_INLINE void clip(const Real& start, const Real& end, double tie, Part& part, Mask& doubtful) {
    const Mask start_out = start < 0, end_out = end < 0;
    if (!any(start_out | end_out)) return;
    doubtful |= (max(start, -start) < tie) & (max(end, -end) < tie) & (part.from < part.to);
    const Real t = start / (start - end);
    part.from = start_out ? (end_out ? Real{} + 2 : max(part.from, t)) : part.from;
    part.to = end_out & ~start_out ? min(part.to, t) : part.to;
}

/// An edge as four points see it.
struct Edge {
    Real crossed, turn, squared, slope;  ///< |a x d|^2, n . (a x d), a . a and a . d for the edge a + t d.
    double along;                        ///< d . d

    EXITANCE_INLINE Edge() {}
    EXITANCE_INLINE Edge(const Vec& a, const Vec3& d) {
        const Vec c = {a.y * d.z - a.z * d.y, a.z * d.x - a.x * d.z, a.x * d.y - a.y * d.x};
        crossed = dot(c, c);
        turn = c.z;
        squared = dot(a, a);
        slope = dot(d, a);
        along = dot(d, d);
    }
    /// What a part of it adds to Lambert's sum.
    EXITANCE_INLINE Real share(const Part& part) const {
        const Real t = max(part.to - part.from, Real{});
        const Real squared_sine = t * t * crossed;
        const Real cosine = squared + (part.from + part.to) * slope + part.from * part.to * along;
        return angle_over_root(squared_sine, cosine) * t * turn;
    }
};

/// Works through one group of points.
struct Group {
    const SightTables& tables;
    Real u, v;
    Edge source[most_corners];
    Real whole[most_corners];  ///< Shares of the source's edges.
    Mask in_front[64];         ///< Of faces that turn.
    struct Shadow {
        std::uint32_t blocker;
        Mask beside;
        Part of_source[most_corners];  ///< Of the source's edges, within the blocker's pyramid.
        Part of_line[most_lines];      ///< Of the pyramid's edges, within the source.
        Edge line[most_lines];
        Real side[most_lines];  ///< 1, -1 where the line is reversed, 0 where it is no outline.
    };
    Shadow shadows[most_blockers];
    Part past[most_blockers][most_lines][most_blockers];  ///< Of a shadow's lines within another one's pyramid.
    Mask doubtful;

    EXITANCE_INLINE Group(const SightTables& t, const double* of_u, const double* of_v)
        : tables(t), u(load(of_u)), v(load(of_v)) {}
    EXITANCE_INLINE Real at(const SightTables::Affine& f) const { return f.c + f.u * u + f.v * v; }

    /// How a line runs: 1, reversed -1, not at all 0.
    EXITANCE_INLINE Real side_of(const SightTables::Line& line) const {
        const Real one = Real{} + 1, nothing = {};
        switch (line.outline) {
            case SightTables::Outline::always:
                return one;
            case SightTables::Outline::before_a_face:
                return in_front[line.left] ? one : nothing;
            case SightTables::Outline::behind_a_face:
                return in_front[line.left] ? nothing : one;
            case SightTables::Outline::between_two: {
                const Mask other = in_front[line.left] ^ in_front[line.right];
                return other ? (in_front[line.left] ? one : -one) : nothing;
            }
            case SightTables::Outline::of_a_turning_one:
                break;
        }
        return in_front[line.left] ? one : -one;
    }
    /// A height over a line, where it runs; else as of what lies inside.
    EXITANCE_INLINE Real over(const SightTables::Line& line, const SightTables::Affine& f, const Real& side) const {
        const Real h = at(f);
        if (line.outline == SightTables::Outline::always) return h;
        return side != 0 ? side * h : Real{} + 1;
    }

    /// Finds what of the source's edges lies within a blocker's pyramid, and the other way about. False when it hides
    /// nothing from any point. `dark` gets those from which it hides all.
    EXITANCE_INLINE bool add_shadow(std::uint32_t k, Shadow& shadow, Mask& dark) {
        const SightTables::Blocker& blocker = tables.blockers[k];
        const std::size_t count = tables.corners.size();
        shadow.blocker = k;
        shadow.beside = Mask{};
        Mask seen = blocker.is_seen ? ~Mask{} : Mask{};
        for (std::uint32_t f = blocker.first_face; f < blocker.last_face; ++f) {
            in_front[f] = at(tables.faces[f]) > 0;
            seen |= in_front[f];
        }
        Mask reaches_out = Mask{};
        Real heights[most_lines][most_corners];
        for (std::uint32_t l = blocker.first; l < blocker.last; ++l) {
            const SightTables::Line& line = tables.lines[l];
            const std::uint32_t i = l - blocker.first;
            shadow.side[i] = side_of(line);
            Mask any_in = Mask{};
            for (std::size_t s = 0; s < count; ++s) {
                const Real h = over(line, tables.heights[line.over + s], shadow.side[i]);
                heights[i][s] = h;
                any_in |= h > line.none;
                if (line.cuts >> s & 1) reaches_out |= h < -line.none;
            }
            shadow.beside |= ~any_in;
        }
        if (blocker.may_hold) {
            shadow.beside &= seen;
            dark |= ~seen;
        }
        dark |= ~(reaches_out | shadow.beside);
        if (!any(~shadow.beside)) return false;
        const Part all = {shadow.beside ? Real{} + 2 : Real{}, Real{} + 1};
        for (std::size_t s = 0; s < count; ++s) {
            const std::size_t next = s + 1 == count ? 0 : s + 1;
            Part part = all;
            const std::uint32_t ends = 1u << s | 1u << next;
            for (std::uint32_t i = 0; i < blocker.last - blocker.first; ++i)
                if (tables.lines[blocker.first + i].cuts & ends)
                    clip(heights[i][s], heights[i][next], tables.lines[blocker.first + i].tie, part, doubtful);
            shadow.of_source[s] = part;
        }
        for (std::uint32_t l = blocker.first; l < blocker.last; ++l) {
            const SightTables::Line& line = tables.lines[l];
            const std::uint32_t i = l - blocker.first;
            Part part = all;
            part.from = shadow.side[i] != 0 ? part.from : Real{} + 2;
            if (!line.is_drawn) part.from = Real{} + 2;
            Mask untold = Mask{};  // ties were met above
            for (std::size_t s = 0; s < count && line.is_drawn; ++s)
                if (line.cut_by >> s & 1)
                    clip(at(tables.heights[line.over + count + 2 * s]),
                         at(tables.heights[line.over + count + 2 * s + 1]), 0, part, untold);
            shadow.of_line[i] = part;
            if (any(part.from < part.to))
                shadow.line[i] = Edge({line.a.x - u, line.a.y - v, Real{} + line.a.z}, line.along);
        }
        return true;
    }

    /// The parts of a shadow's lines within another one's pyramid.
    EXITANCE_INLINE void clip_lines(std::size_t of, std::size_t by) {
        const SightTables::Blocker &mine = tables.blockers[shadows[of].blocker],
                                   &other = tables.blockers[shadows[by].blocker];
        std::uint32_t place = tables.between[shadows[of].blocker * most_blockers + shadows[by].blocker];
        for (std::uint32_t i = 0; i < mine.last - mine.first; ++i) {
            Part part = {shadows[by].beside ? Real{} + 2 : shadows[of].of_line[i].from, shadows[of].of_line[i].to};
            for (std::uint32_t l = other.first; l < other.last; ++l, place += 2) {
                if (!any(part.from < part.to)) continue;
                const SightTables::Line& line = tables.lines[l];
                const Real& side = shadows[by].side[l - other.first];
                const SightTables::Affine &start = tables.heights[place], &end = tables.heights[place + 1];
                if (start.u != SightTables::on_one_line) {
                    clip(over(line, start, side), over(line, end, side), line.tie, part, doubtful);
                    continue;
                }
                // Where both blockers lie to one side, the first one's edge alone is the border of what both hide.
                const bool is_first = shadows[of].blocker < shadows[by].blocker;
                const Real alike = start.c * side * shadows[of].side[i];
                part.from = alike < 0 || (alike > 0 && !is_first) ? Real{} + 2 : part.from;
            }
            past[of][i][by] = part;
        }
    }

    /// Lambert's sum over the border of what lies in the source and in several pyramids at once. False when that is
    /// nothing for all points.
    EXITANCE_INLINE bool common_part(unsigned chosen, std::size_t count, Real& sum, int& any_hidden) const {
        int something = 0;
        sum = Real{};
        for (std::size_t s = 0; s < tables.corners.size(); ++s) {
            Part part = {Real{}, Real{} + 1};
            for (std::size_t k = 0; k < count; ++k) {
                if ((chosen >> k & 1) == 0) continue;
                part.from = max(part.from, shadows[k].of_source[s].from);
                part.to = min(part.to, shadows[k].of_source[s].to);
            }
            const int lies_within = bits(part.from < part.to);
            if (lies_within == 0) continue;
            something |= lies_within;
            if (any((part.from > 0) | (part.to < 1)))
                sum += source[s].share(part);
            else
                sum += whole[s];
        }
        for (std::size_t k = 0; k < count; ++k) {
            if ((chosen >> k & 1) == 0) continue;
            const SightTables::Blocker& blocker = tables.blockers[shadows[k].blocker];
            for (std::uint32_t i = 0; i < blocker.last - blocker.first; ++i) {
                Part part = shadows[k].of_line[i];
                for (std::size_t j = 0; j < count; ++j) {
                    if (j == k || (chosen >> j & 1) == 0) continue;
                    part.from = max(part.from, past[k][i][j].from);
                    part.to = min(part.to, past[k][i][j].to);
                }
                const int lies_within = bits(part.from < part.to);
                if (lies_within == 0) continue;
                something |= lies_within;
                sum += shadows[k].side[i] * shadows[k].line[i].share(part);
            }
        }
        any_hidden |= something;
        return something != 0;
    }

    EXITANCE_INLINE void run(FourViews& views) {
        const std::size_t corners = tables.corners.size();
        Mask dark = Mask{};
        int hidden = 0;
        doubtful = Mask{};
        std::size_t count = 0;
        for (std::uint32_t k = 0; k < tables.blockers.size(); ++k)
            if (add_shadow(k, shadows[count], dark)) ++count;
        views.F.fill(0);
        views.dark = bits(dark);
        views.lit = 0;
        if (views.dark == all_lanes) {
            views.doubtful = 0;
            return;
        }
        Real total{};
        for (std::size_t s = 0; s < corners; ++s) {
            const Vec3& p = tables.corners[s];
            source[s] = Edge({p.x - u, p.y - v, Real{} + p.z}, tables.along[s]);
            whole[s] = source[s].share({Real{}, Real{} + 1});
            total += whole[s];
        }
        const Real full = total;
        for (std::size_t k = 0; k < count; ++k)
            for (std::size_t j = 0; j < count; ++j)
                if (j != k) clip_lines(k, j);
        bool empty[1 << most_blockers] = {};
        for (unsigned chosen = 1; chosen < 1u << count; ++chosen) {
            for (std::size_t k = 0; k < count; ++k) empty[chosen] |= (chosen >> k & 1) && empty[chosen & ~(1u << k)];
            if (empty[chosen]) continue;
            Real part;
            empty[chosen] = !common_part(chosen, count, part, hidden);
            if (!empty[chosen]) total += __builtin_popcount(chosen) % 2 == 1 ? -part : part;
        }
        Real F = total * (-1 / (2 * pi));
        // What is left when several hide all is rounding.
        F = (F < -1e-13 / (2 * pi) * full) | dark ? Real{} : F;
        store(F, views.F.data());
        views.lit = all_lanes & ~(hidden | views.dark);
        views.doubtful = bits(doubtful & ~dark);
    }
};

}  // namespace

void look_from_four(const SightTables& tables, const double* u, const double* v, FourViews& views) {
    Group group(tables, u, v);
    group.run(views);
}

}  // namespace exitance
