#pragma once

#include "exitance/basis/nodal_basis.hpp"
#include "exitance/lab/classical/snapshots.hpp"

namespace exitance {

// Defaults of options that several classical forms have.
constexpr unsigned default_hemicube_cells = 64;
/// Default of A_eps, relative to the scene's area: eight cuts into quarters.
constexpr double default_min_share = 1.0 / 65536;

/// Input of a classical form of a method.
struct ClassicalInput {
    const Stage& stage;
    const SolveOptions& options;
    const ClassicalOptions& classical;
    const Knobs& knobs;
    Progress& progress;
    const StopRequest& stop;
    Snapshots& snapshots;

    /// True if the method transports the emitters' light itself (`--direct carried`).
    bool carries() const { return classical.carried(); }
    const Material& material(const ElementTree& tree, ElementId e) const {
        return stage.scene.material(tree.region(e));
    }
};

/// Result: irradiance on the elements (all light if the emitters' light is carried, otherwise indirect light only).
struct ClassicalLight {
    ElementFunction irradiance;
    SolveReport report;
    std::size_t elements = 0, leaf_elements = 0, rays = 0, form_factors = 0, links = 0, initial_links = 0;
    std::size_t link_memory_bytes = 0, coefficient_memory_bytes = 0;
    const char* stopped_by = "";
};

/// Constant elements to solve on: `uniform` ones of `--mesh-size`, or `aligned` ones, those of the direct projection.
ElementTree constant_mesh(const ClassicalInput& input);
/// Mean exact direct light of leaves, W/m^2.
std::vector<Spectrum> mean_direct_light(const ClassicalInput& input, const ElementTree& tree,
                                        std::span<const ElementId> leaves);
/// Exitance of leaves, W/m^2.
std::vector<Spectrum> exitances(const ClassicalInput& input, const ElementTree& tree,
                                std::span<const ElementId> leaves);
/// A function that is constant on every leaf.
ElementFunction constant_function(const ElementTree& tree, std::span<const ElementId> leaves,
                                  std::span<const Spectrum> values);

/// Returns an error if the matrix does not fit into the available memory.
Result<ClassicalLight> solve_classical_matrix(const ClassicalInput& input);
ClassicalLight solve_classical_shooting(const ClassicalInput& input, bool substructuring);
ClassicalLight solve_classical_links(const ClassicalInput& input, HierarchyBasis basis);

}  // namespace exitance
