#pragma once

#include <optional>
#include <string>

#include "exitance/base/result.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/what_if/daylight/daylight_results.hpp"

namespace exitance {

/// Writes a results folder as Honeybee does, as sensors arrive:
///
///     GRID.ill          one row per sensor, one column per hour with light in the weather: lx
///     sun-up-hours.txt  these hours: the middle of each, in hours since the beginning of the year
///     grids_info.json   names and sizes of the grids
class HoneybeeResults {
  public:
    /// `task` must outlive this object. The folder is created if necessary. Error: ErrorCode::cannot_write.
    static Result<HoneybeeResults> create(const std::string& folder, const DaylightTask& task);

    /// Adds the sensors that follow those added before.
    Result<void> add(const DaylightBlock& block);
    Result<void> finish();

  private:
    HoneybeeResults(std::string folder, const DaylightTask& task);
    std::string path(const std::string& name) const;
    Result<void> open_grid();

    std::string folder_;
    const DaylightTask* task_;
    std::vector<std::size_t> lit_;     ///< Indices of the hours with light.
    std::vector<std::string> names_;   ///< File names of the grids.
    std::size_t grid_ = 0, rows_ = 0;  ///< Number of complete grids, and of rows of the next.
    std::optional<AtomicFile> file_;   ///< File of the next grid.
};

}  // namespace exitance
