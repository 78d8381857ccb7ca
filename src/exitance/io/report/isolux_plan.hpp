#pragma once

#include <span>
#include <utility>
#include <vector>

#include "exitance/io/pictures/drawing.hpp"
#include "exitance/io/report/report_figures.hpp"

namespace exitance {

/// Draws a plan of a measuring plane at a round scale (1:5 to 1:50000) for about an A4 sheet: the section of the scene,
/// outlines of emitters (dashed), the values at its points, labelled isolines, and its figures.
Drawing isolux_plan(const ReportFigures::Grid& grid, const LightUnit& unit, const Scene& scene);

/// Line segments in which a plane cuts a polygon, in the scene.
std::vector<std::pair<Point, Point>> section_of(std::span<const Point> outline, const Point& origin, const Normal& n);

}  // namespace exitance
