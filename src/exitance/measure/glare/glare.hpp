#pragma once

#include <string>
#include <vector>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/measure/glare/glare_rules.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

/// Somebody who is glared at.
struct Observer {
    std::string name;  ///< Empty: none.
    Point eye;         ///< Metres.
    Normal view;       ///< Line of sight, of length 1.
};

/// A luminaire as an observer sees it.
struct GlareSource {
    std::string name;        ///< Of its faces' group, or of a light without extent.
    double luminance = 0;    ///< Mean of what is seen, cd/m^2; of lights without extent that of 0.005 m^2.
    double solid_angle = 0;  ///< Of what is seen, sr.
    double position = 0;     ///< p
    GlareLimit limit = GlareLimit::none;
    double term() const { return luminance * luminance * solid_angle / (position * position); }
};

/// Discomfort glare by the unified glare rating,
///
///     UGR = 8 log10(0.25 / L_b  sum L^2 omega / p^2),   L_b = E_indirect at the eye / pi.      [CIE117]
struct Glare {
    double background = 0;              ///< L_b, cd/m^2
    std::vector<GlareSource> sources;   ///< Those that count, the worst first.
    std::vector<GlareSource> left_out;  ///< Those in front of the observer that a limit of CIE 117 leaves out.
    /// Not finite where nothing counts, or all behind it is black.
    double rating() const;
    /// Does a source fill more than 0.1 sr, beyond what UGR was made for?
    bool has_large_source() const;
};

/// Glare at an observer. A source is what of a group's emitting faces touches one another, in front of the observer and
/// not hidden: its solid angle by exact pieces of at most 2e-4 sr each (as a rule), one ray a piece; p where its middle
/// is, which also decides whether it counts (`glare_limit`); what panes let through. Lights without extent, and the
/// cubes that stand for luminaires without extent, count as 0.005 m^2 wide [CIE147]; skies and suns do not count. About
/// 1 ms a luminaire. `lux`: in lx.
Glare find_glare(const RadiosityFunction& light, const Observer& observer, const LightUnit& lux);

}  // namespace exitance
