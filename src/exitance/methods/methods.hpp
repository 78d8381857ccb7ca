#pragma once

#include "exitance/accuracy/accuracy.hpp"
#include "exitance/core/checkpoint.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// What every method is given.
struct MethodInput {
    const Stage& stage;
    const SolveOptions& options;
    const Knobs& knobs;
    /// Direct light on elements that follow its shadows: the mesh that methods solve on, unless they make their own.
    const DirectProjection& direct;
    Progress& progress;
    const StopRequest& stop;
    /// Where a method of several rounds may keep its state between them.
    SafePoints safe_points = {};
    /// Is there light of another attempt? Then a stop may leave this one unfinished: nothing of it is read.
    bool may_give_up = false;
};

/// Finds the reflected light of every element of a mesh that it makes. One file a method.
using SolveMethod = GlobalLight (*)(const MethodInput&);

/// A row of the table of methods.
struct MethodEntry {
    Method id;
    SolveMethod solve;
    const char* basis;  ///< What its elements hold, when nothing else is asked for.
};

/// Mean direct light of every leaf of the projection's mesh, by leaf number, W/m^2.
std::vector<Spectrum> leaf_means(const DirectProjection& direct, const LeafNumbering& numbering);

/// The table: one line a method.
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
