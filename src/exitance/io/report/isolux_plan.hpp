#pragma once

#include "exitance/io/pictures/drawing.hpp"
#include "exitance/io/report/report_figures.hpp"

namespace exitance {

/// A plan of a measuring plane to a round scale (1:5 to 1:5000), for a sheet of about A4: what the plane cuts, outlines
/// of the emitters (dashed), the values of its points, lines of equal light with their values, and its figures.
Drawing isolux_plan(const ReportFigures::Grid& grid, const LightUnit& unit, const Scene& scene);

}  // namespace exitance
