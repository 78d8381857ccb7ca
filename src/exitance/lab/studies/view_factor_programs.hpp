#pragma once

#include <span>
#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/lab/study/table.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Which programs make the matrix of view factors of a scene, and how closely.
struct ViewFactorProgramOptions {
    std::string program;              ///< The path of `exitance`.
    std::string folder;               ///< For their files; it exists.
    std::vector<double> tolerances;   ///< Of `exitance viewfactors`, of every entry.
    std::vector<double> convergence;  ///< `eps` of View3D.
    double reference_tolerance = 1e-5;
    double time_limit = 300;  ///< Of a run, seconds.
};

/// Matrices of view factors as several programs make them, each a process of one thread, against the one that `exitance
/// viewfactors` makes at the reference's tolerance. Adds a row a program and setting:
///
///     scene, polygons, program, setting, status (done, not reached, time limit, not run: ..., failed: ...)
///     processor_seconds, wall_seconds, peak_bytes
///     row_error         largest |sum_j F_ij - sum_j R_ij|
///     median_error, p99_error, largest_error    of |F_ij - R_ij| / R_ij over entries R_ij above 1e-5, which is what a
///                       32-bit number and six printed digits still hold
///     reciprocity       largest |A_i F_ij - A_j F_ji| / (A_i max_j F_ij)
///
/// View3D takes part where `view3d` or `View3D` is found in PATH. A face of more than four corners, or that is not
/// convex, is given to it as triangles whose results it merges. Error: cannot_write; bad_input where there is no
/// reference. A stop leaves the rows that are done.
Result<void> compare_view_factor_programs(const std::string& scene_name, const std::string& scene_file,
                                          const Scene& scene, const ViewFactorProgramOptions& options, Table& out,
                                          const StopRequest& stop);

/// A scene as View3D's input: vertices, one surface a face in the scene's order, results in binary, convergence `eps`.
/// Every face stands there a second time, turned round, as an obstruction: View3D's surfaces block from their fronts
/// alone, ours from both sides.
std::string view3d_text(const Scene& scene, double eps);

/// A square matrix with the areas of its rows, m^2.
struct AreaMatrix {
    std::vector<double> areas, factors;  ///< n; n x n, row by row.
};

/// View3D's binary output: 32 bytes of header, areas, factors, emittances, all floats of the machine's order. Error:
/// bad_input where it is not of `n` surfaces.
Result<AreaMatrix> read_view3d_result(const std::string& path, std::size_t n);

}  // namespace exitance
