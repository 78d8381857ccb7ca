#pragma once

#include <vector>

#include "exitance/io/photometry/photometry.hpp"

namespace exitance {

/// A luminaire's opening as faces that shine: every face has, towards d, the radiance
///
///     L(d) = I(d) / A(d),   A the projected area of the whole opening,
///
/// so that far away the faces together have the file's intensity exactly, and near by every part of the opening is
/// seen under its own direction. A plane opening is one face for the light below it and one for that above.
/// Rounded bodies are polyhedra of the same surface (of the same area where they are plane), whose own projected area
/// divides. A point is a cube of 1 mm. A line is 1 cm wide.
struct LuminaireBody {
    struct Face {
        std::vector<Point> corners;  ///< In the luminaire's frame, metres, counter-clockwise seen from its front.
        double exitance = 0;         ///< lm/m^2; 0 where no light leaves it: it is there to keep the body opaque.
    };
    std::vector<Face> faces;
    EmissionProfile profile;   ///< Radiance in cd/m^2 by directions of the table's frame (Photometry::axis_x, ...).
    double flux() const;       ///< Of all faces, lm.
    bool is_enlarged = false;  ///< A line that has been given a width, for example.
};

LuminaireBody make_luminaire_body(const Photometry& photometry);

}  // namespace exitance
