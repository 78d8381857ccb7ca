#pragma once

#include <span>
#include <string>

#include "exitance/io/scenes/obj/obj.hpp"
#include "exitance/io/scenes/scene_file.hpp"

namespace exitance {

/// Reads a Radiance scene description (.rad): polygon, ring, sphere, bubble, cone, cup, cylinder and tube with plastic,
/// metal, trans, light, glow and illum, by their diffuse parts; `source` as a disc, or as a sky where gensky or
/// gendaylit printed it; aliases;
/// `!gensky`, `!gendaylit`, and `!xform` of further files, done here; other commands only where `run_commands` says so.
/// `light` by `brightdata` as conversion programs write it. Files of one scene share their names, in the order given.
/// Metres. What reflects does so from both sides, what emits from its front. What is left out is among the findings.
/// O(size of the files, copies counted).
ReadScene read_radiance(std::span<const std::string> paths, const LoadOptions& options);
ReadScene read_radiance(const std::string& path);

}  // namespace exitance
