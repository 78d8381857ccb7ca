#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace exitance::flatland {

/// How the outputs of growing cells are determined.
enum class CellWeights { delta_rule, least_squares, normalised_least_squares };

struct GrowingLinesOptions {
    CellWeights weights = CellWeights::least_squares;
    std::size_t samples_a_unit = 300;  ///< Samples between two insertions, uniform; units are never removed.
    std::uint64_t seed = 1;
};

/// Learns a kernel between two parallel lines at a distance of h by growing cells (k = 2, n = 4: samples are pairs of
/// points (x, 0), (y, h)). Returns the relative L2 error for each number of units, which must be ascending. This is the
/// method of docs/methods/growing_cells.md in two dimensions.
std::vector<double> errors_of_growing_kernel(const std::function<double(double, double)>& kernel, double h,
                                             std::span<const std::size_t> units, const GrowingLinesOptions& options);

/// State of growing cells that learn a kernel, for pictures.
struct GrownKernel {
    static constexpr std::size_t side = 64;  ///< Places per line.
    double error = 0;                        ///< Relative L2 error.
    std::vector<std::array<double, 2>> centres;
    std::vector<double> widths;
    std::vector<double> values;  ///< Learned kernel at the middles of side x side cells of the unit square, x first.
};

/// Like `errors_of_growing_kernel`, with the units and the learned kernel for each number of units.
std::vector<GrownKernel> grow_kernel(const std::function<double(double, double)>& kernel, double h,
                                     std::span<const std::size_t> units, const GrowingLinesOptions& options);

}  // namespace exitance::flatland
