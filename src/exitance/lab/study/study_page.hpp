#pragma once

#include "exitance/lab/study/study_plots.hpp"
#include "exitance/lab/study/study_run.hpp"

namespace exitance {

/// A picture of a solution, or the two that are shown half and half.
struct DrawnPicture {
    const StudyPicture* picture = nullptr;
    std::string caption;
    std::vector<std::string> files;  ///< PNG
};

/// Pictures of solutions that stayed in FOLDER/runs, by `exitance render`, into FOLDER/pictures; those whose run has no
/// solution are left out.
std::vector<DrawnPicture> draw_pictures(const Study& study, const StudyOptions& options, const Table& results,
                                        const StopRequest& stop);

struct StudyPage {
    const Study& study;
    const StudyTables& tables;
    const std::vector<Verdict>& verdicts;
    const std::vector<DrawnPlot>& plots;
    const std::vector<DrawnPicture>& pictures;
    bool quick = false;
    double seconds = 0;  ///< That this run of the study took.
};

/// Writes a page that holds everything: what is concluded, plots, pictures, tables, exact commands, the machine.
Result<void> write_study_page(const StudyPage& page, const std::string& path);

}  // namespace exitance
