#pragma once

#include <string>
#include <string_view>

#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

// Changes of light in words, as people and pages write them. Error: usage, for words that are not understood.

/// "GROUP=FACTOR"; the last '=' parts them.
Result<void> read_dim(std::string_view word, LightChange& change, char parted_by = '=');
/// "MATERIAL=r,g,b", or one number for all bands.
Result<void> read_reflectance(std::string_view word, LightChange& change, char parted_by = '=',
                              char between_bands = ',');

}  // namespace exitance
