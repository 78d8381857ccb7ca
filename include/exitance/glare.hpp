#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "exitance/solution.hpp"

namespace exitance::api {

/// Options of daylight glare.
struct GlareOptions {
    double threshold = 2000;   ///< Luminance above which parts of the view are sources of glare, cd/m^2.
    bool is_multiple = false;  ///< The threshold is a multiple of the mean luminance in view, such as 5.
    double efficacy = 179;     ///< Luminous efficacy of light in watts, lm/W.
};

/// A source of glare: parts of the view above the threshold that belong together.
struct GlareSource {
    std::string name;        ///< Name of a group of faces or of a light, "sky" or "sun".
    Vec3 direction;          ///< Unit vector to its centre.
    double luminance = 0;    ///< Mean luminance, cd/m^2.
    double solid_angle = 0;  ///< sr
    double position = 1;     ///< Position index of its centre.
};

/// Daylight glare at an eye at one moment.
struct Glare {
    double probability = 0;  ///< Daylight glare probability, DGP.
    /// DGP if all light is less or more by the estimated error of the solution; none if that was not estimated.
    std::optional<std::array<double, 2>> bounds = {};
    std::string level;                      ///< "imperceptible", "perceptible", "disturbing" or "intolerable".
    double vertical_illuminance = 0;        ///< Illuminance of the eye's plane, lx.
    double mean_luminance = 0;              ///< Mean over the half of the directions in front of the eye, cd/m^2.
    double threshold = 0;                   ///< Luminance above which parts are sources, cd/m^2.
    std::vector<GlareSource> sources = {};  ///< In descending order of their share in glare.
};

/// Computes the daylight glare probability of EN 17037 at an eye, by sky, sun, lamps and lit surfaces, as `exitance
/// glare` does. About 0.3 s for a room. Same bits on any number of threads.
/// eye        metres
/// direction  line of sight, of any length above 0
/// Errors: usage for a place, direction, threshold or efficacy out of range; limit after a stop.
Result<Glare> glare(const Solution& solution, const Vec3& eye, const Vec3& direction, const GlareOptions& options = {},
                    const Control& control = {});

}  // namespace exitance::api
