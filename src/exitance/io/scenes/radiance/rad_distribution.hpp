#pragma once

#include "exitance/io/scenes/radiance/rad_materials.hpp"
#include "exitance/scene/emission_profile.hpp"

namespace exitance {

/// Directional distribution of an emitter: its radiance by direction, relative to the emitter's, and the orientation of
/// the lamp's axes.
struct RadDistribution {
    EmissionProfile profile;
    Affine to_world;
};

/// Reads the distribution of a `brightdata` pattern as conversion programs write it: a table over one or two angles of
/// source.cal, converted to radiance by corr, flatcorr, boxcorr, lboxcorr (treated as boxcorr) or cylcorr. A
/// `brightfunc` pattern is supported if its function is one of these with a number. The table is searched in the folder
/// of the pattern's file, then in that of `scene_file`. Error: anything else. Source: Radiance's source.cal.
Result<RadDistribution> read_distribution(const RadPattern& pattern, const std::string& scene_file);

}  // namespace exitance
