#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/lab/study/study_analysis.hpp"

namespace exitance {

/// A plot that was drawn.
struct DrawnPlot {
    const StudyPlot* plot = nullptr;
    std::string panel;     ///< What is common to its rows; empty where there is one panel.
    std::string svg, png;  ///< Paths.
};

/// Draws all plots of a study by gnuplot into FOLDER/plots, as NAME.svg, NAME.png and the script NAME.gp, or
/// NAME_PANEL.svg and so on. Plots without points are left out. Error: failure, when gnuplot is not there or fails.
Result<std::vector<DrawnPlot>> draw_plots(const Study& study, const StudyTables& tables, const std::string& folder,
                                          const StopRequest& stop);

}  // namespace exitance
