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

/// What the column `setting` holds: the row's label, and its setting where there is one.
std::string setting_text(const StudyRow& row, const std::string& setting);
/// The program's words for a run, from `solve` on, without the file that is written.
std::vector<std::string> solve_words(const StudySolve& run);
/// The name of everything that is kept of a run.
std::string run_name(const StudySolve& run);
/// Seconds that it may take.
double study_time_limit(const StudySolve& run);

/// A new row of a table of results, with what is known before a run.
void begin_row(Table& table, const StudySolve& run, std::size_t checkpoint);
/// The measured error of a table's last row.
void add_error(Table& table, const ErrorMeasure& error);

/// Runs a solve in a process of its own, and measures its solutions while `files` is held; or reads what was found
/// before. Nothing where a stop was asked for. The last solution stays, for pictures, where the study shows one of it.
Result<std::optional<Table>> solve_for_study(const StudySolve& run, std::mutex& files, const StopRequest& stop);

}  // namespace exitance
