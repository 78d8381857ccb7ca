#pragma once

#include <cstdint>

#include "exitance/base/progress.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

/// Options of a check of view factors by rays.
struct RayCheckOptions {
    std::size_t entries = 100;    ///< Number of entries, chosen at random without repetition from those above 1e-6.
    std::size_t rays = 1u << 14;  ///< Number of rays per entry; rounded up to whole batches of 64 x 16.
    std::uint64_t seed = 1;
    double tolerance = 0;  ///< Allowed relative error of the table's entries.
};

/// Result of comparing randomly chosen entries of a table with rays. The rays are independent of how the table was
/// made: they use no blockers, visible parts or quadrature.
struct RayCheck {
    std::size_t entries = 0, rays = 0;  ///< Rays of all entries together.
    double largest_deviation = 0;     ///< Largest deviation of an entry from the mean of its rays, in standard errors.
    std::size_t wrong = 0;            ///< Number of entries off by more than the tolerance plus six standard errors.
    double largest_relative = 0;      ///< Largest deviation relative to the entry.
    double relative_error_there = 0;  ///< Standard error of the rays of that entry, relative to the entry.
    double usual_relative_error = 0;  ///< Median of the rays' relative standard errors: the accuracy of the check.
    bool is_complete = true;          ///< False if a stop was requested before the last entry.
};

/// One entry as estimated by rays.
struct RayEntry {
    double F = 0, standard_error = 0;
    std::size_t rays = 0;
};

/// Estimates F_ij by pairs of points on both faces or, if these nearly touch, by directions from one of them. Uses
/// Owen-scrambled Sobol points in 64 independent batches, whose spread gives the standard error. About 0.1 us per ray.
RayEntry view_factor_by_rays(const struct RowScene& ready, std::size_t i, std::size_t j, std::size_t rays,
                             std::uint64_t seed);

/// Compares randomly chosen entries with rays. Deterministic on any number of threads.
RayCheck check_by_rays(const Scene& scene, const SparseFactors& table, const RayCheckOptions& options,
                       const StopRequest& stop);

}  // namespace exitance
