#pragma once

#include <functional>
#include <span>

#include "exitance/lab/tasks/task_worker.hpp"

namespace exitance {

/// How many interactions the thresholds predict. Source: [Vinod95], equations 6 and 7:
///
///     n_ij = sum_a sum_b f(i, a; j, b),    N = sum_i sum over j visible from i of n_ij
///
/// over the levels a, b of the two quadtrees, at most ceil(log_4(A / A_eps)) of each. The equation's limits are hard to
/// read in the copies that there are. Read here: all 4^(a+b) parts of a pair are alike, F_ij / 4^b and A_i / 4^a; as
/// the larger is cut, a pair passes through one sequence of levels; f is 4^(a+b) at the first of them where the pair is
/// weak enough or cannot be cut, else 0. Both directions are counted, each for its own list.
/// pairs   of pieces that see each other, both directions
/// area    of a piece, m^2;  power  of a piece: its radiosity in the brightest band, W/m^2 (not read by F_eps)
double predict_interactions(std::span<const PiecePair> pairs, const std::function<double(std::uint32_t)>& area,
                            const std::function<double(std::uint32_t)>& power, const TaskOptions& options);

}  // namespace exitance
