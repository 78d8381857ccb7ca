#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace exitance {

/// One sample of a linear fit: its row of the matrix, unknowns and their weights.
using FitRow = std::vector<std::pair<std::uint32_t, double>>;

/// Least squares with a ridge: minimises sum_s w_s |sum_c A_sc v_c - b_s|^2 + ridge mean(diag) |v - v_0|^2 for
/// `outputs` right-hand sides at once, by conjugate gradients on the normal equations, from v_0 = `values` on, which
/// are replaced. The ridge draws towards what is there, so that what no sample speaks of stays. `row(s, out)` fills a
/// row, `target(s, k)` and `weight(s)` give its right-hand sides and weight; called from many threads. O(samples row^2
/// + unknowns^2 steps), 8 unknowns^2 bytes.
struct FitProblem {
    std::size_t samples = 0, unknowns = 0, outputs = 1;
    std::function<void(std::size_t, FitRow&)> row;
    std::function<double(std::size_t, std::size_t)> target;
    std::function<double(std::size_t)> weight;
    double ridge = 1e-6;
    std::size_t steps = 300;
};
void fit_least_squares(const FitProblem& problem, std::vector<double>& values);

/// Solves A x = b, A symmetric and positive, n x n by rows, by conjugate gradients with its diagonal, from x on, to a
/// residual of 1e-9 of b's or `steps`. Parallel over rows; the same bits on any number of threads.
void solve_positive(const std::vector<double>& A, const std::vector<double>& b, std::vector<double>& x,
                    std::size_t steps);

}  // namespace exitance
