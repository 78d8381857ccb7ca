#pragma once

#include <span>
#include <string>

#include "exitance/base/result.hpp"
#include "exitance/io/report/hours_file.hpp"
#include "exitance/what_if/daylight/glare_year.hpp"

namespace exitance {

/// Writes the daylight glare of a year at views to a folder, which is made if necessary:
///
///     glare.csv        a row per view: eye, direction, DGP that 5% of the occupied hours exceed, largest DGP,
///                      shares of the occupied hours above 0.35, 0.40 and 0.45, level of EN 17037
///     glare_hours.csv  if `format` is csv: a row per hour, a column per view
///     glare_hours.npy  else: a row per view, a column per hour, 32 bits
///
/// Error: ErrorCode::cannot_write.
Result<void> write_glare(const std::string& folder, std::span<const ProbePoint> views, std::span<const GlareYear> years,
                         std::span<const DaylightHour> hours, HoursFormat format);

}  // namespace exitance
