#pragma once

#include "exitance/lab/growing_cells/kernel_network.hpp"
#include "exitance/lab/growing_cells/shading_network.hpp"
#include "exitance/methods/methods.hpp"

namespace exitance {

/// Result of the networks of a solve.
struct LearnedLight {
    CellLight light;  ///< All irradiance (classic), or indirect irradiance only (improved).
    SolveReport report;
    std::size_t rays = 0, kernels = 0;  ///< Rays traced; evaluations of the analytic kernel.
    std::size_t memory_bytes = 0;       ///< Memory of the matrix between the networks.
};

/// Units of each network: `options.max_units` if given, otherwise as many as the surfaces have elements of the size
/// that suits the requested error.
std::size_t units_of(const Stage& stage, const Knobs& knobs, const SolveOptions& options);

/// Estimates the cost of learning visibility and reflecting light, as MethodEntry::forecast.
MethodForecast forecast_cells(const Stage& stage, const SolveOptions& options, const Knobs& knobs, double facing,
                              bool blocked);

/// GlobalLight by growing cells: a row of the table of methods.
GlobalLight solve_growing_cells(const MethodInput& input);

/// Solves for all light through the networks, as published (classic).
LearnedLight learn_flow(const MethodInput& input, const SurfacePool& pool);

/// Solves for indirect light: direct light is separate, visibility is learned, kernels are analytic, and irradiance is
/// interpolated by linear maps (improved).
LearnedLight learn_visibility(const MethodInput& input, const SurfacePool& pool);

/// Copies the units and edges of the kernel network to `light`.
void keep_network(const KernelNetwork& network, CellLight& light);

}  // namespace exitance
