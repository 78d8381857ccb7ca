#pragma once

#include <string>
#include <string_view>

#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

// Parses changes of light as typed by users or sent by web pages. Malformed words are usage errors.

/// Parses "GROUP=FACTOR"; the last '=' is the separator.
Result<void> read_dim(std::string_view word, LightChange& change, char parted_by = '=');
/// Parses "MATERIAL=r,g,b", or one number for all bands.
Result<void> read_reflectance(std::string_view word, LightChange& change, char parted_by = '=',
                              char between_bands = ',');

}  // namespace exitance
