#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/lab/thesis/csv_text.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

inline constexpr const char* sample_distribution_header = "scene,units,resampled,visible,x,y,z,from_x,from_y,from_z";

/// Where the network of growing cells that learns the emitters' light (G V M, as published) draws its samples while it
/// grows: at each number of units, in ascending order, the last `samples` rays, as the place where they end and the one
/// on an emitter where they begin, metres; `resampled` are those drawn near units of much resource, the rest is
/// uniform.
void write_sample_distribution(const std::string& name, const Scene& scene, const std::vector<std::size_t>& units,
                               std::size_t samples, std::uint64_t seed, CsvText& out, const StopRequest& stop);

}  // namespace exitance
