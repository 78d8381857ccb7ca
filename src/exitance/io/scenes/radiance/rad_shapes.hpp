#pragma once

#include "exitance/io/scenes/radiance/rad_findings.hpp"
#include "exitance/io/scenes/radiance/rad_words.hpp"
#include "exitance/io/scenes/radiance/round_shapes.hpp"

namespace exitance {

/// Is this a type of surface that facets make up?
bool is_rad_shape(const std::string& type);

/// The polygons of a surface: polygon, ring, sphere, bubble, cone, cup, cylinder, tube.
struct RadShape {
    Facets facets;
    bool inwards = false;    ///< Their fronts are the inside.
    bool is_closed = false;  ///< Nothing sees their backs.
};

/// Nothing, and an error among the findings, where the numbers make no shape.
std::optional<RadShape> rad_shape(const RadPrimitive& p, const std::string& file, RadFindings& findings);

}  // namespace exitance
