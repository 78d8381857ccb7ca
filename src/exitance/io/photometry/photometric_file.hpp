#pragma once

#include <string>
#include <string_view>

#include "exitance/base/result.hpp"
#include "exitance/io/photometry/photometry.hpp"

namespace exitance {

/// Reads an IES LM-63 file (1986 to 2019; types A, B and C with all their symmetries) from its text. Everything that
/// leaves the light in doubt is an error with its line: counts that do not fit, angles that do not rise, negative or
/// unreadable numbers, a multiplier of 0, a missing TILT line. What files are known to say wrongly and harmlessly is
/// repaired and told. `name` is what messages call the file. O(numbers).
Result<Photometry> read_ies(std::string_view text, const std::string& name);

/// The same of EULUMDAT. Of several sets of lamps the first is taken, since sets are alternatives.
Result<Photometry> read_eulumdat(std::string_view text, const std::string& name);

/// Reads a file by its ending, .ies or .ldt (in any case).
Result<Photometry> load_photometry(const std::string& path);

/// Is that the name of a photometric file?
bool names_photometry(const std::string& path);

}  // namespace exitance
