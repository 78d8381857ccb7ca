#pragma once

#include "exitance/lab/study/study_analysis.hpp"
#include "exitance/lab/study/study_run.hpp"

namespace exitance {

/// Result of a study.
struct StudyReport {
    StudyTables tables;
    std::vector<Verdict> verdicts;  ///< Results of the study's claims; they refer to the study.
    std::size_t runs = 0, runs_done = 0;
    std::string page;                   ///< Path of the page.
    std::vector<std::string> warnings;  ///< For example "no plots: gnuplot is not installed".
};

/// Runs a study and writes its folder: results.csv, details.csv (all columns; only for studies that run `solve`), a CSV
/// file per further table, plots, pictures, index.html, study.toml. After a stop the folder contains the finished
/// parts, and the same call resumes the study. Error: as run_study, or cannot_write.
Result<StudyReport> conduct_study(const Study& study, const StudyOptions& options, Progress& progress,
                                  const StopRequest& stop);

}  // namespace exitance
