#pragma once

#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// One value of a case of CIE 171:2006 (test cases to assess the accuracy of lighting programs): exact, and as solved.
struct Cie171Row {
    std::string study;      ///< The report's case: "5.3".
    std::string scene;      ///< "area_source"
    std::string parameter;  ///< "sky=12", "rho=0.95", or empty.
    std::string point;      ///< The report's letter, "floor 0.2,2", or what a flux is of: "flux floor".
    Point x;                ///< Metres; of fluxes of no meaning.
    Normal n;
    double exact = 0;  ///< lx; of fluxes lm.
    double computed = 0;
    /// |computed - exact| / exact; where exact is 0, |computed| over the largest exact value of the same scene.
    double relative_error = 0;
};

struct Cie171Options {
    bool quick = false;           ///< Skies 1, 5, 12 and 15 alone, and reflectances 0.05, 0.5 and 0.95.
    std::string only;             ///< One case, "5.8"; empty: all.
    int threads = 0;              ///< 0: all cores.
    double error_of_cube = 1e-4;  ///< Asked for of case 5.8, the one that reflects.
};

/// Runs the cases 5.2 to 5.4, 5.6 to 5.9, 5.11, and 5.13 and 5.14 with black masks: scenes built here, solved as
/// `solve` does and evaluated as `probe` does. Exact values are closed forms, Gauss quadrature of the skies' formulas,
/// and for 5.8 the solution of the integral equation. 5.5, 5.10 and 5.12 ask for glass, for which the report has no
/// exact values. Rows in the order of the cases. Error: failure, when a scene cannot be solved, or a stop was asked
/// for.
Result<std::vector<Cie171Row>> run_cie171(const Cie171Options& options, Progress& progress, const StopRequest& stop);

/// Writes FOLDER/results.csv, a row a value (study,scene,parameter,point,x,y,z,nx,ny,nz,exact,computed,relative_error),
/// FOLDER/summary.csv, a row a case: points, mean and largest relative error, and FOLDER/validation.md, a page for
/// people (cie171/page.hpp). The folder is made where it is missing.
Result<void> write_cie171(const std::string& folder, const std::vector<Cie171Row>& rows);

/// A row of summary.csv.
struct Cie171Summary {
    std::string study;
    std::size_t points = 0;
    double mean = 0, largest = 0;  ///< Of relative errors.
    std::string worst;             ///< Scene, parameter and point of the largest.
};
std::vector<Cie171Summary> summarize(const std::vector<Cie171Row>& rows);

}  // namespace exitance
