#pragma once

#include <algorithm>

namespace exitance {

/// Sum of the variances of a row's entries after its closure defect is distributed over them, in proportion to their
/// variances v, and over the shares of the sky and of backs:
///
///     sum_j (v_j - v_j^2 / S),   S = sum_j v_j + variances of sky and back.
///
/// The closure of the other rows reduces it further.
class ClosedVariance {
  public:
    /// Adds an entry.
    void add(double variance) { sum_ += variance, squares_ += variance * variance; }
    /// Adds many entries by the sums of their variances and of the squares of these.
    void add(double sum, double squares) { sum_ += sum, squares_ += squares; }

    /// Sum before the defect is distributed.
    double open() const { return sum_; }
    /// `missed`: variance of the shares of sky and backs.
    double closed(double missed) const {
        const double all = sum_ + missed;
        return all > 0 ? std::max(0.0, sum_ - squares_ / all) : 0;
    }

  private:
    double sum_ = 0, squares_ = 0;
};

}  // namespace exitance
