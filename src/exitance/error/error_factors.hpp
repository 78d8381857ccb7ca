#pragma once

#include <span>
#include <vector>

#include "exitance/error/late_paths.hpp"

namespace exitance {

/// Parts of the scene whose errors are measured separately.
struct ErrorDomains {
    std::vector<double> light_of_room = {};   ///< Light to which a room's errors are relative, W/m^2; one per room.
    std::vector<std::uint32_t> body_of = {};  ///< Body of every sample; empty: none are distinguished.
    std::size_t bodies = 0;                   ///< Number of bodies.
    double max_factor = 1;                    ///< Largest ratio of an error to its residual, a limit on all factors.
};

/// Factors on the errors of these parts, all at least 1.
struct ErrorFactors {
    double whole = 1;
    std::vector<double> rooms = {}, bodies = {};
    /// Mean square of the light that they add over the whole scene, (W/m^2)^2: part of `LateMisfit::mean_square`.
    double explained = 0;
    std::size_t rays = 0;  ///< Number of rays cast.
};

/// Measures how much light that near surfaces reflect to each other raises errors above those that a coarse response
/// finds. Between the slats of a blind, a wrong light returns to where it came from, before distance smooths it. The
/// light m that the response lacks is then proportional to the error e in the mean: m = c e + rest, with
/// c = <e m> / <e^2>, and the error is (1 + c) e. Paths measure <e m> (`LatePaths::correlation`).
///
/// A part gets a factor if two independent sets of paths find a positive product: the first by one standard error, the
/// second, with twice as many paths, by two. The second set gives the factor. Noise alone does that in one of 250
/// cases. Parts with few samples or paths get none. Casts about `max_rays` rays, and a third of them where the first
/// paths find nothing.
ErrorFactors measure_error_factors(const LatePaths& paths, std::span<const ResidualSample> samples,
                                   std::span<const Spectrum> late, const ErrorDomains& domains, std::uint64_t seed,
                                   std::size_t max_rays);

}  // namespace exitance
