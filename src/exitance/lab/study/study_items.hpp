#pragma once

#include <optional>

#include "exitance/lab/study/conduct_study.hpp"

namespace exitance {

/// Rows of one figure or table of a publication: `item`, `study`, `command`, `statement`, `judgement` (holds, does not
/// hold, not measured, quick run, not judged, not made), `measured` and `reason`. Every conclusion of the item's study
/// that starts with `says` is a row.
///
/// report  result of the item's study; none if it has no study
/// Error: bad_input, if no conclusion starts with `says`.
Result<Table> rows_of_item(const StudyItem& item, const StudyReport* report);

/// Conducts every built-in study that the items of a study name, each in FOLDER/NAME, and judges the items.
/// Error: bad_input, if there is no such study or conclusion; as conduct_study.
Result<StudyTables> item_tables(const Study& study, const StudyOptions& options, Progress& progress,
                                const StopRequest& stop);

/// Paths of the plots of a study that the items name, sorted.
std::vector<std::string> plots_of_part(const std::string& folder, const std::string& study);

}  // namespace exitance
