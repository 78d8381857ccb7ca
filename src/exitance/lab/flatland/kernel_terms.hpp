#pragma once

#include <functional>
#include <span>
#include <vector>

#include "exitance/lab/flatland/line_basis.hpp"

namespace exitance::flatland {

/// How products of one-dimensional functions are combined: every level of x with every level of y, or only equal
/// levels. Source: [Gortler93], [Willmott97].
enum class Decomposition { standard, non_standard };

/// A function of (x, y) on the unit square as coefficients of a product basis.
class KernelTerms {
  public:
    /// Projects k by Gauss rules on at least 2^levels functions per direction (a power of two of intervals, with as
    /// many functions each as the basis has), and decomposes it. O(4^levels).
    KernelTerms(LineBasis basis, Decomposition way, int levels, const std::function<double(double, double)>& k);

    std::size_t size() const { return side_ * side_; }  ///< Number of terms.

    /// Returns the relative RMS error if only the m terms with the largest contributions are kept (|c| times the norm
    /// of the term), for every m of the list; m above size() counts as size(). Exact: by reconstruction in the finest
    /// space.
    std::vector<double> errors(std::span<const std::size_t> m) const;

  private:
    void step_rows(std::vector<double>& a, std::size_t intervals, std::size_t rows, bool back) const;
    void step_columns(std::vector<double>& a, std::size_t intervals, std::size_t columns, bool back) const;
    std::vector<double> decompose(std::vector<double> a) const;
    std::vector<double> reconstruct(std::vector<double> a) const;
    double norm_of_function(std::size_t n, std::size_t which) const;
    void measure_norms();
    double norm_of_term(std::size_t row, std::size_t column) const;

    TwoScaleStep step_;
    Decomposition way_;
    std::size_t intervals_, side_;  ///< Number of intervals, and k times that number.
    std::vector<double> finest_, terms_;
    /// Norms of the basis functions, by position among the coefficients of a line: as a detail, and as a coarse
    /// function.
    std::vector<double> detail_norm_, coarse_norm_;
};

}  // namespace exitance::flatland
