#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/lab/studies/cie171.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// A scene of a case, and what is asked of it.
struct Cie171Case {
    std::string study, scene, parameter;
    SceneDescription description;
    SolveOptions options;
    std::vector<std::string> names;  ///< Of the points.
    std::vector<ProbePoint> points;
    std::vector<double> exact;  ///< lx
    bool direct_only = false;   ///< Evaluated without a solution.
    std::size_t band = 0;       ///< Which band is compared.
    /// Fluxes besides: sums over rectangles of their illuminance, lm.
    struct Flux {
        std::string name;
        Point origin;
        Vec3 u, v;  ///< Seen from where u x v points.
        double exact = 0;
    };
    std::vector<Flux> fluxes;
};

/// 5.2 to 5.4, 5.6 to 5.8: light of lamps and from diffuse surfaces.
std::vector<Cie171Case> cie171_lamp_cases(const Cie171Options& options);

/// 5.9, 5.11, 5.13, 5.14: light of sixteen skies through openings.
std::vector<Cie171Case> cie171_sky_cases(const Cie171Options& options);

}  // namespace exitance
