#pragma once

#include "exitance/base/check.hpp"
#include "exitance/scene/add_polygon.hpp"

namespace exitance {

/// Returns the scene of a description, after repairs; aborts the test if it has errors.
inline Scene checked_scene(SceneDescription d) {
    CheckedScene checked = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

}  // namespace exitance
