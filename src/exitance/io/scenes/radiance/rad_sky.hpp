#pragma once

#include <optional>

#include "exitance/io/scenes/radiance/rad_materials.hpp"
#include "exitance/scene/sky/distant_light.hpp"

namespace exitance {

/// Converts a sky pattern as printed by gensky or gendaylit to a closed form:
///
///     brightfunc skyfunc 2 skybr skybright.cal 0 7 KIND ZENITH GROUND FACTOR SX SY SZ   (3 KIND ZENITH GROUND)
///     brightfunc skyfunc 2 skybright perezlum.cal 0 10 DIFFUSE GROUND A B C D E SX SY SZ
///
/// The sky's value() multiplies the radiance of the glow. Error: the pattern is not one of these; the message says why.
Result<SkyModel> sky_of_pattern(const RadPattern& pattern);

/// Makes the distant light of a `source` with a radiance in W/(m^2 sr), around the unit vector `towards`, with an
/// opening angle in radians (diameter). A half space becomes a dome and the full sphere two domes; smaller sources
/// become a disc. Empty if the source is too large for a disc.
std::optional<DistantLight> light_of_source(const Vec3& towards, double angle, const Spectrum& radiance,
                                            const SkyModel* pattern);

}  // namespace exitance
