#include "exitance/form_factors/point_to_polygon_batch.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/check.hpp"
#include "exitance/base/limits.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/form_factors/quad_lanes.hpp"

namespace exitance {
namespace {

// One SIMD vector of quads at a time: eight with AVX-512, else four. Lanes are independent, so that results do not
// depend on the vector width.
using namespace lanes_of;
constexpr std::size_t max_lanes = lanes<EightReals>;

/// Loads the quads whose coordinates start at k, in the order of QuadBatch::columns.
template <class Real>
EXITANCE_INLINE Quads<Real> load_quads(const Point& x, const double* const (&column)[16], std::size_t k) {
    const VecOf<Real> origin = {Real{} + x.x, Real{} + x.y, Real{} + x.z};
    const auto at = [&](std::size_t i) EXITANCE_INLINE_LAMBDA {
        return VecOf<Real>{load<Real>(column[i] + k), load<Real>(column[i + 1] + k), load<Real>(column[i + 2] + k)} -
               origin;
    };
    return {{at(0), at(3), at(6), at(9)}, at(12), load<Real>(column[15] + k)};
}

/// A quad and its bounding ball.
struct OneQuad {
    std::array<Point, 4> corner;
    Point middle;
    double radius;
};

/// One quad relative to several points, and the normals of these points; their coordinates start at k.
template <class Real>
struct PointsView {
    Quads<Real> quads;
    VecOf<Real> n;
};
template <class Real>
EXITANCE_INLINE PointsView<Real> load_points(const OneQuad& quad, const double* const (&column)[6], std::size_t k) {
    const VecOf<Real> x = {load<Real>(column[0] + k), load<Real>(column[1] + k), load<Real>(column[2] + k)};
    const auto from_x = [&](const Point& p) EXITANCE_INLINE_LAMBDA {
        return VecOf<Real>{p.x - x.x, p.y - x.y, p.z - x.z};
    };
    return {{{from_x(quad.corner[0]), from_x(quad.corner[1]), from_x(quad.corner[2]), from_x(quad.corner[3])},
             from_x(quad.middle),
             Real{} + quad.radius},
            {load<Real>(column[3] + k), load<Real>(column[4] + k), load<Real>(column[5] + k)}};
}

/// Applies a rule to consecutive groups of quads from `first` on, while the rule handles all quads of a group. Returns
/// the first group in which it does not, and a bit for each quad of that group that it handled.
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
        taken = apply<rule>(n, load_quads<Real>(x, column, first), 0, F);
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
    const int taken = apply<rule>(view.n, view.quads, 0, F);
    store(F, out);
    return taken;
}

/// The two functions above compiled for a processor, one per rule. All use the same operations in the same order, hence
/// give the same bits.
struct Kernels {
    std::size_t lanes;
    int all;  ///< Mask with a bit for each lane.
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
EXITANCE_KERNELS(with_avx2, four::Real, EXITANCE_AVX2)
EXITANCE_KERNELS(with_avx512, EightReals, EXITANCE_AVX512)

const Kernels& kernels_of(Processor processor) {
    const Kernels* const of[] = {&plain, &with_avx2, &with_avx512};
    return *of[static_cast<std::size_t>(usable(processor))];
}

void copy_taken(int taken, const std::array<double, max_lanes>& F, double* out) {
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
    while (count_ % four::lanes != 0) {  // pad the last group with edges that contribute nothing
        if (count_ == squared_sine_.size()) grow();
        squared_sine_[count_] = 1, cosine_[count_] = 1, share_[count_++] = 0;
    }
    return call_for_four([&]() EXITANCE_INLINE_LAMBDA {
        four::Real total{};
        for (std::size_t k = 0; k < count_; k += four::lanes) {
            const four::Real sine = max(sqrt(four::load(&squared_sine_[k])), four::Real{} + min_length_of_product);
            total -= angle_over_sine(sine, four::load(&cosine_[k])) * four::load(&share_[k]);
        }
        return ((total[0] + total[1]) + (total[2] + total[3])) * (1 / (2 * pi));
    });
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
    const Kernels& kernels = kernels_of(processor);
    const std::size_t count = quads.size();
    const auto evaluate = [&](const double* const(&column)[16], std::size_t k, std::size_t last, double* F) {
        while (k + kernels.lanes <= last) {
            Reached run = kernels.quads[0](x, n, column, k, last, F + k);
            int taken = run.taken;
            k = run.first;
            if (k + kernels.lanes > last) return;
            if (taken == 0) {  // possibly the start of a run of small quads
                const Reached small = kernels.quads[1](x, n, column, k, last, F + k);
                if (small.first > k) {
                    k = small.first;
                    continue;
                }
            }
            std::array<double, max_lanes> by_rule;
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
        // The last group overlaps quads that are already evaluated.
        if (count % kernels.lanes != 0) evaluate(column, count - kernels.lanes, count, out.data());
    } else if (count > 0) {  // copy into a full group, repeating the last quad
        std::array<double, 16 * max_lanes> copy;
        for (std::size_t i = 0; i < 16; ++i) {
            for (std::size_t k = 0; k < kernels.lanes; ++k)
                copy[kernels.lanes * i + k] = columns[i][std::min(k, count - 1)];
            column[i] = &copy[kernels.lanes * i];
        }
        std::array<double, max_lanes> F;
        evaluate(column, 0, kernels.lanes, F.data());
        std::copy_n(F.begin(), count, out.begin());
    }
}

void ReceiverBatch::add(const Point& x, const Normal& n) {
    const double value[6] = {x.x, x.y, x.z, n.x, n.y, n.z};
    for (std::size_t i = 0; i < 6; ++i) {
        if (count_ % max_lanes == 0) column_[i].resize(count_ + max_lanes);
        std::fill_n(column_[i].begin() + static_cast<std::ptrdiff_t>(count_), max_lanes - count_ % max_lanes, value[i]);
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
    const Kernels& kernels = kernels_of(processor);
    const double* column[6];
    for (std::size_t i = 0; i < 6; ++i) column[i] = receivers.column_[i].data();
    for (std::size_t first = 0; first < out.size(); first += kernels.lanes) {
        std::array<double, max_lanes> F, by_rule;
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
