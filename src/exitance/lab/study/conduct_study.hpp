#pragma once

#include "exitance/lab/study/study_analysis.hpp"
#include "exitance/lab/study/study_run.hpp"

namespace exitance {

/// What a study came to.
struct StudyReport {
    StudyTables tables;
    std::vector<Verdict> verdicts;  ///< They refer to the study.
    std::size_t runs = 0, runs_done = 0;
    std::string page;                   ///< Its path.
    std::vector<std::string> warnings;  ///< "no plots: gnuplot is not installed"
};

/// Runs a study, and writes its folder: results.csv, details.csv (all columns; of studies that run `solve`), a CSV for
/// each further table, plots, pictures, index.html, study.toml. After a stop the folder holds what is finished, and the
/// same call goes on from there. Error: as of run_study, or cannot_write.
Result<StudyReport> conduct_study(const Study& study, const StudyOptions& options, Progress& progress,
                                  const StopRequest& stop);

}  // namespace exitance
