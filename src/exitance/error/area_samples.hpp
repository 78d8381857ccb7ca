#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// Returns `count` points (metres, with the normals of their faces) that are uniform in area over a scene's surfaces.
/// Stratified: each of `count` equal shares of the area has one point. Deterministic for a given `seed`. O(pieces +
/// count).
std::vector<ProbePoint> points_uniform_in_area(const Scene& scene, std::size_t count, std::uint64_t seed);

}  // namespace exitance
