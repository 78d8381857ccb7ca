#pragma once

#include <vector>

#include "exitance/io/photometry/photometry.hpp"
#include "exitance/scene/point_opening.hpp"

namespace exitance {

/// A luminaire's opening as faces that shine: every face has, towards d, the radiance
///
///     L(d) = I(d) / A(d),   A the projected area of the whole opening,
///
/// so that far away the faces together have the file's intensity exactly, and near by every part of the opening is
/// seen under its own direction. A plane opening is one face for the light below it and one for that above.
/// Rounded bodies are polyhedra of the same surface (of the same area where they are plane), whose own projected area
/// divides. Every extent that the file gives is kept as it is, however small. A file that gives none (a point) has a
/// cube of `point_opening_size`; in a direction without extent a line or a wall is `strip_width` thick
/// (`load_photometry` reports both).
struct LuminaireBody {
    struct Face {
        std::vector<Point> corners;  ///< In the luminaire's frame, metres, counter-clockwise seen from its front.
        double exitance = 0;         ///< lm/m^2; 0 where no light leaves it: it is there to keep the body opaque.
    };
    std::vector<Face> faces;
    EmissionProfile profile;                                 ///< Radiance in cd/m^2 by directions of its frame:
    Vec3 axis_x{1, 0, 0}, axis_y{0, 1, 0}, axis_z{0, 0, 1};  ///< the table's, or that of a cylinder's axis.
    Vec3 in_frame(const Vec3& d) const { return {dot(axis_x, d), dot(axis_y, d), dot(axis_z, d)}; }
    double flux() const;  ///< Of all faces, lm.
};

inline constexpr double strip_width = 0.01;  ///< Of an opening that has an extent in other directions alone, metres.

/// The lengths of the body that stands for an opening, along the luminaire's axes, metres: those of the file where
/// they are above 0. A plane opening has a height of 0.
Vec3 body_size(const Opening& opening);

LuminaireBody make_luminaire_body(const Photometry& photometry);

}  // namespace exitance
