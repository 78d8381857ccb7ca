#pragma once

#include "exitance/accuracy/accuracy.hpp"
#include "exitance/core/checkpoint.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Input of every method.
struct MethodInput {
    const Stage& stage;
    const SolveOptions& options;
    const Knobs& knobs;
    /// Direct light on elements that follow its shadows. Methods solve on this mesh unless they make their own.
    const DirectProjection& direct;
    Progress& progress;
    const StopRequest& stop;
    /// Checkpoints at which a method of several rounds may save its state.
    SafePoints safe_points = {};
    /// True if an earlier attempt has a result: after a stop, this one may return unfinished, since its result is not
    /// used.
    bool may_give_up = false;
};

/// Finds the reflected light of every element of a mesh. Each method is in a file of its own.
using SolveMethod = GlobalLight (*)(const MethodInput&);

/// Row of the table of methods.
struct MethodEntry {
    Method id;
    SolveMethod solve;
    const char* basis;  ///< Default basis of its elements.
};

/// Mean direct light of every leaf of the projection's mesh, by leaf number, W/m^2.
std::vector<Spectrum> leaf_means(const DirectProjection& direct, const LeafNumbering& numbering);

/// The table of methods.
std::span<const MethodEntry> method_table();
const MethodEntry& entry_of(Method id);

GlobalLight solve_matrix(const MethodInput& input);
GlobalLight solve_progressive(const MethodInput& input);
GlobalLight solve_substructuring(const MethodInput& input);
GlobalLight solve_monte_carlo(const MethodInput& input);
GlobalLight solve_hierarchical(const MethodInput& input);
GlobalLight solve_wavelet(const MethodInput& input);
GlobalLight solve_growing_cells(const MethodInput& input);

}  // namespace exitance
