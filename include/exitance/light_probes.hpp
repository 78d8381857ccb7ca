#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "exitance/solution.hpp"

namespace exitance::api {

/// Number of spherical harmonics of a light probe: degrees 0 to 2.
inline constexpr std::size_t harmonic_count = 9;

/// Light that arrives at a point from all directions, as real orthonormal spherical harmonics in the order (l, m):
/// (0, 0), (1, -1), (1, 0), (1, 1), (2, -2), ..., (2, 2), without the sign (-1)^m.
struct LightProbe {
    std::array<Spectrum, harmonic_count> radiance = {};        ///< Coefficients of radiance, W/(m^2 sr); or cd/m^2.
    std::array<Spectrum, harmonic_count> standard_error = {};  ///< Standard errors of the coefficients.
    /// Share of all directions in which the back of a surface is seen. Near 1 inside a solid, where the light is
    /// meaningless; 0 in a closed room.
    double back_share = 0;

    /// Irradiance on a plane, W/m^2: the sum of pi, 2 pi / 3 and pi / 4 times the terms of degrees 0, 1 and 2.
    /// normal  of any length above 0
    Spectrum irradiance(const Vec3& normal) const;
};

/// Options of light probes.
struct LightProbeOptions {
    int rays = 1024;  ///< Rays per probe for reflected light: a power of two from 64 to 1048576.
};

/// Computes light probes at points in the air, as `exitance probes` does. Direct light is exact or by rays; reflected
/// light is read by rays, with a standard error. Same bits on any number of threads.
/// points  metres
/// Errors: usage if a coordinate is not finite, or for another number of rays; limit after a stop.
Result<std::vector<LightProbe>> light_probes(const Solution& solution, std::span<const Vec3> points,
                                             const LightProbeOptions& options = {}, const Control& control = {});

}  // namespace exitance::api
