#pragma once

#include "exitance/lab/study/study_drawings.hpp"
#include "exitance/lab/study/study_plots.hpp"
#include "exitance/lab/study/study_run.hpp"

namespace exitance {

/// A picture of a solution, or the two pictures of which each half is shown.
struct DrawnPicture {
    const StudyPicture* picture = nullptr;
    std::string caption;
    std::vector<std::string> files;  ///< PNG
};

/// Draws pictures of solutions that are kept in FOLDER/runs, by `exitance render`, into FOLDER/pictures. Pictures
/// without a solution are omitted.
std::vector<DrawnPicture> draw_pictures(const Study& study, const StudyOptions& options, const Table& results,
                                        const StopRequest& stop);

struct StudyPage {
    const Study& study;
    const StudyTables& tables;
    const std::vector<Verdict>& verdicts;
    const std::vector<DrawnPlot>& plots;
    const std::vector<DrawnShapes>& drawings;
    const std::vector<DrawnPicture>& pictures;
    bool quick = false;
    double seconds = 0;  ///< Time that this run of the study took.
};

/// Writes a page with conclusions, plots, pictures, tables, exact commands, and the machine.
Result<void> write_study_page(const StudyPage& page, const std::string& path);

}  // namespace exitance
