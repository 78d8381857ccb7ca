#include "exitance/transport/form_factor_batch.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/core/check.hpp"
#include "exitance/transport/form_factor.hpp"
#include "exitance/transport/four.hpp"

namespace exitance {
namespace {

// Eight quads at a time: one register of AVX-512, two of AVX2.
using namespace lanes_of;
constexpr std::size_t lanes = 8;
using Real = double __attribute__((vector_size(64)));
using Mask = long long __attribute__((vector_size(64)));
using Vec = VecOf<Real>;

EXITANCE_INLINE int bits(const Mask& m) {
    four::Mask half[2];
    __builtin_memcpy(half, &m, sizeof m);
    return four::bits(half[0]) | four::bits(half[1]) << 4;
}
EXITANCE_INLINE bool any(const Mask& m) {
    return bits(m) != 0;
}

/// Lambert's sum over the four edges of quads wholly above the horizon. The normal is one, or one a lane.
template <class Direction>
EXITANCE_INLINE Real contour(const Direction& n, const Vec (&r)[4]) {
    Real sum{};
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
        const Vec &a = r[i], &b = r[(i + 1) & 3], c = cross(a, b - a);
        const Real sine = max(sqrt(dot(c, c)), Real{} + 1e-200);  // an edge without length, or that points at x: c = 0
        sum -= angle_over_sine(sine, dot(a, b)) * dot(n, c);
    }
    return sum * (1 / (2 * pi));
}

/// Two points of a rule over the square [-1, 1]^2, (s, t) and (-s, -t), and their shares together.
struct NodePair {
    double s, t, weight;
};

/// Degree 5 in 7 points [Radon48], and degree 7 in 12 points [Tyler53]: fewer than 3 x 3 and 4 x 4 Gauss points. Both
/// are symmetric about the middle; the pair (0, 0) is the middle itself.
struct SmallRules {
    NodePair seven[4], twelve[6];
    SmallRules() {
        const auto pair = [](double s, double t, double weight) { return NodePair{s, t, weight / 2}; };
        const double q = std::sqrt(14.0 / 15), r = std::sqrt(0.6), h = std::sqrt(1.0 / 3);
        seven[0] = pair(0, 0, 4.0 / 7), seven[1] = pair(0, q, 20.0 / 63);
        seven[2] = pair(r, h, 5.0 / 9), seven[3] = pair(r, -h, 5.0 / 9);
        const double root = 3 * std::sqrt(583.0), axis = std::sqrt(6.0 / 7);
        const double near = std::sqrt((114 - root) / 287), far = std::sqrt((114 + root) / 287);
        // Weights of the diagonal points from the moments 1 and s^2.
        const double axis_weight = 98.0 / 405, rest = 1 - axis_weight;
        const double moment = (4.0 / 3 - 2 * axis_weight * axis * axis) / 4;
        const double far_weight = (moment - rest * near * near) / (far * far - near * near);
        twelve[0] = pair(axis, 0, axis_weight), twelve[1] = pair(0, axis, axis_weight);
        twelve[2] = pair(near, near, rest - far_weight), twelve[3] = pair(near, -near, rest - far_weight);
        twelve[4] = pair(far, far, far_weight), twelve[5] = pair(far, -far, far_weight);
    }
};
const SmallRules small_rules;

/// The kernel at a rule's points of the bilinear map d(s, t) = m + s a + t b + s t c from [-1, 1]^2 onto the quad.
/// `unit` is one over a squared distance to the quad, which keeps products of squares near one.
///
/// Numerator (area vector . -d) (n . d) and denominator |d|^4 are polynomials of (s, t). At opposite points their even
/// parts P, E agree and their odd parts p, o differ in sign, so that a pair of points is
///
///     (P + p) / (E + o)^2 + (P - p) / (E - o)^2 = 2 (P (E^2 + o^2) - 2 p E o) / (E^2 - o^2)^2
template <class Direction, std::size_t count>
EXITANCE_INLINE Real cubature(const Direction& n, const Vec (&r)[4], const Real& unit, const NodePair (&nodes)[count]) {
    const Vec p = r[0] + r[2], q = r[1] + r[3];
    const Vec m = 0.25 * (p + q), c = 0.25 * (p - q);
    const Vec a = 0.25 * ((r[1] - r[0]) + (r[2] - r[3])), b = 0.25 * ((r[3] - r[0]) + (r[2] - r[1]));
    // The area vector is a x b + s a x c + t c x b. All of a planar quad's are parallel: each times -m is the plane's
    // height over x times its length, and so is each times -d.
    const Real J = -dot(cross(a, b), m), J_s = -dot(cross(a, c), m), J_t = -dot(cross(c, b), m);
    const Real N = dot(n, m), N_s = dot(n, a), N_t = dot(n, b), N_st = dot(n, c);
    const Real mm = unit * dot(m, m), aa = unit * dot(a, a), bb = unit * dot(b, b), cc = unit * dot(c, c);
    const Real st = 2 * unit * (dot(a, b) + dot(m, c)), ma = 2 * unit * dot(m, a), mb = 2 * unit * dot(m, b);
    const Real ac = 2 * unit * dot(a, c), bc = 2 * unit * dot(b, c);
    Real sum{}, above_before{}, below_before{};
#pragma GCC unroll 6
    for (std::size_t k = 0; k < count; ++k) {
        const double s = nodes[k].s, t = nodes[k].t;
        const Real E = mm + (s * s) * aa + (t * t) * bb + (s * t) * (st + (s * t) * cc);
        const Real o = s * (ma + (s * t) * ac) + t * (mb + (s * t) * bc);
        const Real even_N = N + (s * t) * N_st, odd_N = s * N_s + t * N_t, odd_J = s * J_s + t * J_t;
        const Real P = J * even_N + odd_J * odd_N, odd_P = J * odd_N + odd_J * even_N;
        const Real EE = E * E, oo = o * o, root = EE - oo;
        const Real above = nodes[k].weight * (P * (EE + oo) - 2 * odd_P * (E * o)), below = root * root;
        if (k % 2 == 0)
            above_before = above, below_before = below;
        else  // two terms over one denominator: a division costs more than the products it saves
            sum += (above * below_before + above_before * below) / (below * below_before);
    }
    return sum * 4 * unit * unit * (1 / pi);
}

/// Form factors of eight quads from x, r their corners and `middle` their middles relative to it. Returns a bit for
/// each that the horizon cuts, whose form factor is none.
template <class Direction>
EXITANCE_INLINE int form_factors(const Direction& n, const Vec (&r)[4], const Vec& middle, const Real& radius,
                                 double* out) {
    Real lowest = Real{} + HUGE_VAL, highest = -lowest;
#pragma GCC unroll 4
    for (const Vec& corner : r) {
        const Real height = dot(n, corner);
        lowest = min(lowest, height), highest = max(highest, height);
    }
    const Real squared = 4 * radius * radius, distance = dot(middle, middle);
    Real F;
    if (!any(squared > 3.6e-5 * distance))
        F = cubature(n, r, 1 / distance, small_rules.seven);
    else if (!any(squared > 0.0049 * distance))
        F = cubature(n, r, 1 / distance, small_rules.twelve);
    else
        F = contour(n, r);
    F = highest > 0 ? min(max(F, Real{}), Real{} + 1) : Real{};
    store(F, out);
    return bits((lowest < 0) & (highest > 0));
}

/// Of eight quads and one point, `column` the quads' coordinates in the order of QuadBatch::columns.
EXITANCE_INLINE int group(const Point& x, const Normal& n, const double* const (&column)[16], double* out) {
    const Vec origin = {Real{} + x.x, Real{} + x.y, Real{} + x.z};
    Vec r[4];
#pragma GCC unroll 4
    for (std::size_t i = 0; i < 4; ++i)
        r[i] = Vec{load<Real>(column[3 * i]), load<Real>(column[3 * i + 1]), load<Real>(column[3 * i + 2])} - origin;
    const Vec middle = Vec{load<Real>(column[12]), load<Real>(column[13]), load<Real>(column[14])} - origin;
    return form_factors(n, r, middle, load<Real>(column[15]), out);
}

/// Of one quad and eight points, `column` the points' coordinates and then their normals'.
EXITANCE_INLINE int points_group(const std::array<Point, 4>& quad, const Point& centre, double radius,
                                 const double* const (&column)[6], double* out) {
    const Vec x = {load<Real>(column[0]), load<Real>(column[1]), load<Real>(column[2])};
    const Vec n = {load<Real>(column[3]), load<Real>(column[4]), load<Real>(column[5])};
    const auto from_x = [&](const Point& p) __attribute__((always_inline)) {
        return Vec{p.x - x.x, p.y - x.y, p.z - x.z};
    };
    const Vec r[4] = {from_x(quad[0]), from_x(quad[1]), from_x(quad[2]), from_x(quad[3])};
    return form_factors(n, r, from_x(centre), Real{} + radius, out);
}

using Group = int(const Point&, const Normal&, const double* const (&)[16], double*);
int group_of_any_processor(const Point& x, const Normal& n, const double* const (&column)[16], double* out) {
    return group(x, n, column, out);
}
using PointsGroup = int(const std::array<Point, 4>&, const Point&, double, const double* const (&)[6], double*);
int points_group_of_any_processor(const std::array<Point, 4>& quad, const Point& centre, double radius,
                                  const double* const (&column)[6], double* out) {
    return points_group(quad, centre, radius, column, out);
}
#ifdef __x86_64__
/// The same operations in the same order, hence the same bits, in half as many instructions.
[[gnu::target("avx512f,avx512dq,avx512vl,avx512bw,prefer-vector-width=512")]] int group_of_avx512(
    const Point& x, const Normal& n, const double* const (&column)[16], double* out) {
    return group(x, n, column, out);
}
[[gnu::target("avx512f,avx512dq,avx512vl,avx512bw,prefer-vector-width=512")]] int points_group_of_avx512(
    const std::array<Point, 4>& quad, const Point& centre, double radius, const double* const (&column)[6],
    double* out) {
    return points_group(quad, centre, radius, column, out);
}
bool has_avx512() {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
}
Group* const fastest = has_avx512() ? group_of_avx512 : group_of_any_processor;
PointsGroup* const fastest_points = has_avx512() ? points_group_of_avx512 : points_group_of_any_processor;
#else
Group* const fastest = group_of_any_processor;
PointsGroup* const fastest_points = points_group_of_any_processor;
#endif

}  // namespace

void EdgeTerms::grow() {
    const std::size_t size = 2 * count_ + 4 * four::lanes;
    squared_sine_.resize(size), cosine_.resize(size), share_.resize(size);
}

double EdgeTerms::sum() {
    if (count_ == 0) return 0;
    while (count_ % four::lanes != 0) {  // edges that add nothing fill the last group
        if (count_ == squared_sine_.size()) grow();
        squared_sine_[count_] = 1, cosine_[count_] = 1, share_[count_++] = 0;
    }
    four::Real total{};
    for (std::size_t k = 0; k < count_; k += four::lanes) {
        const four::Real sine = max(sqrt(four::load(&squared_sine_[k])), four::Real{} + 1e-200);
        total -= angle_over_sine(sine, four::load(&cosine_[k])) * four::load(&share_[k]);
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

std::array<Point, 4> QuadBatch::corners(std::size_t k) const {
    std::array<Point, 4> out;
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t axis = 0; axis < 3; ++axis) out[c][axis] = corner_[3 * c + axis][k];
    return out;
}

std::array<const double*, 16> QuadBatch::columns() const {
    std::array<const double*, 16> out;
    for (std::size_t i = 0; i < 12; ++i) out[i] = corner_[i].data();
    for (std::size_t i = 0; i < 3; ++i) out[12 + i] = middle_[i].data();
    out[15] = radius_.data();
    return out;
}

void point_to_quads(const Point& x, const Normal& n, const QuadBatch& quads, std::span<double> out,
                    Processor processor) {
    EXI_CHECK(out.size() == quads.size());
    const std::size_t count = quads.size();
    if (count == 0) return;
    if (count < lanes) {  // a copy that fills a group, by repeating the last one
        std::array<double, 16 * lanes> copy;
        const double* column[16];
        const auto columns = quads.columns();
        for (std::size_t i = 0; i < 16; ++i) {
            for (std::size_t k = 0; k < lanes; ++k) copy[lanes * i + k] = columns[i][std::min(k, count - 1)];
            column[i] = &copy[lanes * i];
        }
        std::array<double, lanes> F;
        const int cut = (processor == Processor::any ? group_of_any_processor : *fastest)(x, n, column, F.data());
        for (std::size_t k = 0; k < count; ++k) out[k] = cut >> k & 1 ? point_to_polygon(x, n, quads.corners(k)) : F[k];
        return;
    }
    Group& group_of = processor == Processor::any ? group_of_any_processor : *fastest;
    const auto columns = quads.columns();
    for (std::size_t first = 0; first < count; first += lanes) {
        const std::size_t k = std::min(first, count - lanes);  // the last group reaches back over quads already done
        const double* column[16];
        for (std::size_t i = 0; i < 16; ++i) column[i] = columns[i] + k;
        const int cut = group_of(x, n, column, &out[k]);
        if (cut == 0) continue;
        for (std::size_t i = 0; i < lanes; ++i)
            if (cut >> i & 1) out[k + i] = point_to_polygon(x, n, quads.corners(k + i));
    }
}

void ReceiverBatch::add(const Point& x, const Normal& n) {
    const double value[6] = {x.x, x.y, x.z, n.x, n.y, n.z};
    for (std::size_t i = 0; i < 6; ++i) {
        if (count_ % lanes == 0) column_[i].resize(count_ + lanes);
        std::fill_n(column_[i].begin() + static_cast<std::ptrdiff_t>(count_), lanes - count_ % lanes, value[i]);
    }
    ++count_;
}

void points_to_quad(const ReceiverBatch& receivers, const std::array<Point, 4>& quad, std::span<double> out,
                    Processor processor) {
    EXI_CHECK(out.size() == receivers.size());
    const Point middle = 0.25 * ((quad[0] + quad[1]) + (quad[2] + quad[3]));
    double squared_radius = 0;
    for (const Point& corner : quad) squared_radius = std::max(squared_radius, squared_norm(corner - middle));
    PointsGroup& group_of = processor == Processor::any ? points_group_of_any_processor : *fastest_points;
    for (std::size_t first = 0; first < out.size(); first += lanes) {
        const double* column[6];
        for (std::size_t i = 0; i < 6; ++i) column[i] = &receivers.column_[i][first];
        std::array<double, lanes> F;
        const int cut = group_of(quad, middle, std::sqrt(squared_radius), column, F.data());
        for (std::size_t i = 0; i < lanes && first + i < out.size(); ++i)
            out[first + i] = cut >> i & 1 ? point_to_polygon({column[0][i], column[1][i], column[2][i]},
                                                             {column[3][i], column[4][i], column[5][i]}, quad)
                                          : F[i];
    }
}

}  // namespace exitance
