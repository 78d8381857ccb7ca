#pragma once

#include <array>
#include <cstddef>

#include "exitance/base/spectrum.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// Number of real spherical harmonics of degrees 0 to 2. The first four have degrees 0 and 1.
constexpr std::size_t harmonic_count = 9;

/// Coefficients of a function on the sphere.
template <class Value>
using Harmonics = std::array<Value, harmonic_count>;

/// Degree l of a harmonic. The order is (l, m): (0, 0), (1, -1), (1, 0), (1, 1), (2, -2), ..., (2, 2).
constexpr std::size_t degree_of(std::size_t harmonic) {
    return harmonic == 0 ? 0 : harmonic < 4 ? 1 : 2;
}

/// Real, orthonormal spherical harmonics in direction w (unit vector), without the sign (-1)^m: (1, -1), (1, 0), (1, 1)
/// are proportional to y, z, x.
Harmonics<double> harmonics_at(const Vec3& w);

/// Factors A_l of the degrees by which irradiance follows from radiance [Ramamoorthi01]:
///
///     E(n) = sum over l of A_l sum over m of L_lm Y_lm(n).
constexpr std::array<double, 3> irradiance_factors{pi, 2 * pi / 3, pi / 4};

/// Irradiance on a plane of normal n from coefficients of radiance (W/(m^2 sr)), W/m^2. Exact if the radiance has no
/// components of higher degrees; these add at most 6% of the irradiance on a plane that faces a small source.
Spectrum irradiance_of(const Harmonics<Spectrum>& radiance, const Normal& n);

}  // namespace exitance
