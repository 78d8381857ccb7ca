#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace exitance {

constexpr std::size_t batches = 32;  ///< Number of batches of samples; their spread gives the standard error.
/// One-sided 95% quantile for the mean of batches, given by Student's distribution with 31 degrees of freedom.
constexpr double student_95 = 1.696;

/// Mean of batches of samples, and its standard error from their spread. Sample k belongs to batch k % `batches`.
struct BatchMean {
    double mean = 0, standard_error = 0;

    explicit BatchMean(const std::array<double, batches>& values) {
        for (double v : values) mean += v / batches;
        double spread = 0;
        for (double v : values) spread += (v - mean) * (v - mean) / (batches * (batches - 1.0));
        standard_error = std::sqrt(spread);
    }
};

}  // namespace exitance
