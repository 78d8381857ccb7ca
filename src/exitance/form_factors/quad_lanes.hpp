#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "exitance/base/four.hpp"
#include "exitance/base/limits.hpp"

// Form factors from a point to quads, one quad per SIMD lane: the rules of point_to_polygon_batch.hpp, for kernels that
// have quads in registers.

namespace exitance::lanes_of {

template <class Real>
constexpr int all_lanes = (1 << lanes<Real>)-1;

/// Returns a bit for each lane in which a < b.
EXITANCE_INLINE int where_less(const four::Real& a, const four::Real& b) {
    return four::bits(a < b);
}
// For halves, the comparison mask is one instruction.
EXITANCE_INLINE int where_less(const EightReals& a, const EightReals& b) {
    four::Real left[2], right[2];
    __builtin_memcpy(left, &a, sizeof a), __builtin_memcpy(right, &b, sizeof b);
    return where_less(left[0], right[0]) | where_less(left[1], right[1]) << 4;
}

/// Lambert's contour sum over the four edges of quads wholly above the horizon. The normal is the same for all lanes,
/// or one per lane.
template <class Real, class Direction>
EXITANCE_INLINE Real contour(const Direction& n, const VecOf<Real> (&r)[4]) {
    Real sum{};
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
        const VecOf<Real>&a = r[i], &b = r[(i + 1) & 3], c = cross(a, b - a);
        // Edges of length 0, and edges that point at x, have c = 0.
        const Real sine = max(sqrt(dot(c, c)), Real{} + min_length_of_product);
        sum -= angle_over_sine(sine, dot(a, b)) * dot(n, c);
    }
    return sum * (1 / (2 * pi));
}

inline constexpr double max_squared_tangent = 0.17157287525380988;  // tan^2(pi/8)

/// Contour sum for quads none of whose edges subtends more than 45 degrees. `squared_tangent` is set to the largest
/// squared tangent of half an edge's angle; the result is valid only if it is less than the constant above (it may be
/// NaN). The tangent of half the angle is |a x b| / (|a| |b| + a . b). This needs no octants and no root of |a x b|,
/// and four quotients share one division.
template <class Real, class Direction>
EXITANCE_INLINE Real narrow_contour(const Direction& n, const VecOf<Real> (&r)[4], Real& squared_tangent) {
    Real squared[4], u[4], z[4], share[4];
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) squared[i] = dot(r[i], r[i]);
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) u[i] = sqrt(squared[i] * squared[(i + 1) & 3]) + dot(r[i], r[(i + 1) & 3]);
    const Real u01 = u[0] * u[1], u23 = u[2] * u[3], inverse = 1 / (u01 * u23);
    const Real inverse01 = inverse * u23, inverse23 = inverse * u01;
    const Real over[4] = {inverse01 * u[1], inverse01 * u[0], inverse23 * u[3], inverse23 * u[2]};
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
        const VecOf<Real> c = cross(r[i], r[(i + 1) & 3] - r[i]);
        z[i] = dot(c, c) * (over[i] * over[i]);
        share[i] = dot(n, c) * over[i];
    }
    squared_tangent = max(max(max(z[0], z[1]), z[2]), z[3]);  // if some u is 0, z[3] is NaN, which max() keeps
    Real sum{};
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) sum -= angle_over_tangent(z[i]) * share[i];
    return sum * (1 / pi);
}

/// Two opposite points (s, t) and (-s, -t) of a rule over the square [-1, 1]^2, and the sum of their weights.
struct NodePair {
    double s, t, weight;
};

/// Rule of degree 5 with 7 points [Radon48], fewer than 3 x 3 Gauss points, symmetric about the centre. The pair (0, 0)
/// is the centre itself.
struct SmallRule {
    NodePair seven[4];
    SmallRule() {
        const auto pair = [](double s, double t, double weight) { return NodePair{s, t, weight / 2}; };
        const double q = std::sqrt(14.0 / 15), r = std::sqrt(0.6), h = std::sqrt(1.0 / 3);
        seven[0] = pair(0, 0, 4.0 / 7), seven[1] = pair(0, q, 20.0 / 63);
        seven[2] = pair(r, h, 5.0 / 9), seven[3] = pair(r, -h, 5.0 / 9);
    }
};
inline const SmallRule small_rule;

/// Form factor by a quadrature rule on the bilinear map d(s, t) = m + s a + t b + s t c from [-1, 1]^2 onto the quad.
/// `unit` is one over a squared distance to the quad, which keeps products of squares near one.
///
/// The numerator (area vector . -d) (n . d) and the denominator |d|^4 are polynomials of (s, t). At opposite points
/// their even parts P, E agree and their odd parts p, o differ in sign, so that a pair of points contributes
///
///     (P + p) / (E + o)^2 + (P - p) / (E - o)^2 = 2 (P (E^2 + o^2) - 2 p E o) / (E^2 - o^2)^2
template <class Real, class Direction>
EXITANCE_INLINE Real cubature(const Direction& n, const VecOf<Real> (&r)[4], const Real& unit,
                              const NodePair (&nodes)[4]) {
    const VecOf<Real> p = r[0] + r[2], q = r[1] + r[3];
    const VecOf<Real> m = 0.25 * (p + q), c = 0.25 * (p - q);
    const VecOf<Real> a = 0.25 * ((r[1] - r[0]) + (r[2] - r[3])), b = 0.25 * ((r[3] - r[0]) + (r[2] - r[1]));
    // The area vector is a x b + s a x c + t c x b. For a planar quad the three terms are parallel. The product of each
    // with -m, or with any -d, is its length times the height of the plane over x.
    const Real J = -dot(cross(a, b), m), J_s = -dot(cross(a, c), m), J_t = -dot(cross(c, b), m);
    const Real N = dot(n, m), N_s = dot(n, a), N_t = dot(n, b), N_st = dot(n, c);
    const Real mm = unit * dot(m, m), aa = unit * dot(a, a), bb = unit * dot(b, b), cc = unit * dot(c, c);
    const Real st = 2 * unit * (dot(a, b) + dot(m, c)), ma = 2 * unit * dot(m, a), mb = 2 * unit * dot(m, b);
    const Real ac = 2 * unit * dot(a, c), bc = 2 * unit * dot(b, c);
    Real sum{}, above_before{}, below_before{};
#pragma GCC unroll 4
    for (std::size_t k = 0; k < 4; ++k) {
        const double s = nodes[k].s, t = nodes[k].t;
        const Real E = mm + (s * s) * aa + (t * t) * bb + (s * t) * (st + (s * t) * cc);
        const Real o = s * (ma + (s * t) * ac) + t * (mb + (s * t) * bc);
        const Real even_N = N + (s * t) * N_st, odd_N = s * N_s + t * N_t, odd_J = s * J_s + t * J_t;
        const Real P = J * even_N + odd_J * odd_N, odd_P = J * odd_N + odd_J * even_N;
        const Real EE = E * E, oo = o * o, root = EE - oo;
        const Real above = nodes[k].weight * (P * (EE + oo) - 2 * odd_P * (E * o)), below = root * root;
        if (k % 2 == 0)
            above_before = above, below_before = below;
        else  // two terms share one division, which costs more than the extra products
            sum += (above * below_before + above_before * below) / (below * below_before);
    }
    return sum * 4 * unit * unit * (1 / pi);
}

/// Quads relative to x: corners, centres, and the radii of bounding balls about the centres.
template <class Real>
struct Quads {
    VecOf<Real> r[4], middle;
    Real radius;
};

/// Positive if a quad subtends a large angle, so that its contour sum is needed; smaller quads use quadrature points.
template <class Real>
EXITANCE_INLINE Real size_over_least(const Quads<Real>& quads) {
    constexpr double min_relative_size = 0.006;
    return 4 * quads.radius * quads.radius - min_relative_size * min_relative_size * dot(quads.middle, quads.middle);
}

/// Computes the lowest and highest height of a quad's corners above the horizon.
template <class Real, class Direction>
EXITANCE_INLINE void find_heights(const Direction& n, const Quads<Real>& quads, Real& lowest, Real& highest) {
    lowest = highest = dot(n, quads.r[0]);
#pragma GCC unroll 3
    for (int i = 1; i < 4; ++i) {
        const Real height = dot(n, quads.r[i]);
        lowest = min(lowest, height), highest = max(highest, height);
    }
}

/// Rules for the form factor of a quad, in order of preference. None handles quads that the horizon cuts.
enum class Rule : std::uint8_t {
    narrow_edges,  ///< Large quads without edges longer than 45 degrees.
    points,        ///< Small quads.
    edges,         ///< All other quads, and quads below the horizon.
};

/// Form factors of a vector of quads by one rule. Returns a bit for each lane that the rule handles; F is undefined in
/// the other lanes. A quad counts as above the horizon if no corner is more than `sunk` below it, metres.
template <Rule rule, class Real, class Direction>
EXITANCE_INLINE int apply(const Direction& n, const Quads<Real>& quads, double sunk, Real& F) {
    Real lowest, highest;
    find_heights(n, quads, lowest, highest);
    const Real size = size_over_least(quads);
    const int whole = all_lanes<Real> & ~where_less(lowest, Real{} - sunk);
    int taken;
    if constexpr (rule == Rule::edges) {
        F = highest > 0 ? contour(n, quads.r) : Real{};
        taken = whole | (all_lanes<Real> & ~where_less(Real{}, highest));
    } else {
        taken = whole & where_less(Real{}, min(rule == Rule::points ? -size : size, highest));
        if (taken == 0) return 0;
        if constexpr (rule == Rule::points) {
            F = cubature(n, quads.r, 1 / dot(quads.middle, quads.middle), small_rule.seven);
        } else {
            Real squared_tangent;
            F = narrow_contour(n, quads.r, squared_tangent);
            taken &= where_less(squared_tangent, Real{} + max_squared_tangent);
        }
    }
    F = min(max(F, Real{}), Real{} + 1);
    return taken;
}

}  // namespace exitance::lanes_of
