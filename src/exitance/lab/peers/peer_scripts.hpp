#pragma once

#include <string_view>

namespace exitance {

/// Contents of experiments/peers/blender.py.
extern const std::string_view blender_script;

}  // namespace exitance
