#pragma once

#include <span>
#include <string>

#include "exitance/io/scenes/obj/obj.hpp"
#include "exitance/io/scenes/scene_file.hpp"

namespace exitance {

/// Reads Radiance scene descriptions (.rad), in metres.
/// Surfaces: polygon, ring, sphere, bubble, cone, cup, cylinder and tube. Reflecting faces get two sides, emitting ones
/// only a front.
/// Materials: the diffuse parts of plastic, metal, trans, light, glow and illum; aliases; `light` with `brightdata` as
/// conversion programs write it.
/// `source`: a disc, or a sky that gensky or gendaylit printed.
/// Commands: `!gensky`, `!gendaylit`, and `!xform` of other files are evaluated here; others need `run_commands`.
/// Files of one scene share their names, in the given order. The findings list omitted parts. O(size of the files, with
/// copies).
ReadScene read_radiance(std::span<const std::string> paths, const LoadOptions& options);
ReadScene read_radiance(const std::string& path);

}  // namespace exitance
