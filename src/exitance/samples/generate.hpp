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
    double value;  ///< When nothing is said.
    double least, most;
    bool whole;
    std::string help;
};

/// A scene that can be made in many sizes.
struct SceneFamily {
    std::string name;
    std::string help;  ///< One line.
    std::vector<FamilyParameter> parameters;
};

/// All families, in the order in which they are to be listed. Every family also takes `rot=DEGREES,ax,ay,az` (a turn),
/// then `scale=S`, then `shift=x,y,z`, and `name=N`.
const std::vector<SceneFamily>& scene_families();

/// Makes a scene of a family. `file` of the result is its name with the ending .obj. Coordinates are rounded to 12
/// decimals where that changes nothing that matters (below 1e-9 of a coordinate). Error: usage, when the family or a
/// parameter is unknown, does not parse, or is out of its range.
Result<SceneDescription> generate_scene(const std::string& family,
                                        const std::map<std::string, std::string>& parameters);

}  // namespace exitance
