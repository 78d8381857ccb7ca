#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/lab/thesis/csv_text.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

inline constexpr const char* sample_distribution_header = "scene,units,resampled,visible,x,y,z,from_x,from_y,from_z";

/// Writes the samples of a network of growing cells that learns the emitters' light (G V M, as published) while it
/// grows. At each number of units, in ascending order, these are the last `samples` rays: their end points and their
/// start points on an emitter, metres. `resampled` marks samples drawn near units with a large resource; the rest is
/// uniform.
void write_sample_distribution(const std::string& name, const Scene& scene, const std::vector<std::size_t>& units,
                               std::size_t samples, std::uint64_t seed, CsvText& out, const StopRequest& stop);

}  // namespace exitance
