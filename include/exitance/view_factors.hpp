#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exitance/progress.hpp"
#include "exitance/scene.hpp"

namespace exitance::api {

/// Options of view factors.
struct ViewFactorOptions {
    double error = 1e-3;     ///< Limit on the error of every row: sqrt(sum of variances) + sum of bounds.
    double smallest = 0;     ///< Smaller entries are dropped.
    std::uint64_t seed = 1;  ///< Seed of the random points.
};

/// View factors between the faces of a scene as compressed sparse rows: F_ij is the share of the diffuse flux leaving
/// face i that reaches the front of face j directly. A_i F_ij = A_j F_ji up to rounding.
struct ViewFactors {
    std::vector<double> areas;           ///< Per face, m^2.
    std::vector<double> emittances;      ///< Per face: 1 - reflectance, mean over the bands.
    std::vector<std::size_t> starts;     ///< Row i is in [starts[i], starts[i + 1]) of `columns` and `values`.
    std::vector<std::uint32_t> columns;  ///< Ascending within a row.
    std::vector<double> values;
    std::vector<double> row_sums;    ///< Never normalized: 1 up to the error in a closed scene.
    std::vector<double> row_errors;  ///< Estimated error of every row.
};

/// Computes the view factors of a scene. Faces block light from both sides and receive it at their front. Same bits on
/// any number of threads.
/// Errors: usage for options out of range; limit after a stop.
Result<ViewFactors> view_factors(const Scene& scene, const ViewFactorOptions& options = {},
                                 const Control& control = {});

/// Writes view factors; the ending selects the format: .vf (View3D), .mtx (Matrix Market), .h5 or .csv. The file
/// appears whole or not at all. Error: cannot_write.
Result<void> save(const ViewFactors& factors, const std::string& path);

}  // namespace exitance::api
