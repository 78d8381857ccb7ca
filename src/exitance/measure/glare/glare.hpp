#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/measure/glare/glare_rules.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

/// An observer at whose eye glare is computed.
struct Observer {
    std::string name;                      ///< Empty: none.
    Point eye;                             ///< Metres.
    Normal view;                           ///< Line of sight, unit vector.
    std::optional<std::size_t> room = {};  ///< Index of the observer's room; none: unknown.
};

/// A luminaire as seen by an observer.
struct GlareSource {
    std::string name;        ///< Name of the group of its faces, or of the light without extent.
    double luminance = 0;    ///< Mean over the visible part, cd/m^2; for lights without extent, over 0.005 m^2.
    double solid_angle = 0;  ///< Solid angle of the visible part, sr.
    double position = 0;     ///< Guth's position index p.
    GlareLimit limit = GlareLimit::none;
    double term() const { return luminance * luminance * solid_angle / (position * position); }
};

/// Discomfort glare by the unified glare rating,
///
///     UGR = 8 log10(0.25 / L_b  sum L^2 omega / p^2),   L_b = E_indirect at the eye / pi.      [CIE117]
struct Glare {
    double background = 0;              ///< L_b, cd/m^2
    std::vector<GlareSource> sources;   ///< Sources that contribute to UGR, in descending order of their terms.
    std::vector<GlareSource> left_out;  ///< Sources in front of the observer that a limit of CIE 117 excludes.
    /// UGR. Not finite if no source counts or the background is black.
    double rating() const;
    /// True if a source has more than 0.1 sr, which is outside the range of UGR.
    bool has_large_source() const;
};

/// Computes glare at an observer. A source is a set of emitting faces of one group that touch each other, as far as
/// they are in front of the observer and visible. Its solid angle is summed over pieces of usually at most 2e-4 sr,
/// with one ray per piece, and attenuated by panes. Its position index p, and whether it counts (`glare_limit`), follow
/// from its centre. Lights without extent, and the cubes that represent luminaires without extent, count as sources of
/// 0.005 m^2 [CIE147]; skies and suns do not count. `lux`: converts to lx. About 1 ms per luminaire.
Glare find_glare(const RadiosityFunction& light, const Observer& observer, const LightUnit& lux);

}  // namespace exitance
