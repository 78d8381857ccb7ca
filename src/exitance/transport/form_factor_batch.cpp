#include "exitance/transport/form_factor_batch.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/core/check.hpp"
#include "exitance/transport/form_factor.hpp"
#include "exitance/transport/four.hpp"

namespace exitance {
namespace {

using namespace four;

/// Lambert's sum over the four edges of quads wholly above the horizon.
inline Real contour(const Normal& n, const Vec (&r)[4]) {
    Real sum{};
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
        const Vec &a = r[i], &b = r[(i + 1) & 3], c = cross(a, b - a);
        const Real sine = max(sqrt(dot(c, c)), Real{} + 1e-200);  // an edge without length, or that points at x: c = 0
        sum -= angle_over_sine(sine, dot(a, b)) * dot(n, c);
    }
    return sum * (1 / (2 * pi));
}

/// A point of a rule over the unit square, and its share.
struct Node {
    double u, v, weight;
};

/// Degree 5 in 7 points [Radon48], and degree 7 in 12 points [Tyler53]: fewer than 3 x 3 and 4 x 4 Gauss points.
struct SmallRules {
    Node seven[7], twelve[12];
    SmallRules() {
        const auto at = [](double s, double t, double weight) {
            return Node{0.5 + 0.5 * s, 0.5 + 0.5 * t, weight / 4};
        };
        const double q = std::sqrt(14.0 / 15), r = std::sqrt(0.6), h = std::sqrt(1.0 / 3);
        seven[0] = at(0, 0, 8.0 / 7), seven[1] = at(0, q, 20.0 / 63), seven[2] = at(0, -q, 20.0 / 63);
        const double root = 3 * std::sqrt(583.0), axis = std::sqrt(6.0 / 7);
        const double near = std::sqrt((114 - root) / 287), far = std::sqrt((114 + root) / 287);
        // Weights of the diagonal points from the moments 1 and s^2.
        const double axis_weight = 98.0 / 405, rest = 1 - axis_weight;
        const double moment = (4.0 / 3 - 2 * axis_weight * axis * axis) / 4;
        const double far_weight = (moment - rest * near * near) / (far * far - near * near);
        for (int i = 0; i < 4; ++i) {
            const double s = i & 1 ? 1 : -1, t = i & 2 ? 1 : -1;
            seven[3 + i] = at(s * r, t * h, 5.0 / 9);
            twelve[i] = i < 2 ? at(s * axis, 0, axis_weight) : at(0, s * axis, axis_weight);
            twelve[4 + i] = at(s * near, t * near, rest - far_weight);
            twelve[8 + i] = at(s * far, t * far, far_weight);
        }
    }
};
const SmallRules small_rules;

/// The kernel at a rule's points of the bilinear map (1-u)(1-v) r0 + u (1-v) r1 + u v r2 + (1-u) v r3.
/// `unit` is one over a squared distance to the quad, which keeps products of squares near one.
template <std::size_t count>
inline Real cubature(const Normal& n, const Vec (&r)[4], const Real& unit, const Node (&nodes)[count]) {
    const Vec a = r[1] - r[0], b = r[3] - r[0], c = (r[2] - r[1]) - b;
    const Vec base = cross(a, b), by_u = cross(a, c), by_v = cross(c, b);
    // All of a planar quad's area vectors are parallel: each times -r is the plane's height over x times its length.
    const Real height = -dot(base, r[0]), along_u = -dot(by_u, r[0]), along_v = -dot(by_v, r[0]);
    const Real n0 = dot(n, r[0]), na = dot(n, a), nb = dot(n, b), nc = dot(n, c);
    Real sum{}, before_above{}, before_below{};
    for (std::size_t k = 0; k < count; ++k) {
        const double u = nodes[k].u, v = nodes[k].v, uv = u * v;
        const Vec d = r[0] + u * a + v * b + uv * c;
        const Real near = unit * dot(d, d), below = near * near;
        const Real above = nodes[k].weight * (height + u * along_u + v * along_v) * (n0 + u * na + v * nb + uv * nc);
        if (k + 1 == count && count % 2 == 1)
            sum += above / below;
        else if (k % 2 == 0)
            before_above = above, before_below = below;
        else  // two terms over one denominator: a division costs more than the products it saves
            sum += (above * before_below + before_above * below) / (below * before_below);
    }
    return sum * unit * unit * (1 / pi);
}

}  // namespace

void EdgeTerms::grow() {
    const std::size_t size = 2 * count_ + 4 * lanes;
    squared_sine_.resize(size), cosine_.resize(size), share_.resize(size);
}

double EdgeTerms::sum() {
    if (count_ == 0) return 0;
    while (count_ % lanes != 0) {  // edges that add nothing fill the last group
        if (count_ == squared_sine_.size()) grow();
        squared_sine_[count_] = 1, cosine_[count_] = 1, share_[count_++] = 0;
    }
    Real total{};
    for (std::size_t k = 0; k < count_; k += lanes) {
        const Real sine = max(sqrt(load(&squared_sine_[k])), Real{} + 1e-200);
        total -= angle_over_sine(sine, load(&cosine_[k])) * load(&share_[k]);
    }
    return ((total[0] + total[1]) + (total[2] + total[3])) * (1 / (2 * pi));
}

void QuadBatch::clear() {
    for (auto& v : corner_) v.clear();
    for (auto& v : middle_) v.clear();
    radius_.clear();
}

void QuadBatch::reserve(std::size_t count) {
    for (auto& v : corner_) v.reserve(count);
    for (auto& v : middle_) v.reserve(count);
    radius_.reserve(count);
}

void QuadBatch::add(const std::array<Point, 4>& corners) {
    const Point middle = 0.25 * ((corners[0] + corners[1]) + (corners[2] + corners[3]));
    double squared_radius = 0;
    for (const Point& corner : corners) squared_radius = std::max(squared_radius, squared_norm(corner - middle));
    add(corners, middle, std::sqrt(squared_radius));
}

void QuadBatch::add(const std::array<Point, 4>& corners, const Point& middle, double radius) {
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) corner_[3 * i + axis].push_back(corners[i][axis]);
    for (std::size_t axis = 0; axis < 3; ++axis) middle_[axis].push_back(middle[axis]);
    radius_.push_back(radius);
}

void point_to_quads(const Point& x, const Normal& n, const QuadBatch& quads, std::span<double> out) {
    EXI_CHECK(out.size() == quads.size());
    const std::size_t count = quads.size();
    for (std::size_t first = 0; first < count; first += lanes) {
        // The last group reaches back over quads already done.
        const std::size_t k = count >= lanes ? std::min(first, count - lanes) : 0;
        const std::size_t used = std::min(lanes, count);
        const auto at = [&](const std::vector<double>& v) {
            if (used == lanes) return load(v.data() + k);
            Real some = Real{} + v[0];
            for (std::size_t i = 0; i < used; ++i) some[i] = v[i];
            return some;
        };
        const Vec origin = {Real{} + x.x, Real{} + x.y, Real{} + x.z};
        Vec r[4];
        Real lowest = Real{} + HUGE_VAL, highest = -lowest;
        for (std::size_t i = 0; i < 4; ++i) {
            r[i] = Vec{at(quads.corner_[3 * i]), at(quads.corner_[3 * i + 1]), at(quads.corner_[3 * i + 2])} - origin;
            const Real height = dot(n, r[i]);
            lowest = min(lowest, height), highest = max(highest, height);
        }
        const Vec middle = Vec{at(quads.middle_[0]), at(quads.middle_[1]), at(quads.middle_[2])} - origin;
        const Real radius = at(quads.radius_), squared = 4 * radius * radius, distance = dot(middle, middle);
        Real F;
        if (!any(squared > 3.6e-5 * distance))
            F = cubature(n, r, 1 / distance, small_rules.seven);
        else if (!any(squared > 0.0049 * distance))
            F = cubature(n, r, 1 / distance, small_rules.twelve);
        else
            F = contour(n, r);
        F = highest > 0 ? min(max(F, Real{}), Real{} + 1) : Real{};
        const Mask cut = (lowest < 0) & (highest > 0);
        for (std::size_t i = 0; i < used; ++i) out[k + i] = F[i];
        if (!any(cut)) continue;
        for (std::size_t i = 0; i < used; ++i) {
            if (!cut[i]) continue;
            std::array<Point, 4> corners;
            for (std::size_t c = 0; c < 4; ++c)
                for (std::size_t axis = 0; axis < 3; ++axis) corners[c][axis] = quads.corner_[3 * c + axis][k + i];
            out[k + i] = point_to_polygon(x, n, corners);
        }
    }
}

}  // namespace exitance
