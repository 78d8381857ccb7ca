#pragma once

#include "exitance/methods/method_entry.hpp"

namespace exitance {

/// Mean direct light of every leaf of the projection's mesh, by leaf number, W/m^2.
std::vector<Spectrum> leaf_means(const DirectProjection& direct, const LeafNumbering& numbering);

/// The row of a method in the table: one of the engine's, or one that `Extensions` adds; null where neither has it.
const MethodEntry* find_method(Form form, Method id);
/// Returns the row of a method that is in the table.
const MethodEntry& entry_of(Method id, Form form = Form::standard);

/// True if the form that the options select estimates the error of its light.
bool has_estimate(const SolveOptions& options);

GlobalLight solve_matrix(const MethodInput& input);
GlobalLight solve_progressive(const MethodInput& input);
GlobalLight solve_substructuring(const MethodInput& input);
GlobalLight solve_monte_carlo(const MethodInput& input);
GlobalLight solve_hierarchical(const MethodInput& input);
GlobalLight solve_wavelet(const MethodInput& input);

}  // namespace exitance
