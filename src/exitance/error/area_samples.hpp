#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// `count` points that are uniform in area over a scene's surfaces, stratified: one in each of `count` equal shares of
/// the area. Deterministic by `seed`. O(pieces + count). Metres; normals are the faces'.
std::vector<ProbePoint> points_uniform_in_area(const Scene& scene, std::size_t count, std::uint64_t seed);

}  // namespace exitance
