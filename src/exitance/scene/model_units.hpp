#pragma once

#include <optional>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// A guess of the length unit and the vertical axis of a scene that was read as metres with z up.
struct ModelUnits {
    const char* unit = nullptr;  ///< "mm", "cm" or "in" if a room of this size in metres is implausible; else null.
    bool is_too_small = false;   ///< True if the scene, read as metres, is smaller than anything that is lit.
    bool y_is_up = false;
};

/// Guesses by typical properties of rooms. A scene is a room if the faces at the sides of its box have their fronts
/// inside; its unit is the one that brings its height nearest to 2.7 m by ratio. The vertical axis follows from lamps,
/// which shine down, and from floors and ceilings, recognised by the names of groups and materials. Without these, the
/// single open side of a box is its top.
ModelUnits guess_units(const Scene& scene);

/// Returns warnings about the guess. `unit_given`, `axis_given`: the user has specified it.
std::vector<Finding> findings_of(const ModelUnits& guess, const Scene& scene, bool unit_given, bool axis_given);

}  // namespace exitance
