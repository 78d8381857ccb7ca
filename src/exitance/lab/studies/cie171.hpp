#pragma once

#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// One value of a test case of CIE 171:2006 (assessment of the accuracy of lighting programs): exact and computed.
struct Cie171Row {
    std::string study;      ///< Case of the report, for example "5.3".
    std::string scene;      ///< For example "area_source".
    std::string parameter;  ///< "sky=12", "rho=0.95", or empty.
    std::string point;      ///< Letter of the report, "floor 0.2,2", or the name of a flux: "flux floor".
    Point x;                ///< Metres; meaningless for fluxes.
    Normal n;
    double exact = 0;  ///< Exact value: lx, or lm for fluxes.
    double computed = 0;
    /// |computed - exact| / exact. If exact is 0: |computed| / largest exact value of the scene.
    double relative_error = 0;
};

struct Cie171Options {
    bool quick = false;           ///< Only skies 1, 5, 12 and 15, and reflectances 0.05, 0.5 and 0.95.
    std::string only;             ///< Only this case, for example "5.8"; empty: all.
    int threads = 0;              ///< Number of threads; 0: all cores.
    double error_of_cube = 1e-4;  ///< Requested error of case 5.8, the only one with reflections.
};

/// Runs the cases 5.2 to 5.4, 5.6 to 5.9, 5.11, and 5.13 and 5.14 with black masks. Scenes are built here, solved like
/// `solve` and evaluated like `probe`. Exact values are closed forms, Gauss quadrature of the skies' formulas, and for
/// 5.8 the solution of the integral equation. 5.5, 5.10 and 5.12 require glass, for which the report has no exact
/// values. Returns rows in the order of the cases. Error: failure, if a scene cannot be solved, or after a request to
/// stop.
Result<std::vector<Cie171Row>> run_cie171(const Cie171Options& options, Progress& progress, const StopRequest& stop);

/// Writes FOLDER/results.csv, one row per value
/// (study,scene,parameter,point,x,y,z,nx,ny,nz,exact,computed,relative_error), FOLDER/summary.csv, one row per case
/// (points, mean and largest relative error), and FOLDER/validation.md, a readable page (cie171/page.hpp). Creates the
/// folder if it does not exist.
Result<void> write_cie171(const std::string& folder, const std::vector<Cie171Row>& rows);

/// A row of summary.csv.
struct Cie171Summary {
    std::string study;
    std::size_t points = 0;
    double mean = 0, largest = 0;  ///< Mean and largest relative error.
    std::string worst;             ///< Scene, parameter and point of the largest error.
};
std::vector<Cie171Summary> summarize(const std::vector<Cie171Row>& rows);

}  // namespace exitance
