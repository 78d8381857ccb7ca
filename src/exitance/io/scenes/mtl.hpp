#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// The materials of an MTL text in its order, appended to `materials`; what is wrong goes to `findings`, with the line,
/// and leaves the value at 0. `Kd` is the reflectance in [0, 1), `Ke` the emitted radiance in W/(m^2 sr): one number
/// for all bands, three, or one a band. Other keys are ignored. A name that is there already keeps its first meaning.
void parse_mtl(std::string_view text, const std::string& file, std::vector<Material>& materials,
               std::vector<Finding>& findings);

}  // namespace exitance
