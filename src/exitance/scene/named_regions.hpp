#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Marks with 1 all regions that have a face whose material or object has one of the names. O(faces + names).
Field<RegionId, std::uint8_t> regions_named(const Scene& scene, std::span<const std::string> names);

/// Error (usage), about `option`: some of the names belong to neither a material nor an object of a face.
Result<void> check_face_names(const Scene& scene, std::span<const std::string> names, const std::string& option);

}  // namespace exitance
