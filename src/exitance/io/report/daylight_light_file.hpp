#pragma once

#include <optional>
#include <string>

#include "exitance/base/result.hpp"
#include "exitance/what_if/daylight/daylight_results.hpp"

namespace exitance {

/// Returns a hash of everything that determines the results of a simulation: the program's version, the scene, the
/// sensors with their grids, the weather and the settings. 64 hexadecimal digits.
std::string fingerprint_of(const Scene& scene, const DaylightTask& task);

/// Writes the light on the elements, which is common to all sensors, to an HDF5 file. Error: ErrorCode::cannot_write.
Result<void> write_daylight_light(const std::string& path, const std::string& fingerprint, const DaylightLight& light);

/// Reads a file of write_daylight_light(). Returns none if there is none, or if it belongs to another simulation.
/// Error: ErrorCode::bad_input if it is damaged.
Result<std::optional<DaylightLight>> read_daylight_light(const std::string& path, const std::string& fingerprint);

}  // namespace exitance
