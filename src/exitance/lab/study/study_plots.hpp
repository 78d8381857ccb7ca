#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/lab/study/study_analysis.hpp"

namespace exitance {

/// A plot that has been drawn.
struct DrawnPlot {
    const StudyPlot* plot = nullptr;
    std::string panel;     ///< Value that is common to its rows; empty if there is one panel.
    std::string svg, png;  ///< Paths.
};

/// Draws all plots of a study by gnuplot into FOLDER/plots, as NAME.svg, NAME.png and the script NAME.gp, or
/// NAME_PANEL.svg and so on. Plots without points are omitted. Error: failure, if gnuplot is missing or fails.
Result<std::vector<DrawnPlot>> draw_plots(const Study& study, const StudyTables& tables, const std::string& folder,
                                          const StopRequest& stop);

}  // namespace exitance
