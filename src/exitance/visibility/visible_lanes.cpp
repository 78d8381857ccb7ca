#include "exitance/visibility/visible_lanes.hpp"

#include <cmath>

#include "exitance/base/four.hpp"
#include "exitance/base/limits.hpp"
#include "exitance/base/processor.hpp"

#ifdef EXITANCE_HAS_WIDE_KERNELS
#include <immintrin.h>
#endif

namespace exitance {
namespace {

namespace of_four {

using namespace four;
constexpr int all_lanes = 15;
#include "exitance/visibility/visible_lanes_group.inc"

void look(const SightTables& tables, const double* u, const double* v, std::size_t first, Views& views) {
    Group group(tables, u + first, v + first);
    group.run(views, first);
}

}  // namespace of_four

#ifdef EXITANCE_HAS_WIDE_KERNELS
#pragma GCC push_options
#pragma GCC target("avx2,fma")
namespace of_four_by_avx2 {

using four::any;
using four::differ;
using four::less;
using four::load;
using four::Mask;
using four::pick;
using four::Real;
using four::Vec;
using lanes_of::angle_over_sine;
using lanes_of::angle_over_tangent;
using lanes_of::fused;
using lanes_of::max;
using lanes_of::min;
using lanes_of::sqrt;
using lanes_of::store;
constexpr int all_lanes = 15;

EXITANCE_INLINE int bits(const Mask& m) {
    return _mm256_movemask_pd(reinterpret_cast<const __m256d&>(m));
}
#include "exitance/visibility/visible_lanes_group.inc"

void look(const SightTables& tables, const double* u, const double* v, std::size_t first, Views& views) {
    Group group(tables, u + first, v + first);
    group.run(views, first);
}

}  // namespace of_four_by_avx2
#pragma GCC pop_options

#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,avx512vl,avx512bw,prefer-vector-width=512")
namespace of_eight {

using lanes_of::angle_over_sine;
using lanes_of::angle_over_tangent;
using lanes_of::fused;
using lanes_of::max;
using lanes_of::min;
using lanes_of::sqrt;
using lanes_of::store;
constexpr int all_lanes = 255;
using Real = double __attribute__((vector_size(64)));
using Vec = lanes_of::VecOf<Real>;

/// A mask with one bit per lane. The kernels of four lanes use vectors of comparison results instead, but GCC 12 would
/// split a vector of eight in two.
struct Mask {
    __mmask8 lanes;
};
EXITANCE_INLINE Mask operator&(Mask a, Mask b) {
    return {static_cast<__mmask8>(a.lanes & b.lanes)};
}
EXITANCE_INLINE Mask operator|(Mask a, Mask b) {
    return {static_cast<__mmask8>(a.lanes | b.lanes)};
}
EXITANCE_INLINE Mask operator^(Mask a, Mask b) {
    return {static_cast<__mmask8>(a.lanes ^ b.lanes)};
}
EXITANCE_INLINE Mask operator~(Mask a) {
    return {static_cast<__mmask8>(~a.lanes)};
}
EXITANCE_INLINE Mask& operator|=(Mask& a, Mask b) {
    return a = a | b;
}
EXITANCE_INLINE Mask& operator&=(Mask& a, Mask b) {
    return a = a & b;
}
EXITANCE_INLINE int bits(Mask m) {
    return m.lanes;
}
EXITANCE_INLINE bool any(Mask m) {
    return m.lanes != 0;
}
EXITANCE_INLINE Mask less(const Real& a, const Real& b) {
    return {_mm512_cmp_pd_mask(a, b, _CMP_LT_OQ)};
}
EXITANCE_INLINE Mask differ(const Real& a, const Real& b) {
    return {_mm512_cmp_pd_mask(a, b, _CMP_NEQ_UQ)};
}
EXITANCE_INLINE Real pick(Mask m, const Real& a, const Real& b) {
    return _mm512_mask_blend_pd(m.lanes, b, a);
}
EXITANCE_INLINE Real load(const double* p) {
    return lanes_of::load<Real>(p);
}
#include "exitance/visibility/visible_lanes_group.inc"

void look(const SightTables& tables, const double* u, const double* v, Views& views) {
    Group group(tables, u, v);
    group.run(views, 0);
}

}  // namespace of_eight
#pragma GCC pop_options
#endif

}  // namespace

Views look_from_points(const SightTables& tables, const double* u, const double* v, std::size_t count,
                       Processor processor) {
    Views views;
    auto* look = &of_four::look;
#ifdef EXITANCE_HAS_WIDE_KERNELS
    processor = usable(processor);
    if (processor == Processor::avx512 && count > four::lanes) {
        of_eight::look(tables, u, v, views);
        return views;
    }
    if (processor != Processor::any) look = &of_four_by_avx2::look;
#else
    (void)processor;
#endif
    for (std::size_t first = 0; first < count; first += four::lanes) look(tables, u, v, first, views);
    return views;
}

}  // namespace exitance
