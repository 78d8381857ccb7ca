#pragma once

#include <mutex>
#include <optional>

#include "exitance/lab/study/study_scene.hpp"

namespace exitance {

/// One run of `solve`.
struct StudySolve {
    const Study& study;
    const StudyOptions& options;
    const StudyScene& scene;
    const StudyRow& row;
    const std::string& setting;
    double value;
    const StudyStage& stage;
};

/// Contents of the column `setting`: the row's label, and its setting if there is one.
std::string setting_text(const StudyRow& row, const std::string& setting);
/// Command line of a run, starting at `solve`, without the output file.
std::vector<std::string> solve_words(const StudySolve& run);
/// Name of all files that are kept of a run.
std::string run_name(const StudySolve& run);
/// Time limit of a run, seconds.
double study_time_limit(const StudySolve& run);

/// Adds a row to a table of results, with the values known before the run.
void begin_row(Table& table, const StudySolve& run, std::size_t checkpoint);
/// Sets the measured error in a table's last row.
void add_error(Table& table, const ErrorMeasure& error);

/// Runs a solve in a process of its own, and measures its solutions while `files` is locked; or reads an earlier
/// result. Returns nothing after a request to stop. The final solution is kept if the study shows a picture of it.
Result<std::optional<Table>> solve_for_study(const StudySolve& run, std::mutex& files, const StopRequest& stop);

}  // namespace exitance
