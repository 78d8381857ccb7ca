#include "exitance/transport/form_factor_batch.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/core/check.hpp"
#include "exitance/transport/form_factor.hpp"
#include "exitance/transport/four.hpp"

namespace exitance {
namespace {

// As many quads at a time as one register holds: eight with AVX-512, else four. No lane looks at another, so that
// nothing depends on which it is.
using namespace lanes_of;
template <class Real>
constexpr int all_lanes = (1 << lanes<Real>)-1;
constexpr std::size_t most_lanes = lanes<EightReals>;

/// A bit for each lane in which a < b.
EXITANCE_INLINE int where_less(const four::Real& a, const four::Real& b) {
    return four::bits(a < b);
}
EXITANCE_INLINE int where_less(const EightReals& a, const EightReals& b) {  // a half is one instruction
    four::Real left[2], right[2];
    __builtin_memcpy(left, &a, sizeof a), __builtin_memcpy(right, &b, sizeof b);
    return where_less(left[0], right[0]) | where_less(left[1], right[1]) << 4;
}

/// Lambert's sum over the four edges of quads wholly above the horizon. The normal is one, or one a lane.
template <class Real, class Direction>
EXITANCE_INLINE Real contour(const Direction& n, const VecOf<Real> (&r)[4]) {
    Real sum{};
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
        const VecOf<Real>&a = r[i], &b = r[(i + 1) & 3], c = cross(a, b - a);
        const Real sine = max(sqrt(dot(c, c)), Real{} + 1e-200);  // an edge without length, or that points at x: c = 0
        sum -= angle_over_sine(sine, dot(a, b)) * dot(n, c);
    }
    return sum * (1 / (2 * pi));
}

constexpr double most_squared_tangent = 0.17157287525380988;  // tan^2(pi/8)

/// The same where no edge looks longer than 45 degrees, as `squared_tangent` tells: it stays below the constant above,
/// else it is larger or no number. Half the angle has the tangent |a x b| / (|a| |b| + a . b): no octants, no root of
/// |a x b|, and four quotients share one division.
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
    squared_tangent =
        max(max(max(z[0], z[1]), z[2]), z[3]);  // where u is 0 somewhere, the last one is no number either
    Real sum{};
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) sum -= angle_over_tangent(z[i]) * share[i];
    return sum * (1 / pi);
}

/// Two points of a rule over the square [-1, 1]^2, (s, t) and (-s, -t), and their shares together.
struct NodePair {
    double s, t, weight;
};

/// Degree 5 in 7 points [Radon48], fewer than 3 x 3 Gauss points, symmetric about the middle. The pair (0, 0) is the
/// middle itself.
struct SmallRule {
    NodePair seven[4];
    SmallRule() {
        const auto pair = [](double s, double t, double weight) { return NodePair{s, t, weight / 2}; };
        const double q = std::sqrt(14.0 / 15), r = std::sqrt(0.6), h = std::sqrt(1.0 / 3);
        seven[0] = pair(0, 0, 4.0 / 7), seven[1] = pair(0, q, 20.0 / 63);
        seven[2] = pair(r, h, 5.0 / 9), seven[3] = pair(r, -h, 5.0 / 9);
    }
};
const SmallRule small_rule;

/// The kernel at a rule's points of the bilinear map d(s, t) = m + s a + t b + s t c from [-1, 1]^2 onto the quad.
/// `unit` is one over a squared distance to the quad, which keeps products of squares near one.
///
/// Numerator (area vector . -d) (n . d) and denominator |d|^4 are polynomials of (s, t). At opposite points their even
/// parts P, E agree and their odd parts p, o differ in sign, so that a pair of points is
///
///     (P + p) / (E + o)^2 + (P - p) / (E - o)^2 = 2 (P (E^2 + o^2) - 2 p E o) / (E^2 - o^2)^2
template <class Real, class Direction>
EXITANCE_INLINE Real cubature(const Direction& n, const VecOf<Real> (&r)[4], const Real& unit,
                              const NodePair (&nodes)[4]) {
    const VecOf<Real> p = r[0] + r[2], q = r[1] + r[3];
    const VecOf<Real> m = 0.25 * (p + q), c = 0.25 * (p - q);
    const VecOf<Real> a = 0.25 * ((r[1] - r[0]) + (r[2] - r[3])), b = 0.25 * ((r[3] - r[0]) + (r[2] - r[1]));
    // The area vector is a x b + s a x c + t c x b. All of a planar quad's are parallel: each times -m is the plane's
    // height over x times its length, and so is each times -d.
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
        else  // two terms over one denominator: a division costs more than the products it saves
            sum += (above * below_before + above_before * below) / (below * below_before);
    }
    return sum * 4 * unit * unit * (1 / pi);
}

/// How quads relative to x are met: their corners, their middles, the radii of balls about these that hold them.
template <class Real>
struct Quads {
    VecOf<Real> r[4], middle;
    Real radius;
};

/// Positive where a quad looks so large that its edges are summed; smaller ones take points.
template <class Real>
EXITANCE_INLINE Real size_over_least(const Quads<Real>& quads) {
    constexpr double least = 0.006;
    return 4 * quads.radius * quads.radius - least * least * dot(quads.middle, quads.middle);
}

/// The lowest and highest of a quad's corners over the horizon.
template <class Real, class Direction>
EXITANCE_INLINE void find_heights(const Direction& n, const Quads<Real>& quads, Real& lowest, Real& highest) {
    lowest = highest = dot(n, quads.r[0]);
#pragma GCC unroll 3
    for (int i = 1; i < 4; ++i) {
        const Real height = dot(n, quads.r[i]);
        lowest = min(lowest, height), highest = max(highest, height);
    }
}

/// What a quad is given to: the first of these that takes it. All leave those that the horizon cuts.
enum class Rule : std::uint8_t {
    narrow_edges,  ///< Not small, no edge longer than 45 degrees.
    points,        ///< Small ones.
    edges,         ///< The others, and those behind the horizon.
};

/// Form factors of eight quads by one rule: a bit for each that it takes. What F holds of the others is of no use.
template <Rule rule, class Real, class Direction>
EXITANCE_INLINE int apply(const Direction& n, const Quads<Real>& quads, Real& F) {
    Real lowest, highest;
    find_heights(n, quads, lowest, highest);
    const Real size = size_over_least(quads);
    const int whole = all_lanes<Real> & ~where_less(lowest, Real{});
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
            taken &= where_less(squared_tangent, Real{} + most_squared_tangent);
        }
    }
    F = min(max(F, Real{}), Real{} + 1);
    return taken;
}

/// The quads whose coordinates stand from k on in the order of QuadBatch::columns.
template <class Real>
EXITANCE_INLINE Quads<Real> load_quads(const Point& x, const double* const (&column)[16], std::size_t k) {
    const VecOf<Real> origin = {Real{} + x.x, Real{} + x.y, Real{} + x.z};
    const auto at = [&](std::size_t i) __attribute__((always_inline)) {
        return VecOf<Real>{load<Real>(column[i] + k), load<Real>(column[i + 1] + k), load<Real>(column[i + 2] + k)} -
               origin;
    };
    return {{at(0), at(3), at(6), at(9)}, at(12), load<Real>(column[15] + k)};
}

/// A quad, and a ball that holds it.
struct OneQuad {
    std::array<Point, 4> corner;
    Point middle;
    double radius;
};

/// One quad as eight points see it, whose coordinates and then normals stand from k on.
template <class Real>
struct PointsView {
    Quads<Real> quads;
    VecOf<Real> n;
};
template <class Real>
EXITANCE_INLINE PointsView<Real> load_points(const OneQuad& quad, const double* const (&column)[6], std::size_t k) {
    const VecOf<Real> x = {load<Real>(column[0] + k), load<Real>(column[1] + k), load<Real>(column[2] + k)};
    const auto from_x = [&](const Point& p) __attribute__((always_inline)) {
        return VecOf<Real>{p.x - x.x, p.y - x.y, p.z - x.z};
    };
    return {{{from_x(quad.corner[0]), from_x(quad.corner[1]), from_x(quad.corner[2]), from_x(quad.corner[3])},
             from_x(quad.middle),
             Real{} + quad.radius},
            {load<Real>(column[3] + k), load<Real>(column[4] + k), load<Real>(column[5] + k)}};
}

/// Applies a rule to the group of quads at `first` and those after it, as long as it takes all of a group: where the
/// first group stands that is otherwise, and a bit for each taken one of that.
struct Reached {
    std::size_t first;
    int taken;
};
template <Rule rule, class Real>
EXITANCE_INLINE Reached apply_to_quads(const Point& x, const Normal& n, const double* const (&column)[16],
                                       std::size_t first, std::size_t last, double* out) {
    int taken = 0;
    for (; first + lanes<Real> <= last; first += lanes<Real>) {
        Real F{};
        taken = apply<rule>(n, load_quads<Real>(x, column, first), F);
        store(F, out);
        if (taken != all_lanes<Real>) break;
        out += lanes<Real>;
    }
    return {first, taken};
}
template <Rule rule, class Real>
EXITANCE_INLINE int apply_to_points(const OneQuad& quad, const double* const (&column)[6], std::size_t k, double* out) {
    const PointsView<Real> view = load_points<Real>(quad, column, k);
    Real F{};
    const int taken = apply<rule>(view.n, view.quads, F);
    store(F, out);
    return taken;
}

/// These two, made for a processor, by rule. All have the same operations in the same order, hence the same bits.
struct Kernels {
    std::size_t lanes;
    int all;  ///< A bit for each lane.
    Reached (*quads[3])(const Point&, const Normal&, const double* const (&)[16], std::size_t, std::size_t, double*);
    int (*points[3])(const OneQuad&, const double* const (&)[6], std::size_t, double*);
};
#define EXITANCE_KERNELS(NAME, REAL, TARGET)                                                                          \
    template <Rule rule>                                                                                              \
    TARGET Reached NAME##_quads(const Point& x, const Normal& n, const double* const(&column)[16], std::size_t first, \
                                std::size_t last, double* out) {                                                      \
        return apply_to_quads<rule, REAL>(x, n, column, first, last, out);                                            \
    }                                                                                                                 \
    template <Rule rule>                                                                                              \
    TARGET int NAME##_points(const OneQuad& quad, const double* const(&column)[6], std::size_t k, double* out) {      \
        return apply_to_points<rule, REAL>(quad, column, k, out);                                                     \
    }                                                                                                                 \
    const Kernels NAME = {                                                                                            \
        lanes<REAL>,                                                                                                  \
        all_lanes<REAL>,                                                                                              \
        {NAME##_quads<Rule::narrow_edges>, NAME##_quads<Rule::points>, NAME##_quads<Rule::edges>},                    \
        {NAME##_points<Rule::narrow_edges>, NAME##_points<Rule::points>, NAME##_points<Rule::edges>}};

EXITANCE_KERNELS(plain, four::Real, )
#ifdef __x86_64__
EXITANCE_KERNELS(wide, EightReals, EXITANCE_AVX512)
const Kernels& fastest = has_avx512() ? wide : plain;
#else
const Kernels& fastest = plain;
#endif

void copy_taken(int taken, const std::array<double, most_lanes>& F, double* out) {
    for (std::size_t i = 0; i < F.size(); ++i)
        if (taken >> i & 1) out[i] = F[i];
}

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
    const Kernels& kernels = processor == Processor::any ? plain : fastest;
    const std::size_t count = quads.size();
    const auto evaluate = [&](const double* const(&column)[16], std::size_t k, std::size_t last, double* F) {
        while (k + kernels.lanes <= last) {
            Reached run = kernels.quads[0](x, n, column, k, last, F + k);
            int taken = run.taken;
            k = run.first;
            if (k + kernels.lanes > last) return;
            if (taken == 0) {  // a run of small ones, perhaps
                const Reached small = kernels.quads[1](x, n, column, k, last, F + k);
                if (small.first > k) {
                    k = small.first;
                    continue;
                }
            }
            std::array<double, most_lanes> by_rule;
            for (int rule = 1; rule < 3 && taken != kernels.all; ++rule) {
                const int more = kernels.quads[rule](x, n, column, k, k + kernels.lanes, by_rule.data()).taken & ~taken;
                copy_taken(more, by_rule, F + k);
                taken |= more;
            }
            for (std::size_t i = 0; i < kernels.lanes; ++i)
                if (!(taken >> i & 1)) F[k + i] = point_to_polygon(x, n, quads.corners(std::min(k + i, count - 1)));
            k += kernels.lanes;
        }
    };
    const auto columns = quads.columns();
    const double* column[16];
    std::copy(columns.begin(), columns.end(), column);
    if (count >= kernels.lanes) {
        evaluate(column, 0, count, out.data());
        // The last group reaches back over quads already done.
        if (count % kernels.lanes != 0) evaluate(column, count - kernels.lanes, count, out.data());
    } else if (count > 0) {  // a copy that fills a group, by repeating the last one
        std::array<double, 16 * most_lanes> copy;
        for (std::size_t i = 0; i < 16; ++i) {
            for (std::size_t k = 0; k < kernels.lanes; ++k)
                copy[kernels.lanes * i + k] = columns[i][std::min(k, count - 1)];
            column[i] = &copy[kernels.lanes * i];
        }
        std::array<double, most_lanes> F;
        evaluate(column, 0, kernels.lanes, F.data());
        std::copy_n(F.begin(), count, out.begin());
    }
}

void ReceiverBatch::add(const Point& x, const Normal& n) {
    const double value[6] = {x.x, x.y, x.z, n.x, n.y, n.z};
    for (std::size_t i = 0; i < 6; ++i) {
        if (count_ % most_lanes == 0) column_[i].resize(count_ + most_lanes);
        std::fill_n(column_[i].begin() + static_cast<std::ptrdiff_t>(count_), most_lanes - count_ % most_lanes,
                    value[i]);
    }
    ++count_;
}

void points_to_quad(const ReceiverBatch& receivers, const std::array<Point, 4>& quad, std::span<double> out,
                    Processor processor) {
    EXI_CHECK(out.size() == receivers.size());
    const Point middle = 0.25 * ((quad[0] + quad[1]) + (quad[2] + quad[3]));
    double squared_radius = 0;
    for (const Point& corner : quad) squared_radius = std::max(squared_radius, squared_norm(corner - middle));
    const OneQuad one = {quad, middle, std::sqrt(squared_radius)};
    const Kernels& kernels = processor == Processor::any ? plain : fastest;
    const double* column[6];
    for (std::size_t i = 0; i < 6; ++i) column[i] = receivers.column_[i].data();
    for (std::size_t first = 0; first < out.size(); first += kernels.lanes) {
        std::array<double, most_lanes> F, by_rule;
        int taken = 0;
        for (int rule = 0; rule < 3 && taken != kernels.all; ++rule) {
            const int more = kernels.points[rule](one, column, first, by_rule.data()) & ~taken;
            copy_taken(more, by_rule, F.data());
            taken |= more;
        }
        for (std::size_t i = 0; i < std::min(kernels.lanes, out.size() - first); ++i) {
            const std::size_t k = first + i;
            out[k] = taken >> i & 1 ? F[i]
                                    : point_to_polygon({column[0][k], column[1][k], column[2][k]},
                                                       {column[3][k], column[4][k], column[5][k]}, quad);
        }
    }
}

}  // namespace exitance
