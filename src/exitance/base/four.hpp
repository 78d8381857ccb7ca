#pragma once

#include <cmath>
#include <cstddef>

#include "exitance/base/processor.hpp"
#include "exitance/base/vec.hpp"

// SIMD arithmetic on several doubles at a time for the kernels of this folder. Uses the compiler's vector types, which
// compile to the vector instructions of the target processor.

namespace exitance::lanes_of {

using EightReals = double __attribute__((vector_size(64)));
template <class Real>
constexpr std::size_t lanes = sizeof(Real) / sizeof(double);

template <class Real>
struct VecOf {
    Real x, y, z;
};
template <class Real>
EXITANCE_INLINE VecOf<Real> operator-(const VecOf<Real>& a, const VecOf<Real>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
EXITANCE_INLINE VecOf<Real> operator+(const VecOf<Real>& a, const VecOf<Real>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
EXITANCE_INLINE VecOf<Real> operator*(double s, const VecOf<Real>& a) {
    return {s * a.x, s * a.y, s * a.z};
}
template <class Real>
EXITANCE_INLINE Real dot(const VecOf<Real>& a, const VecOf<Real>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
EXITANCE_INLINE Real dot(const Normal& n, const VecOf<Real>& a) {
    return n.x * a.x + n.y * a.y + n.z * a.z;
}
template <class Real>
EXITANCE_INLINE VecOf<Real> cross(const VecOf<Real>& a, const VecOf<Real>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Real>
EXITANCE_INLINE Real load(const double* p) {
    Real out;
    __builtin_memcpy(&out, p, sizeof out);
    return out;
}
template <class Real>
EXITANCE_INLINE void store(const Real& v, double* p) {
    __builtin_memcpy(p, &v, sizeof v);
}
template <class Real>
EXITANCE_INLINE Real sqrt(const Real& v) {
    Real out;
#pragma GCC unroll 8
    for (std::size_t i = 0; i < lanes<Real>; ++i) out[i] = std::sqrt(v[i]);
    return out;
}
/// Returns a b + c with one rounding. For kernels whose results must not depend on the vector width: the products that
/// the compiler contracts vary with the width.
template <class Real>
EXITANCE_INLINE Real fused(const Real& a, const Real& b, const Real& c) {
    Real out;
#pragma GCC unroll 8
    for (std::size_t i = 0; i < lanes<Real>; ++i) out[i] = __builtin_fma(a[i], b[i], c[i]);
    return out;
}
template <class Real>
EXITANCE_INLINE Real max(const Real& a, const Real& b) {
    return a > b ? a : b;
}
template <class Real>
EXITANCE_INLINE Real min(const Real& a, const Real& b) {
    return a < b ? a : b;
}

/// Returns atan(t) / t for |t| <= tan(pi/8) from z = t^2: a polynomial through Chebyshev points, error 4e-17.
template <class Real>
EXITANCE_INLINE Real angle_over_tangent(const Real& z) {
    constexpr double c[11] = {1.0,
                              -0.3333333333332844,
                              0.1999999999885511,
                              -0.14285714180976467,
                              0.11111106180455946,
                              -0.09090773074808414,
                              0.07689953496306857,
                              -0.06640233930429408,
                              0.056883492268090106,
                              -0.04348052215716462,
                              0.021135373157693246};
    const Real w = z * z, v = w * w;
    const auto pair = [&](int k) EXITANCE_INLINE_LAMBDA { return fused(Real{} + c[k + 1], z, Real{} + c[k]); };
    // Estrin's scheme: short chains, so that edges overlap in the pipeline.
    const Real low = fused(w, pair(2), pair(0)), middle = fused(w, pair(6), pair(4)),
               high = fused(w, Real{} + c[10], pair(8));
    return fused(v, fused(v, high, middle), low);
}

/// Returns atan2(y, x) / y for y > 0. The quotient of the smaller and the larger coordinate is reduced below tan(pi/8)
/// by a rotation of pi/4. Both quotients share one division.
template <class Real>
EXITANCE_INLINE Real angle_over_sine(const Real& y, const Real& x) {
    const Real away = max(x, -x), low = min(y, away), high = max(y, away);
    const auto turned = low > 0.41421356237309503 * high;
    const Real under = turned ? low + high : high, inverse = 1 / (under * y);
    const Real t = (turned ? low - high : low) * y * inverse, p = angle_over_tangent(t * t);
    // The angle is base + sign t p; base and sign depend on the octant.
    const auto steep = y > away, back = x < 0;
    const Real eighth = turned ? Real{} + pi / 4 : Real{};
    Real a = t * p + eighth;
    a = steep ? pi / 2 - a : a;
    a = back ? pi - a : a;
    return a * under * inverse;
}

}  // namespace exitance::lanes_of

namespace exitance::four {

using namespace lanes_of;
constexpr std::size_t lanes = 4;
using Real = double __attribute__((vector_size(32)));
using Mask = long long __attribute__((vector_size(32)));
using Vec = lanes_of::VecOf<Real>;

EXITANCE_INLINE Real load(const double* p) {
    return lanes_of::load<Real>(p);
}
/// Returns a bit for each lane whose sign bit is set; comparisons set it where they hold.
EXITANCE_INLINE int bits(const Mask& m) {
#ifdef __SSE2__  // in two halves, which every target supports
    using Half = double __attribute__((vector_size(16)));
    Half half[2];
    __builtin_memcpy(half, &m, sizeof m);
    return __builtin_ia32_movmskpd(half[0]) | __builtin_ia32_movmskpd(half[1]) << 2;
#else
    return (m[0] < 0 ? 1 : 0) | (m[1] < 0 ? 2 : 0) | (m[2] < 0 ? 4 : 0) | (m[3] < 0 ? 8 : 0);
#endif
}
EXITANCE_INLINE bool any(const Mask& m) {
    return bits(m) != 0;
}
EXITANCE_INLINE Mask less(const Real& a, const Real& b) {
    return a < b;
}
EXITANCE_INLINE Mask differ(const Real& a, const Real& b) {
    return a != b;
}
EXITANCE_INLINE Real pick(const Mask& m, const Real& a, const Real& b) {
    return m ? a : b;
}

}  // namespace exitance::four
