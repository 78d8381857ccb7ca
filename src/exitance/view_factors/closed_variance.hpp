#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace exitance {

/// Sum of the variances of a row's entries after its closure defect is distributed over them, in proportion to their
/// variances v, and over the shares of the sky and of backs:
///
///     V = sum_j (v_j - v_j^2 / S),   S = sum_j v_j + variances of sky and back.
///
/// The closure of the other rows reduces it further. The entries' errors then have the covariance matrix
/// C = diag(v) - v v' / S.
class ClosedVariance {
  public:
    /// Adds an entry.
    void add(double variance) {
        const double square = variance * variance;
        add(variance, square, square * variance);
    }
    /// Adds many entries by the sums of the first three powers of their variances.
    void add(double sum, double squares, double cubes) { sum_ += sum, squares_ += squares, cubes_ += cubes; }

    /// Sum before the defect is distributed.
    double open() const { return sum_; }
    /// `missed`: variance of the shares of sky and backs.
    double closed(double missed) const {
        const double all = sum_ + missed;
        return all > 0 ? std::max(0.0, sum_ - squares_ / all) : 0;
    }

    /// Limit for the squared error of the row, and for that of a sum over any group of its entries. Each exceeds the
    /// limit as rarely as a normal variable exceeds its mean by `deviations` standard deviations. The squared error has
    /// the mean V and the variance 2 tr(C C), like V / n times a chi-square variable with n = V^2 / tr(C C) degrees of
    /// freedom; its quantile is approximated by Wilson and Hilferty's formula. The squared error of a group of variance
    /// v is below deviations^2 v (1 - v / S). The limit is at least V.
    ///
    /// missed  as for closed(); none: the closure defect is not distributed
    double limit(std::optional<double> missed, double deviations) const {
        const double V = missed ? closed(*missed) : sum_;
        if (V <= 0) return 0;
        double traced = squares_, group = sum_;
        if (missed) {
            const double S = sum_ + *missed, v = std::min(sum_, 0.5 * S);
            traced = std::max(0.0, squares_ - 2 * cubes_ / S + squares_ * squares_ / (S * S));
            group = v * (1 - v / S);
        }
        constexpr double wilson_hilferty = 2.0 / 9;  // derived from the variance 2 / (9 n) of (chi^2 / n)^(1/3)
        const double spread = wilson_hilferty * traced / (V * V);
        const double root = 1 - spread + deviations * std::sqrt(spread);
        return std::max({V, V * root * root * root, deviations * deviations * group});
    }

  private:
    double sum_ = 0, squares_ = 0, cubes_ = 0;
};

}  // namespace exitance
