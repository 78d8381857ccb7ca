#pragma once

#include "exitance/base/result.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Result of a method in its published form, in addition to GlobalLight: light on the form's own elements, and counts.
struct PublishedLight {
    /// All arriving light, or that of reflections, by `GlobalLight::delivery`; empty if it is `GlobalLight::indirect`.
    ElementFunction irradiance = {};
    SixNodeMesh mesh = {};  ///< This light on a discontinuity mesh; may be empty.
    std::optional<DiscontinuityCounts> counts = {};
    std::size_t elements = 0, leaf_elements = 0;
    std::map<std::string, double> figures = {};  ///< Further results, by JSON key.
    /// Processor time of parts that the form times, seconds; 0: not timed.
    double visibility_seconds = 0, form_factor_seconds = 0;
    std::optional<Error> refusal = {};  ///< Set if the form rejects the scene; there is no light then.
};

}  // namespace exitance
