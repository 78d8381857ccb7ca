#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace exitance::flatland {

/// How the outputs of growing cells come about.
enum class CellWeights { delta_rule, least_squares, normalised_least_squares };

struct GrowingLinesOptions {
    CellWeights weights = CellWeights::least_squares;
    std::size_t samples_a_unit = 300;  ///< Drawn between two insertions, uniformly; nothing is taken away.
    std::uint64_t seed = 1;
};

/// A function of x along a line in the plane (k = 1, n = 2: samples are the points (x, 0)), learned by growing cells of
/// so many units, in ascending order: relative L2 errors. The method of docs/growing_cells.md in two dimensions.
std::vector<double> errors_of_growing_line(const std::function<double(double)>& f, std::span<const std::size_t> units,
                                           const GrowingLinesOptions& options);

/// A kernel between two parallel lines, h apart, likewise (k = 2, n = 4: samples are pairs of points (x, 0), (y, h)).
std::vector<double> errors_of_growing_kernel(const std::function<double(double, double)>& kernel, double h,
                                             std::span<const std::size_t> units, const GrowingLinesOptions& options);

}  // namespace exitance::flatland
