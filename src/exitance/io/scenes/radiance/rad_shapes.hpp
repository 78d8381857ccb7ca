#pragma once

#include "exitance/io/scenes/radiance/rad_findings.hpp"
#include "exitance/io/scenes/radiance/rad_words.hpp"
#include "exitance/io/scenes/radiance/round_shapes.hpp"

namespace exitance {

/// True for a surface type that is converted to facets.
bool is_rad_shape(const std::string& type);

/// Polygons of a surface: polygon, ring, sphere, bubble, cone, cup, cylinder, tube.
struct RadShape {
    Facets facets;
    bool inwards = false;    ///< True if the fronts are on the inside.
    bool is_closed = false;  ///< True if the surface encloses a volume.
};

/// Converts a surface to polygons. Empty, with an error among the findings, if its numbers do not define a shape.
std::optional<RadShape> rad_shape(const RadPrimitive& p, const std::string& file, RadFindings& findings);

}  // namespace exitance
