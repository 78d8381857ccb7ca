#pragma once

#include "exitance/io/scenes/radiance/rad_materials.hpp"
#include "exitance/scene/emission_profile.hpp"

namespace exitance {

/// What a pattern says of an emitter's light: radiance (of an emitter of radiance 1) by direction, and where the
/// lamp's axes go.
struct RadDistribution {
    EmissionProfile profile;
    Affine to_world;
};

/// Reads `brightdata` as conversion programs write it: a table over one angle of source.cal or two, made radiance by
/// corr, flatcorr, boxcorr, lboxcorr (as boxcorr) or cylcorr; and `brightfunc` where its function is one of these of a
/// number. Everything else is an error that says so. The table stands beside the pattern's file, or beside
/// `scene_file`. Source: Radiance's source.cal.
Result<RadDistribution> read_distribution(const RadPattern& pattern, const std::string& scene_file);

}  // namespace exitance
