#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "exitance/lab/study/study_run.hpp"

namespace exitance {

/// Appends a shape to a table for drawings.
///
/// drawing  name of the picture
/// shape    "dot" (1 point), "line" (2), "box" (2 opposite corners), "triangle" (3) or "circle" (its centre, and a
/// point
///          to the right of it)
/// xy       coordinates x, y of its points
/// colour   "#rrggbb"
void add_shape(Table& table, const std::string& drawing, const char* shape, std::initializer_list<double> xy,
               const std::string& colour);

/// Colour of a share in [0, 1]: dark blue for 0, yellow for 1, and lighter the larger it is.
std::string share_colour(double share);

/// A picture of the shapes of a table.
struct DrawnShapes {
    const StudyDrawing* drawing = nullptr;
    std::string name;  ///< Value of the column `drawing`.
    std::string svg;   ///< Path.
};

/// Returns the shapes of one picture as SVG text. Later shapes hide earlier ones.
std::string svg_of_shapes(const StudyDrawing& drawing, const Table& table, const std::string& name);

/// Draws all drawings of a study into FOLDER/plots. Drawings without shapes are omitted. Error: cannot_write.
Result<std::vector<DrawnShapes>> draw_shapes(const Study& study, const StudyTables& tables, const std::string& folder);

}  // namespace exitance
