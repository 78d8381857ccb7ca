#pragma once

#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/measure/probes/harmonics.hpp"

namespace exitance {

/// Light that arrives at a point from all directions, for objects that move.
struct LightProbe {
    Harmonics<Spectrum> radiance;        ///< Coefficients of the arriving radiance, W/(m^2 sr).
    Harmonics<Spectrum> standard_error;  ///< Errors of the coefficients, W/(m^2 sr).
    /// Share of all directions in which the back of a surface is seen. Near 1 inside a solid, where the light is
    /// meaningless; 0 in a closed room.
    double back_share = 0;
};

/// Computes light probes at points in free space (metres).
///
/// Direct light, of emitters, sky, sun and punctual lights, comes from its irradiance E(n) on planes of 150 directions,
/// which `probe` evaluates: exactly, or by rays where exact light is expensive. Its coefficients are integrals over the
/// directions, L_lm = 1/A_l int E Y_lm, by a rule that is exact up to degree 23; the error for a light without extent
/// is below 2% of its coefficient of degree 0.
///
/// Reflected light is read from the exported elements at the hits of `rays` rays, a power of two of at least 64, which
/// are stratified over the sphere. The coefficients are fitted to them by least squares, which is exact for radiance
/// without components above degree 2. Directions depend on the point alone. Standard errors come from the residuals of
/// the fit in four quarters of the rays.
///
/// Same bits on any number of threads. After a stop request, the result ends with the last finished probe.
std::vector<LightProbe> light_probes(const RadiosityFunction& light, std::span<const Point> points, unsigned rays,
                                     Progress& progress, const StopRequest& stop);

}  // namespace exitance
