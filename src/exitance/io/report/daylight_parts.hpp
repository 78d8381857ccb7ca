#pragma once

#include <string>

#include "exitance/io/files/npy_file.hpp"
#include "exitance/what_if/daylight/daylight_results.hpp"

namespace exitance {

/// Part `part` (from 1) of `parts` of the sensors of a simulation.
struct DaylightPart {
    std::size_t part = 1, parts = 1;

    /// Folder of its results in the folder of the simulation.
    std::string folder(const std::string& output) const;
};

/// Writes all results of the sensors of a part, exactly, for merge_daylight_parts():
///
///     illuminance.npy, sun.npy  lx, 32 bits: a row per sensor, a column per hour
///     matrix.npy                32 bits: direct light of every patch, then reflected light
///     results.npy               64 bits: the numbers of SensorResults
///     part.txt                  fingerprint of the simulation; is written last
class DaylightPartWriter {
  public:
    /// Error: ErrorCode::cannot_write.
    static Result<DaylightPartWriter> create(const std::string& folder, const DaylightTask& task, std::size_t sensors,
                                             std::size_t patches, const std::string& fingerprint);
    void add(const DaylightBlock& block);
    Result<void> finish();

  private:
    DaylightPartWriter(std::string folder, std::string fingerprint, NpyWriter illuminance, NpyWriter sun,
                       NpyWriter matrix, NpyWriter results)
        : folder_(std::move(folder)),
          fingerprint_(std::move(fingerprint)),
          illuminance_(std::move(illuminance)),
          sun_(std::move(sun)),
          matrix_(std::move(matrix)),
          results_(std::move(results)) {}

    std::string folder_, fingerprint_;
    NpyWriter illuminance_, sun_, matrix_, results_;
};

/// Returns the number of parts into which the simulation in a folder is divided. Error: ErrorCode::bad_input, if there
/// are none, or parts of different divisions.
Result<std::size_t> count_daylight_parts(const std::string& output);

/// Passes the results of all parts to `sink` in the order of the sensors, as a simulation of the whole does, but for
/// the replicates of the matrix. Errors: ErrorCode::bad_input, if a part is missing, incomplete or of another
/// simulation; that of the sink.
Result<void> merge_daylight_parts(const std::string& output, std::size_t parts, const DaylightTask& task,
                                  const std::string& fingerprint, const DaylightSink& sink);

}  // namespace exitance
