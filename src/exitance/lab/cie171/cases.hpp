#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/lab/studies/cie171.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// A scene of a case, and the values to compute for it.
struct Cie171Case {
    std::string study, scene, parameter;
    SceneDescription description;
    SolveOptions options;
    std::vector<std::string> names;  ///< Names of the points.
    std::vector<ProbePoint> points;
    std::vector<double> exact;  ///< lx
    bool direct_only = false;   ///< True if evaluated without a solution.
    std::size_t band = 0;       ///< Band that is compared.
    /// Additional fluxes: illuminance integrated over rectangles, lm.
    struct Flux {
        std::string name;
        Point origin;
        Vec3 u, v;  ///< The rectangle's front faces u x v.
        double exact = 0;
    };
    std::vector<Flux> fluxes;
};

/// Cases 5.2 to 5.4 and 5.6 to 5.8: light of lamps and of diffuse surfaces.
std::vector<Cie171Case> cie171_lamp_cases(const Cie171Options& options);

/// Cases 5.9, 5.11, 5.13, 5.14: light of sixteen skies through openings.
std::vector<Cie171Case> cie171_sky_cases(const Cie171Options& options);

}  // namespace exitance
