#pragma once

#include <span>
#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/io/files/table.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Programs that compute the matrix of view factors of a scene, and their accuracy.
struct ViewFactorProgramOptions {
    std::string program;              ///< Path of `exitance`.
    std::string folder;               ///< Existing folder for their files.
    std::vector<double> tolerances;   ///< Tolerances of `exitance viewfactors`, for every entry.
    std::vector<double> convergence;  ///< Values of `eps` for View3D.
    double reference_tolerance = 1e-5;
    double time_limit = 300;  ///< Seconds per run.
};

/// Compares matrices of view factors by several programs, each run in a single-threaded process, with that of `exitance
/// viewfactors` at the reference's tolerance. Adds a row per program and setting:
///
///     scene, polygons, program, setting, status (done, not reached, time limit, not run: ..., failed: ...)
///     processor_seconds, wall_seconds, peak_bytes
///     row_error         largest |sum_j F_ij - sum_j R_ij|
///     median_error, p99_error, largest_error    of |F_ij - R_ij| / R_ij over entries R_ij above 1e-5, the limit of
///                       32-bit numbers with six printed digits
///     reciprocity       largest |A_i F_ij - A_j F_ji| / (A_i max_j F_ij)
///
/// View3D is included if `view3d` or `View3D` is found in PATH. It receives faces that have more than four corners or
/// are not convex as triangles whose results it merges. Error: cannot_write; bad_input, if there is no reference. A
/// stop keeps the finished rows.
Result<void> compare_view_factor_programs(const std::string& scene_name, const std::string& scene_file,
                                          const Scene& scene, const ViewFactorProgramOptions& options, Table& out,
                                          const StopRequest& stop);

/// Converts a scene to View3D's input: vertices, one surface per face in the scene's order, binary results, convergence
/// `eps`. Every face is repeated with reversed orientation as an obstruction, since View3D's surfaces block from their
/// fronts only, ours from both sides.
std::string view3d_text(const Scene& scene, double eps);

/// A square matrix with the areas of its rows, m^2.
struct AreaMatrix {
    std::vector<double> areas, factors;  ///< n areas; n x n factors, row by row.
};

/// Reads View3D's binary output: a header of 32 bytes, areas, factors, emittances, all floats in the machine's byte
/// order. Error: bad_input, if it does not have `n` surfaces.
Result<AreaMatrix> read_view3d_result(const std::string& path, std::size_t n);

}  // namespace exitance
