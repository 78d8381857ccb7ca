#pragma once

#include <span>
#include <vector>

#include "exitance/error/late_paths.hpp"

namespace exitance {

/// Parts of the scene whose errors are measured separately.
struct ErrorParted {
    std::vector<double> light_of_room;        ///< Light to which a room's errors are relative, W/m^2; one per room.
    std::vector<std::uint32_t> body_of = {};  ///< Body of every sample; empty: none are distinguished.
    std::size_t bodies = 0;                   ///< Number of bodies.
};

/// Factors on the errors of the parts, all at least 1.
struct ErrorFactors {
    double whole = 1;
    std::vector<double> rooms, bodies;
    double explained = 0;  ///< Mean square of the light that they add over the whole scene, (W/m^2)^2.
    std::size_t rays = 0;  ///< Number of rays cast.
};

/// Measures how much light that near surfaces reflect to each other raises errors above those that a coarse response
/// finds. Between the slats of a blind, a wrong light returns to where it came from, before distance smooths it. The
/// light m that the response lacks is then proportional to the error e in the mean: m = c e + rest, with
/// c = <e m> / <e^2>, and the error is (1 + c) e. Paths measure <e m> (`LatePaths::correlation`).
///
/// A factor is used where the correlation is positive by one standard error, and by two for other paths, twice as many,
/// from which it is then taken: noise alone would cause that in one of 250 cases. Casts at most `max_rays` rays, and a
/// third of them where the first paths find nothing.
ErrorFactors measure_error_factors(const LatePaths& paths, std::span<const ResidualSample> samples,
                                   std::span<const Spectrum> late, const ErrorParted& parts, std::uint64_t seed,
                                   std::size_t max_rays);

}  // namespace exitance
