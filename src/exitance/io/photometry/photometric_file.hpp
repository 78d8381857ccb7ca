#pragma once

#include <string>
#include <string_view>

#include "exitance/base/result.hpp"
#include "exitance/io/photometry/photometry.hpp"

namespace exitance {

// Limits on the numbers of photometric files, far above those of luminaires.
inline constexpr double max_photometric_angles = 20000;  ///< Maximum number of angles of a table in one direction.
inline constexpr double max_photometric_candelas = 4e6;  ///< Values of a table.
inline constexpr double max_photometric_value = 1e12;    ///< Limit for any value, cd or lm.

/// Reads the text of an IES LM-63 file (1986 to 2019; types A, B and C with all their symmetries). `name` is the file's
/// name in messages. O(numbers).
/// Errors, with their line: everything that makes the light ambiguous, such as wrong counts, angles that do not ascend,
/// negative or unreadable numbers, a multiplier of 0, or no TILT line. Known harmless mistakes are repaired and
/// reported.
Result<Photometry> read_ies(std::string_view text, const std::string& name);

/// Reads an EULUMDAT file in the same way. Lamp sets are alternatives; the first is used.
Result<Photometry> read_eulumdat(std::string_view text, const std::string& name);

/// Reads a photometric file in the format of its ending, .ies or .ldt (in any case).
Result<Photometry> load_photometry(const std::string& path);

/// True if the path has the ending of a photometric file.
bool names_photometry(const std::string& path);

}  // namespace exitance
