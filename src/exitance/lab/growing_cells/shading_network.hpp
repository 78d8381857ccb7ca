#pragma once

#include <functional>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/lab/growing_cells/cell_light.hpp"
#include "exitance/lab/growing_cells/surface_pool.hpp"

namespace exitance {

/// The surfaces as a network of dimension two has learned them, without light as yet.
struct ShadingNetwork {
    std::vector<CellLight::Cell> cells;  ///< At the mean place of what each has won, facing as that does.
    std::vector<double> area;            ///< Of the surface that is nearest to a cell, m^2,
    std::vector<std::uint32_t> cell_of;  ///< and by point of the pool, which cell that is.
    /// By cell: the regions that it lies in and faces as, in ascending order. They never light it.
    std::vector<std::vector<RegionId>> own_regions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Grows a network of `units` over places of the pool: `draw(u, v)` gives one by two numbers in [0, 1). Samples are
/// points of R^6, place and normal, so that folds part units and facets do not. Units that straddle a fold, or that
/// nothing is nearest to, are left out in the end. `by_edges`: widths are the mean lengths of edges, as published, else
/// those of the cells' areas. O(units samples log units).
ShadingNetwork grow_shading_network(const SurfacePool& pool, const std::function<std::uint32_t(double, double)>& draw,
                                    std::size_t units, bool by_edges, double scene_size, std::uint64_t seed,
                                    const StopRequest& stop);

}  // namespace exitance
