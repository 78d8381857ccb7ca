#pragma once

#include <memory>
#include <string>

#include "exitance/base/result.hpp"
#include "exitance/what_if/daylight/daylight_results.hpp"

namespace exitance {

/// Formats of the illuminances of all hours.
enum class HoursFormat : std::uint8_t {
    hdf5,        ///< One HDF5 file, 16 bits per number: relative rounding of 2^-12.
    hdf5_float,  ///< One HDF5 file, 32 bits per number.
    npy,         ///< NumPy files, 32 bits per number.
    csv          ///< Tables with a row per hour.
};

/// Stores lux divided by this in 16 bits, so that numbers up to 262,016 lx have a place: twice those of any sun.
constexpr double lux_per_half = 4;

/// Files with the illuminances of all hours, and the direct sunlight in them, as sensors arrive. They appear whole or
/// not at all.
class HoursFile {
  public:
    virtual ~HoursFile() = default;
    /// Adds the sensors that follow those added before. Failures are reported by finish().
    virtual void add(const DaylightBlock& block) = 0;
    /// Completes the files after the last sensor.
    virtual Result<void> finish() = 0;
};

/// Creates the files in a folder: hours.h5 (data sets illuminance and sun, a row per sensor), illuminance.npy and
/// sun.npy (a row per sensor), or illuminance.csv and sun.csv (a row per hour). `task` must outlive the result. Memory
/// does not grow with the number of sensors: 16 MB for HDF5, 64 MB for CSV.
/// Error: ErrorCode::cannot_write.
Result<std::unique_ptr<HoursFile>> make_hours_file(const std::string& folder, HoursFormat format,
                                                   const DaylightTask& task);

}  // namespace exitance
