#pragma once

#include <string>
#include <vector>

#include "exitance/measure/glare/daylight_glare_rules.hpp"
#include "exitance/measure/glare/glare.hpp"

namespace exitance {

/// Daylight glare at an observer at one moment.
struct DaylightGlare {
    double vertical_illuminance = 0;           ///< Illuminance E_v of the eye's plane, lx.
    double mean_luminance = 0;                 ///< Mean over the half of the directions in front of the eye, cd/m^2.
    double threshold = 0;                      ///< Luminance above which parts are sources, cd/m^2.
    std::vector<DaylightGlareSource> sources;  ///< Sources, in descending order of their glare terms.
    std::vector<std::string> names;            ///< Name of each source: a group of faces, a light, "sky" or "sun".

    double probability() const;  ///< DGP
    /// DGP if all light is `factor` times as much and the sources are the same parts.
    double probability_with(double factor) const;
};

/// Computes daylight glare from the exact direct illuminance of the eye, and from the luminances in its FieldOfView.
/// About 0.3 s for a room.
DaylightGlare find_daylight_glare(const RadiosityFunction& light, const Observer& observer, const LightUnit& lux,
                                  const GlareThreshold& threshold);

}  // namespace exitance
