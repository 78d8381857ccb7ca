#pragma once

#include "exitance/basis/nodal_basis.hpp"
#include "exitance/methods/methods.hpp"

namespace exitance {

// Classical forms: methods as their papers describe them, chosen by ClassicalOptions, with their own set-up, mesh,
// transport and solver. One attempt, without an error estimate. See docs/laboratory/recipes.md.
//
// `--direct carried`: emitters are elements like others, b = M + rho F b, and E = F b is all light.
// `--direct apart`: b = rho (E_dir + F b) with exact E_dir.

// Defaults of options that several classical forms have.
constexpr unsigned default_hemicube_cells = 64;
/// Default of A_eps, relative to the scene's area: eight cuts into quarters.
constexpr double default_min_share = 1.0 / 65536;

/// True if the method transports the emitters' light itself (`--direct carried`).
inline bool carries_light(const MethodInput& input) {
    return input.options.classical.carried();
}
inline const Material& material_of(const MethodInput& input, const ElementTree& tree, ElementId e) {
    return input.stage.scene.material(tree.region(e));
}

/// A result without light yet: all light if the emitters' light is carried, otherwise that of reflections.
GlobalLight published_light(const MethodInput& input);
/// Constant elements to solve on: `uniform` ones of `--mesh-size`, or `aligned` ones, those of the direct projection.
ElementTree constant_mesh(const Stage& stage, const SolveOptions& options, const Knobs& knobs, const StopRequest& stop);
/// Memory of the columns of form factors that shooting keeps, bytes.
constexpr std::size_t column_memory = std::size_t{1} << 29;
/// Rays per row of the matrix if rays find its entries.
RayBudget ray_budget(const SolveOptions& options, const Knobs& knobs);
/// Cells along an edge of a hemicube's top; an even number.
unsigned hemicube_cells(const SolveOptions& options);
/// Memory of a matrix of n leaves, bytes.
double matrix_bytes(const SolveOptions& options, const Knobs& knobs, double n);
/// Mean exact direct light of leaves, W/m^2.
std::vector<Spectrum> mean_direct_light(const MethodInput& input, const ElementTree& tree,
                                        std::span<const ElementId> leaves);
/// Exitance of leaves, W/m^2.
std::vector<Spectrum> exitances(const MethodInput& input, const ElementTree& tree, std::span<const ElementId> leaves);
/// A function that is constant on every leaf.
ElementFunction constant_function(const ElementTree& tree, std::span<const ElementId> leaves,
                                  std::span<const Spectrum> values);

/// Refuses if the matrix does not fit into the available memory.
GlobalLight solve_classical_matrix(const MethodInput& input);
GlobalLight solve_classical_shooting(const MethodInput& input);
GlobalLight solve_classical_substructuring(const MethodInput& input);
GlobalLight solve_classical_hierarchical(const MethodInput& input);
GlobalLight solve_classical_wavelet(const MethodInput& input);

// Forecasts, as `MethodEntry::forecast` describes them.
MethodForecast forecast_classical_matrix(const Stage& stage, const SolveOptions& options, const Knobs& knobs,
                                         double facing, bool blocked);
MethodForecast forecast_classical_shooting(const Stage& stage, const SolveOptions& options, const Knobs& knobs,
                                           double facing, bool blocked);

}  // namespace exitance
