#pragma once

#include "exitance/lab/growing_cells/kernel_network.hpp"
#include "exitance/lab/growing_cells/shading_network.hpp"
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

/// Cost of learning visibility and of reflecting by it, as MethodEntry::forecast.
MethodForecast forecast_cells(const Stage& stage, const SolveOptions& options, const Knobs& knobs, double facing,
                              bool blocked);

/// GlobalLight by growing cells: a row of the table of methods.
GlobalLight solve_growing_cells(const MethodInput& input);

/// All light through the networks, as published.
LearnedLight learn_flow(const MethodInput& input, const SurfacePool& pool);

/// Direct light apart, visibility learned, kernels analytic, irradiance by linear maps.
LearnedLight learn_visibility(const MethodInput& input, const SurfacePool& pool);

/// The kernel network as it is stored.
void keep_network(const KernelNetwork& network, CellLight& light);

}  // namespace exitance
