#pragma once

#include <functional>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/lab/growing_cells/cell_light.hpp"
#include "exitance/lab/growing_cells/surface_pool.hpp"

namespace exitance {

/// The surfaces as learned by a network of dimension two, without light.
struct ShadingNetwork {
    std::vector<CellLight::Cell> cells;  ///< At the mean position and normal of the points that each cell has won.
    std::vector<double> area;            ///< Per cell: area of the surface points nearest to it, m^2.
    std::vector<std::uint32_t> cell_of;  ///< Per point of the pool: its cell.
    /// Per cell, in ascending order: the regions that it lies in and whose normal it shares. They never light it.
    std::vector<std::vector<RegionId>> own_regions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Grows a network of `units` units over points of the pool. `draw(u, v)` returns a point for two numbers in [0, 1).
/// Samples are points of R^6, position and normal, so that units are separated at folds but not at facets of a smooth
/// surface. Units that straddle a fold or win no point are removed in the end. `by_edges`: a cell's width is its mean
/// edge length, as published, and cells between parallel surfaces are moved onto one; otherwise the width is derived
/// from the cell's area. O(units samples log units).
ShadingNetwork grow_shading_network(const SurfacePool& pool, const std::function<std::uint32_t(double, double)>& draw,
                                    std::size_t units, bool by_edges, double scene_size, std::uint64_t seed,
                                    const StopRequest& stop);

}  // namespace exitance
