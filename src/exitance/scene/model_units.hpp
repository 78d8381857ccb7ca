#pragma once

#include <optional>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// A guess at the length unit and the upright axis of a scene that was read in metres, Z up.
struct ModelUnits {
    const char* unit = nullptr;  ///< "mm", "cm" or "in" where metres make an impossible room; else null.
    bool is_too_small = false;   ///< In metres the scene is smaller than anything that people light.
    bool y_is_up = false;
};

/// Guesses by what rooms have in common. A room is what has its fronts inside at the sides of its box; its height in
/// its unit is nearest to 2.7 m by ratio. Lamps shine down; floors look up, ceilings down, as groups and materials of
/// such names tell; without either, the one open side of a box is its top.
ModelUnits guess_units(const Scene& scene);

/// Warnings that say so. `unit_given`, `axis_given`: the user has named it.
std::vector<Finding> findings_of(const ModelUnits& guess, const Scene& scene, bool unit_given, bool axis_given);

}  // namespace exitance
