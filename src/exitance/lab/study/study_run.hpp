#pragma once

#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/lab/study/study.hpp"
#include "exitance/lab/study/table.hpp"

namespace exitance {

/// Tables by name: "results", "references", "equal_time", "profiles", and those that a part of the program makes.
using StudyTables = std::map<std::string, Table>;

struct StudyOptions {
    std::string folder;   ///< Where everything is written; what is finished there is not repeated.
    std::string program;  ///< The path of `exitance`.
    bool quick = false;
    std::vector<std::string> methods;  ///< Rows whose label, or a word of whose options, is one of these; empty: all.
    int threads = 0;                   ///< Of all that runs at the same time; 0: all cores.
};

/// Columns of results.csv, in their order; all others are in details.csv.
extern const std::vector<std::string> result_columns;

/// Runs a study's solves, one process each, and measures every solution and those on the way against the study's
/// reference. A row of the table is a solution: the columns of results.csv, and
///
///     row              the label
///     initial_links, iterations, polygons, processor_seconds, wall_seconds, points, noise, is_last (0 or 1), command
///
/// `status` is "done", "not reached" (the error asked for), "time limit", "memory limit", "not run: ..." or
/// "failed: ...". References and finished runs stay in the folder. A stop leaves what is finished.
/// The table `references` tells how far careful solves are from paths. Error: usage or bad_input, where a scene cannot
/// be made; cannot_write.
Result<StudyTables> run_study(const Study& study, const StudyOptions& options, Progress& progress,
                              const StopRequest& stop);

/// Does a row of a table belong to it?
bool is_chosen(const ChosenSolution& of, const Table& table, std::size_t row);
/// The path of the chosen solution, which stays in the folder where a study shows something of it; empty where there
/// is none.
std::string kept_solution(const ChosenSolution& of, const std::string& folder);
/// The path of a solution on the way, beside the record of its run.
std::string instant_path(const std::string& stem, double at);

/// Light along the study's lines: rows of line, scene, parameter, row, setting, s (metres from the line's beginning),
/// irradiance, interpolant (W/m^2, means of the bands), and error of either (relative to the largest of the reference,
/// which is the row "reference").
Result<Table> profile_table(const Study& study, const StudyOptions& options, Progress& progress,
                            const StopRequest& stop);

/// For every scene, parameter and setting: the time in which the first row finished, and the error that each row had
/// then, by interpolation between solutions on the way (both as logarithms). Empty for one without a solution by then.
Table equal_time_table(const Study& study, const Table& results);

}  // namespace exitance
