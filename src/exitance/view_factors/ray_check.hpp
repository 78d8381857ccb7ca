#pragma once

#include <cstdint>

#include "exitance/base/progress.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

/// How much a table of view factors is to be looked at by rays.
struct RayCheckOptions {
    std::size_t entries = 100;    ///< Drawn from those above 1e-6, none twice.
    std::size_t rays = 1u << 14;  ///< An entry; rounded up to whole batches of 64 x 16.
    std::uint64_t seed = 1;
    double tolerance = 0;  ///< Relative: by which the table's entries may be off.
};

/// What rays say about entries of a table that were drawn by lot. They share nothing with how the table was made but
/// the scene: no blockers, no visible parts, no quadrature.
struct RayCheck {
    std::size_t entries = 0, rays = 0;  ///< Rays in all.
    double largest_deviation = 0;       ///< Standard errors of the rays' mean, of the entry farthest off in them.
    std::size_t wrong = 0;              ///< Entries off by more than the tolerance and six standard errors.
    double largest_relative = 0;        ///< Of the entry, where that is largest.
    double relative_error_there = 0;    ///< Standard error of the rays there, relative to the entry.
    double usual_relative_error = 0;    ///< Its median: what rays can tell.
    bool is_complete = true;            ///< False: stopped before the last entry.
};

/// One entry by rays.
struct RayEntry {
    double F = 0, standard_error = 0;
    std::size_t rays = 0;
};

/// F_ij by pairs of points on both faces, or, where these nearly touch, by directions from i: Owen-scrambled Sobol
/// points in 64 independent batches, whose spread is the standard error. About 0.1 us a ray.
RayEntry view_factor_by_rays(const Scene& scene, const class RayTracer& tracer, SurfaceId i, SurfaceId j,
                             std::size_t rays, std::uint64_t seed);

/// Compares entries with rays. The same on any number of threads.
RayCheck check_by_rays(const Scene& scene, const SparseFactors& table, const RayCheckOptions& options,
                       const StopRequest& stop);

}  // namespace exitance
