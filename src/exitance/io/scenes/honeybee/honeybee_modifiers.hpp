#pragma once

#include <map>
#include <string>
#include <vector>

#include "exitance/io/scenes/radiance/rad_words.hpp"

namespace exitance {

/// Names of the materials of a modifier set, by a key such as "wall_set.exterior_modifier".
using HoneybeeModifierSet = std::map<std::string, std::string>;

/// Honeybee's generic set for visible light, which applies where a model says nothing.
const HoneybeeModifierSet& generic_modifier_set();

/// The materials that the generic set names, in the words of Radiance.
std::vector<RadPrimitive> generic_modifiers();

}  // namespace exitance
