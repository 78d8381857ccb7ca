#pragma once

#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/io/files/table.hpp"
#include "exitance/lab/study/study.hpp"

namespace exitance {

/// Tables by name: "results", "references", "equal_time", "profiles", and those that a part of the program computes.
using StudyTables = std::map<std::string, Table>;

struct StudyOptions {
    std::string folder;   ///< Output folder; finished parts in it are not repeated.
    std::string program;  ///< The path of `exitance`.
    bool quick = false;
    std::vector<std::string> methods;  ///< Rows whose label, or a word of whose options, is one of these; empty: all.
    int threads = 0;                   ///< Threads of all simultaneous runs together; 0: all cores.
};

/// Columns of results.csv, in their order; all others are in details.csv.
extern const std::vector<std::string> result_columns;

/// Runs a study's solves, one process each, and measures every final and intermediate solution against the study's
/// reference. A row of the table is a solution: the columns of results.csv, and
///
///     row              the label
///     initial_links, added_links, iterations, polygons, processor_seconds, wall_seconds, points, noise, is_last (0 or
///     1), command
///
/// `status` is "done", "not reached" (the requested error), "time limit", "memory limit", "not run: ..." or "failed:
/// ...". References and finished runs are kept in the folder. A stop keeps the finished ones. The table `references`
/// has the differences between careful solves and paths. Error: usage or bad_input, if a scene cannot be generated;
/// cannot_write.
Result<StudyTables> run_study(const Study& study, const StudyOptions& options, Progress& progress,
                              const StopRequest& stop);

/// Runs this process's share of a study's solves, if there are several processes, and keeps their records in the folder
/// for `run_study` of the first one. Every process needs the folder under the same name. Processes agree on the error
/// only; `stop` is the request to this process. Collective.
Result<void> run_own_share(const Study& study, const StudyOptions& options, Progress& progress,
                           const StopRequest& stop);

/// True if a row of a table is selected.
bool is_chosen(const ChosenSolution& of, const Table& table, std::size_t row);
/// Returns the path of the selected solution, which is kept in the folder if the study shows it; empty if there is
/// none.
std::string kept_solution(const ChosenSolution& of, const std::string& folder);
/// Returns the path of an intermediate solution, next to the record of its run.
std::string instant_path(const std::string& stem, double at);

/// Light along the study's lines: rows of line, scene, parameter, row, setting, s (metres from the start of the line),
/// irradiance, interpolant (W/m^2, means of the bands), and the errors of both (relative to the largest reference
/// value, which is in the row "reference").
Result<Table> profile_table(const Study& study, const StudyOptions& options, Progress& progress,
                            const StopRequest& stop);

/// For every scene, parameter and setting: the time at which the first row finished, and the error of each row at that
/// time, interpolated between intermediate solutions (both as logarithms). Empty if a row has no solution by then.
Table equal_time_table(const Study& study, const Table& results);

}  // namespace exitance
