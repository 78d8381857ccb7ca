#pragma once

#include <cstddef>

#include "exitance/base/ids.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Bodies whose errors may exceed the limit for bodies, but were not measured because it would take too many rays.
struct HiddenErrors {
    std::size_t bodies = 0;
    SurfaceId first = {};  ///< First face of the body with the largest possible error.
    double at_most = 0;    ///< Relative error of the body, one standard error above the value that a few points show.
};

}  // namespace exitance
