#pragma once

#include <functional>
#include <span>

#include "exitance/lab/tasks/task_worker.hpp"

namespace exitance {

/// Predicts the number of interactions from the thresholds. Source: [Vinod95], equations 6 and 7:
///
///     n_ij = sum_a sum_b f(i, a; j, b),    N = sum_i sum over j visible from i of n_ij
///
/// over the levels a, b of the two quadtrees, at most ceil(log_4(A / A_eps)) each. The limits of the sums are illegible
/// in available copies of the paper. They are interpreted as follows. All 4^(a+b) parts of a pair are alike, with F_ij
/// / 4^b and A_i / 4^a. Since the larger patch is split, a pair passes through one sequence of levels. f is 4^(a+b) at
/// the first level at which the pair is weak enough or cannot be split, else 0. Both directions are counted, each in
/// its own list.
/// pairs   pieces that are visible to each other, in both directions
/// area    of a piece, m^2
/// power   radiosity of a piece in the brightest band, W/m^2 (not used with the form-factor threshold)
double predict_interactions(std::span<const PiecePair> pairs, const std::function<double(std::uint32_t)>& area,
                            const std::function<double(std::uint32_t)>& power, const TaskOptions& options);

}  // namespace exitance
