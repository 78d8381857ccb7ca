#include <algorithm>

#include "exitance/base/limits.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/form_factors/quad_lanes.hpp"
#include "exitance/gather/element_gather.hpp"

namespace exitance {
namespace {

using namespace lanes_of;
using four::Real;

template <std::size_t count>
EXITANCE_INLINE Real lanes_at(const std::array<double, count>& values) {
    return four::load(values.data());
}

EXITANCE_INLINE four::Vec lanes_at(const std::array<std::array<double, four::lanes>, 3>& place) {
    return {lanes_at(place[0]), lanes_at(place[1]), lanes_at(place[2])};
}

/// Form factors of four quadrilaterals; the first suitable rule is used for each.
EXITANCE_INLINE Real form_factors(const Point& x, const Normal& n, const Quads<Real>& quads) {
    // A corner in the plane of x may be slightly below it due to rounding.
    constexpr double rounding = 1e-12;  // derived from double precision
    const double sunk = rounding * (std::abs(x.x) + std::abs(x.y) + std::abs(x.z) + quads.radius[0]);
    Real F{};
    int taken = 0;
    const auto take = [&](int more, const Real& by_rule) EXITANCE_INLINE_LAMBDA {
        for (std::size_t i = 0; i < four::lanes; ++i)
            if (more & ~taken & 1 << i) F[i] = by_rule[i];
        taken |= more;
    };
    Real by_rule{};
    // Edges subtend more than 45 degrees only at distances below twice the radius.
    const Real nearest = 2 * quads.radius;
    const bool is_near = where_less(dot(quads.middle, quads.middle), nearest * nearest) != 0;
    if (is_near)
        take(apply<Rule::edges>(n, quads, sunk, by_rule), by_rule);
    else
        take(apply<Rule::narrow_edges>(n, quads, sunk, by_rule), by_rule);
    if (taken != all_lanes<Real>) take(apply<Rule::points>(n, quads, sunk, by_rule), by_rule);
    if (taken != all_lanes<Real> && !is_near) take(apply<Rule::edges>(n, quads, sunk, by_rule), by_rule);
    for (std::size_t i = 0; i < four::lanes && taken != all_lanes<Real>; ++i) {
        if (taken >> i & 1) continue;
        std::array<Point, 4> corners;
        for (std::size_t c = 0; c < 4; ++c) corners[c] = x + Vec3{quads.r[c].x[i], quads.r[c].y[i], quads.r[c].z[i]};
        F[i] = point_to_polygon(x, n, corners);
    }
    return F;
}

/// Weights of the values in `lean` for the light at x: each Gauss point's share of the form factor, times its position
/// between centre and corner.
EXITANCE_INLINE void weigh_corners(const Normal& n, const Quads<Real>& quads, const Real& inward, const Real& last,
                                   Real (&weight)[4]) {
    Real sum{};
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
        const four::Vec out = quads.r[i] - quads.middle;
        const four::Vec d = {quads.middle.x + inward * out.x, quads.middle.y + inward * out.y,
                             quads.middle.z + inward * out.z};
        const Real above = max(Real{}, dot(n, d));
        const Real squared =
            max(dot(d, d), Real{} + 1e-100);  // derived from the smallest double: avoids division by zero
        // The height of x over the element's plane is the same for all points.
        weight[i] = above / (squared * squared) * (i < 2 ? Real{} + 1 : last);
        sum += weight[i];
    }
    const Real scale = inward / max(sum, Real{} + min_divisor);
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) weight[i] *= scale;
}

/// Lanes whose light is not uniform enough to be summed as one element, and those whose slope must be included.
struct MissedLight {
    four::Mask uneven{}, leans{};
};

/// Estimates the error of summing an element as a whole. The kernel varies over an element by about its size over its
/// distance. Gauss points leave a share of the resulting error due to b's slope, and all of that due to the deviation
/// of b from the linear function.
template <class Group>
EXITANCE_INLINE MissedLight missed_light(const Group& group, const Quads<Real>& quads, const Real& F,
                                         const Real (&allowed)[bands]) {
    const double left = calibrated::sum_left_over, leaning = calibrated::negligible_sum_slope;
    const Real near = min(Real{} + 1, 3 * quads.radius / sqrt(dot(quads.middle, quads.middle)));
    const Real of_slope = left * F * near * near, of_rest = left * F * near;
    MissedLight out;
    for (std::size_t k = 0; k < bands; ++k) {
        const Real slope = lanes_at(group.slope[k]);
        out.uneven |= of_slope * slope + of_rest * lanes_at(group.rest[k]) > allowed[k];
        out.leans |= F * near * slope > leaning * allowed[k];
    }
    return out;
}

}  // namespace

/// Opens the elements in the lanes whose bits are set: their pieces, or quarters of a leaf, are summed instead.
void ElementGather::open_pieces(const Group& group, int uneven, int cuts, Workspace& w) {
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(uneven >> i & 1)) continue;
        if (group.below[i] != none) {
            w.open_.push_back({group.below[i], 0});
        } else {
            w.open_.push_back({none, cuts + 1});
            w.parts_.push_back(group.quarters(i));
        }
    }
}

EXITANCE_INLINE Spectrum ElementGather::sum(const Point& x, const Normal& n, RegionId own, double share,
                                            Workspace& w) const {
    constexpr int max_cuts = 12;  // maximum depth of splits of one leaf
    const four::Vec origin = {Real{} + x.x, Real{} + x.y, Real{} + x.z};
    const auto seen_from_x = [&](const Group& group) EXITANCE_INLINE_LAMBDA {
        return Quads<Real>{{lanes_at(group.corners[0]) - origin, lanes_at(group.corners[1]) - origin,
                            lanes_at(group.corners[2]) - origin, lanes_at(group.corners[3]) - origin},
                           lanes_at(group.centre) - origin,
                           lanes_at(group.radius)};
    };
    const auto form_factors_of = [&](std::uint32_t group, const Quads<Real>& quads) EXITANCE_INLINE_LAMBDA {
        Real F = form_factors(x, n, quads);
        if (group < of_region_.size())
            for (std::size_t i = 0; i < lanes; ++i)
                if (of_region_[group][i] == own) F[i] = 0;
        return F;
    };

    Real E[bands] = {}, allowed[bands] = {};
    for (std::uint32_t g = 0; g < of_region_.size(); ++g) {
        const Real F = form_factors_of(g, seen_from_x(groups_[g]));
        for (std::size_t k = 0; k < bands; ++k) {
            const Real light = lanes_at(groups_[g].mean[k]);
            allowed[k] += share * F * max(light, -light);
        }
    }
    for (Real& a : allowed) a = Real{} + ((a[0] + a[1]) + (a[2] + a[3]));

    if (!groups_.empty()) w.open_.push_back({0, 0});
    Group part;
    while (!w.open_.empty()) {
        const auto [number, cuts] = w.open_.back();
        if (number == none) part = w.parts_.back(), w.parts_.pop_back();
        const Group& group = number == none ? part : groups_[number];
        if (group.more)
            ++w.open_.back().group;
        else
            w.open_.pop_back();

        const Quads<Real> quads = seen_from_x(group);
        const Real F = form_factors_of(number, quads);
        auto [uneven, leans] = missed_light(group, quads, F, allowed);
        if (cuts == max_cuts) uneven = four::Mask{};
        const Real summed = uneven ? Real{} : F;
        for (std::size_t k = 0; k < bands; ++k) E[k] += summed * lanes_at(group.mean[k]);
        if (four::any(leans & ~uneven)) {
            Real weight[4];
            weigh_corners(n, quads, lanes_at(group.inward), lanes_at(group.last), weight);
            for (std::size_t k = 0; k < bands; ++k)
                for (std::size_t c = 0; c < 4; ++c) E[k] += summed * (weight[c] * lanes_at(group.lean[c][k]));
        }
        open_pieces(group, four::bits(uneven), cuts, w);
    }
    Spectrum sum;
    for (std::size_t k = 0; k < bands; ++k) sum[k] = (E[k][0] + E[k][1]) + (E[k][2] + E[k][3]);
    return sum;
}

Spectrum ElementGather::operator()(const Point& x, const Normal& n, RegionId own, double share, Workspace& w) const {
    return call_for_four([&]() EXITANCE_INLINE_LAMBDA { return sum(x, n, own, share, w); });
}

}  // namespace exitance
