#pragma once

#include <vector>

#include "exitance/io/photometry/photometry.hpp"
#include "exitance/scene/point_opening.hpp"

namespace exitance {

/// A luminaire's opening as emitting faces. Every face has, in direction d, the radiance
///
///     L(d) = I(d) / A(d),   A the projected area of the whole opening.
///
/// Far away, the faces together therefore have the file's intensity exactly; near by, each part of the opening is seen
/// in its own direction. A plane opening is one face for light below it and one for light above it. Rounded bodies
/// become polyhedra of the same surface area (for plane ones, the same area), and A is that of the polyhedron. Extents
/// given in the file are kept, however small. A file without any extent (a point) gets a cube of `point_opening_size`;
/// a line, or a wall without thickness, gets a thickness of `strip_width` (`load_photometry` reports both).
struct LuminaireBody {
    struct Face {
        /// Corners in the luminaire's frame, metres, counter-clockwise seen from the front.
        std::vector<Point> corners;
        double exitance = 0;  ///< lm/m^2; 0: the face emits nothing but blocks light.
    };
    std::vector<Face> faces;
    EmissionProfile profile;                                 ///< Radiance, cd/m^2, by direction in the frame below.
    Vec3 axis_x{1, 0, 0}, axis_y{0, 1, 0}, axis_z{0, 0, 1};  ///< The table's frame, or one along a cylinder's axis.
    Vec3 in_frame(const Vec3& d) const { return {dot(axis_x, d), dot(axis_y, d), dot(axis_z, d)}; }
    double flux() const;  ///< Total flux of the faces, lm.
};

inline constexpr double strip_width = 0.01;  ///< Default extent of an opening without extent in a direction, m.

/// Size along the luminaire's axes of the body that represents an opening, metres: the file's extents if they are above
/// 0. A plane opening has the height 0.
Vec3 body_size(const Opening& opening);

LuminaireBody make_luminaire_body(const Photometry& photometry);

}  // namespace exitance
