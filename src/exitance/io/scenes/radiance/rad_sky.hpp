#pragma once

#include <optional>
#include <string>

#include "exitance/io/scenes/radiance/rad_materials.hpp"
#include "exitance/scene/sky/distant_light.hpp"

namespace exitance {

/// What a pattern makes of a sky where it is one that gensky or gendaylit print, in closed form:
///
///     brightfunc skyfunc 2 skybr skybright.cal 0 7 KIND ZENITH GROUND FACTOR SX SY SZ   (3 KIND ZENITH GROUND)
///     brightfunc skyfunc 2 skybright perezlum.cal 0 10 DIFFUSE GROUND A B C D E SX SY SZ
///
/// value() is the factor that the glow's radiance is multiplied by. Error: why it is none of these.
Result<SkyModel> sky_of_pattern(const RadPattern& pattern);

/// A source of that radiance (W/(m^2 sr)): about a direction of length 1, over a whole angle in radians: a dome where
/// it is half of all directions, both where it is all, else a disc. Nothing where it is too wide for a disc.
std::optional<DistantLight> light_of_source(const Vec3& towards, double angle, const Spectrum& radiance,
                                            const SkyModel* pattern);

}  // namespace exitance
