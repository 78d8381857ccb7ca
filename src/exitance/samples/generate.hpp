#pragma once

#include <map>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// One parameter of a scene family.
struct FamilyParameter {
    std::string name;
    double value;  ///< Default value.
    double least, most;
    bool whole;
    std::string help;
};

/// A parametric family of scenes.
struct SceneFamily {
    std::string name;
    std::string help;  ///< One line.
    std::vector<FamilyParameter> parameters;
};

/// Returns all families, in the order of listings. Every family also accepts `rot=DEGREES,ax,ay,az` (a rotation), then
/// `scale=S`, then `shift=x,y,z`, and `name=N`.
const std::vector<SceneFamily>& scene_families();

/// Generates a scene of a family. `file` of the result is its name with the extension .obj. Coordinates are rounded to
/// 12 decimals if that changes them by less than 1e-9 relative. Error: usage, if the family or a parameter is unknown,
/// or a value does not parse or is out of range.
Result<SceneDescription> generate_scene(const std::string& family,
                                        const std::map<std::string, std::string>& parameters);

}  // namespace exitance
