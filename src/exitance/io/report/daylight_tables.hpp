#pragma once

#include <memory>
#include <optional>
#include <string>

#include "exitance/base/result.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/radiance_matrix.hpp"
#include "exitance/io/report/honeybee_results.hpp"
#include "exitance/io/report/hours_file.hpp"
#include "exitance/what_if/daylight/daylight_results.hpp"
#include "exitance/what_if/daylight/variant_tile.hpp"
#include "exitance/what_if/daylight/view_out.hpp"

namespace exitance {

/// Choice of the files of a daylight simulation.
struct DaylightFormats {
    HoursFormat hours = HoursFormat::hdf5;
    std::optional<MatrixFormat> matrix;  ///< Radiance's matrix, matrix.mtx; none: matrix.csv.
    bool honeybee = false;               ///< True if Honeybee's results folder, `honeybee`, is written as well.
};

/// A file with the daylight coefficients of sensors as they arrive. It appears whole or not at all.
class MatrixFile {
  public:
    virtual ~MatrixFile() = default;
    virtual void add(const DaylightMatrix& matrix) = 0;
    virtual Result<void> finish() = 0;
};

/// Writes the results of sensors to a folder as they arrive; every file appears whole or not at all:
///
///     hours         illuminances of all hours, see make_hours_file()
///     metrics.csv   one row per sensor: position, DF, DA, UDI, hours of sun, results for EN 17037, and the bounds of
///                   these (_low, _high)
///     matrix.csv    one row per sensor, one column per sky patch: lx for 1 cd/m^2; or matrix.mtx
///     grids.csv     one row per grid: name, number of sensors, mean daylight factor, relative RMS errors
///     view.csv      one row per eye point: position, angle, distance, layers and level of the view (if requested)
///     summary.csv   name, value
class DaylightFiles {
  public:
    /// The folder is created if necessary. `task` must outlive this object. Error: ErrorCode::cannot_write.
    static Result<DaylightFiles> create(const std::string& folder, const DaylightTask& task,
                                        const DaylightFormats& formats);

    /// Adds the sensors that follow those added before.
    Result<void> add(const DaylightBlock& block);
    /// Completes the files after the last sensor. `views`: one per eye point, or empty.
    Result<void> finish(const DaylightSummary& summary, std::span<const Point> eyes, std::span<const ViewOut> views);

  private:
    DaylightFiles(std::string folder, const DaylightTask& task, std::unique_ptr<HoursFile> hours, AtomicFile metrics,
                  std::unique_ptr<MatrixFile> matrix);

    std::string folder_;
    const DaylightTask* task_;
    std::unique_ptr<HoursFile> hours_;
    AtomicFile metrics_;
    std::unique_ptr<MatrixFile> matrix_;
    std::optional<HoneybeeResults> honeybee_;
};

/// Writes states.csv: month, day and hour, and the number of the state of every group, from 0, a row per hour.
Result<void> write_states(const std::string& folder, const DaylightStates& states, const HourlyStates& hourly,
                          std::span<const DaylightHour> hours);

/// Writes variants.csv: name, a factor per group, and the results of all sensors, a row per variant.
Result<void> write_variants(const std::string& folder, const DaylightTask& task,
                            std::span<const VariantSummary> variants);

/// Names and values in summary.csv. Some names contain the target: sDA_300_50, sDA_300_50_low, sDA_300_50_high and
/// mean_cDA_300 for 300 lx.
std::vector<std::pair<std::string, double>> summary_values(const DaylightTask& task, const DaylightSummary& summary,
                                                           std::span<const ViewOut> views);

}  // namespace exitance
