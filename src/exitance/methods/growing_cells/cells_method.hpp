#pragma once

#include "exitance/methods/growing_cells/kernel_network.hpp"
#include "exitance/methods/growing_cells/shading_network.hpp"
#include "exitance/methods/methods.hpp"

namespace exitance {

/// What the networks of a solve found.
struct LearnedLight {
    CellLight light;  ///< All irradiance (classic), or the indirect one (improved).
    SolveReport report;
    std::size_t rays = 0, kernels = 0;  ///< Rays traced; values of the analytic kernel.
    std::size_t memory_bytes = 0;       ///< Of both networks and what is between them.
};

/// Units of each network: as asked for, or as many as the error asked for has elements on so much surface.
std::size_t units_of(const Stage& stage, const Knobs& knobs, const SolveOptions& options);

/// What learning visibility and reflecting by it will take.
struct CellsForecast {
    double rays = 0, bytes = 0;
};
/// facing   share of pairs of points that face each other      blocked  is anything between any of them?
CellsForecast forecast_cells(std::size_t units, double facing, bool blocked);

/// All light through the networks, as published.
LearnedLight learn_flow(const MethodInput& input, const SurfacePool& pool);

/// Direct light apart, visibility learned, kernels analytic, irradiance by linear maps.
LearnedLight learn_visibility(const MethodInput& input, const SurfacePool& pool);

/// The kernel network as it is stored.
void keep_network(const KernelNetwork& network, CellLight& light);

}  // namespace exitance
