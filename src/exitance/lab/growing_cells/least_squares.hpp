#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace exitance {

/// Row of one sample in a linear fit: unknowns and their coefficients.
using FitRow = std::vector<std::pair<std::uint32_t, double>>;

/// Least-squares problem with a ridge: minimizes
///
///     sum_s w_s |sum_c A_sc v_c - b_s|^2 + ridge mean(diag) |v - v_0|^2
///
/// for `outputs` right-hand sides, by conjugate gradients on the normal equations. The ridge keeps unknowns that no
/// sample affects at their initial value v_0. `row(s, out)` fills the row of sample s; `target(s, k)` and `weight(s)`
/// return its right-hand sides and weight. They are called by many threads. `fit_least_squares` starts from `values`
/// (v_0) and replaces them. O(samples row^2 + unknowns^2 steps), 8 unknowns^2 bytes.
struct FitProblem {
    std::size_t samples = 0, unknowns = 0, outputs = 1;
    std::function<void(std::size_t, FitRow&)> row;
    std::function<double(std::size_t, std::size_t)> target;
    std::function<double(std::size_t)> weight;
    double ridge = 1e-6;
    std::size_t steps = 300;
};
void fit_least_squares(const FitProblem& problem, std::vector<double>& values);

/// Solves A x = b for a symmetric positive definite n x n matrix A (by rows). Uses conjugate gradients with a diagonal
/// preconditioner, starting from x, until the residual is at most 1e-9 of that of b or for `steps` iterations. Parallel
/// over rows; bitwise equal for any number of threads.
void solve_positive(const std::vector<double>& A, const std::vector<double>& b, std::vector<double>& x,
                    std::size_t steps);

}  // namespace exitance
