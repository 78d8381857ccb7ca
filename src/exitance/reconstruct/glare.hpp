#pragma once

#include <string>
#include <vector>

#include "exitance/reconstruct/radiosity_function.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

/// Somebody who is glared at.
struct Observer {
    std::string name;  ///< Empty: none.
    Point eye;         ///< Metres.
    Normal view;       ///< Line of sight, of length 1.
};

/// Guth's position index of a source seen in a direction d (any length, in front of the observer): 1 on the line of
/// sight, more the farther from it. Above the line of sight, sigma the angle to it and tau that of the plane of both
/// from the vertical, degrees,
///
///     p = exp((35.2 - 0.31889 tau - 1.22 exp(-2 tau / 9)) 1e-3 sigma
///           + (21 + 0.26667 tau - 0.002963 tau^2) 1e-5 sigma^2),
///
/// below it p = 1 + 0.8 r for r = tan sigma < 0.6, else 1 + 1.2 r. Source: [CIE117], [Iwata97].
double guth_position(const Normal& view, const Vec3& d);

/// A luminaire as an observer sees it.
struct GlareSource {
    std::string name;        ///< Of its faces' group, or of a light without extent.
    double luminance = 0;    ///< Mean of what is seen, cd/m^2; of lights without extent that of 0.005 m^2.
    double solid_angle = 0;  ///< Of what is seen, sr.
    double position = 0;     ///< p
    double term() const { return luminance * luminance * solid_angle / (position * position); }
};

/// Discomfort glare by the unified glare rating,
///
///     UGR = 8 log10(0.25 / L_b  sum L^2 omega / p^2),   L_b = E_indirect at the eye / pi.      [CIE117]
struct Glare {
    double background = 0;             ///< L_b, cd/m^2
    std::vector<GlareSource> sources;  ///< Those in view, the worst first.
    /// Not finite where nothing is in view, or all behind it is black.
    double rating() const;
    /// Does a source fill more than 0.1 sr, beyond what UGR was made for?
    bool has_large_source() const;
};

/// Glare at an observer. A source is what of a group's emitting faces touches one another, in front of the observer and
/// not hidden: its solid angle by exact pieces of at most 2e-4 sr each (as a rule), one ray a piece; p where its middle
/// is; what panes let through. Lights without extent count as 0.005 m^2 wide [CIE147]; skies and suns do not. About 1
/// ms a luminaire. `lux`: in lx.
Glare find_glare(const RadiosityFunction& light, const Observer& observer, const LightUnit& lux);

}  // namespace exitance
