#pragma once

#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/sweep/run_sweep.hpp"

namespace exitance {

/// A value per variant, or several: the cells of a row are empty if the variant has no value.
struct SweepColumn {
    std::string name;
    std::vector<std::vector<std::string>> cells;  ///< Per variant.
    bool is_list = false;  ///< True if the column holds all rows of a file: it is several columns in CSV files.
};

/// Table of a sweep, one row per variant in the order of the plan: number, state, parameters, outputs.
struct SweepResults {
    std::size_t rows = 0;
    std::vector<SweepColumn> columns;
    std::vector<std::string> problems;  ///< Variants without results, and values that are missing, one text each.
};

/// Collects the outputs of all variants that are done.
SweepResults collect_results(const SweepPlan& plan, const std::vector<VariantState>& states);

/// Writes the table as CSV. Error: cannot_write.
Result<void> write_results_csv(const SweepResults& results, const std::string& path);
/// Writes the table as HDF5: a data set per column in the group `sweep`, numbers if all values are numbers. Missing
/// numbers are NaN. Error: cannot_write.
Result<void> write_results_hdf5(const SweepResults& results, const SweepPlan& plan, const std::string& path);

}  // namespace exitance
