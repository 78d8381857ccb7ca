#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/processes/dealt_unknowns.hpp"

namespace exitance {

using Values = std::vector<Spectrum>;

/// Vector operations of Krylov methods on own unknowns. The order of operations is fixed, so that our methods and
/// PETSc's give the same bits on any number of processes. All functions are collective.
struct KrylovVectors {
    DealtUnknowns dealt;
    std::span<const double> area;  ///< Areas of this process's own unknowns, m^2.

    /// Inner products of x with each y_j: sum_i A_i sum_band x_i y_ji.
    std::vector<double> products(std::span<const Spectrum> x, std::span<const std::span<const Spectrum>> y) const {
        return dealt.sums<double>(y.size(), [&](std::size_t i, std::size_t j) {
            double sum = 0;
            for (std::size_t band = 0; band < bands; ++band) sum += x[i][band] * y[j][i][band];
            return area[i] * sum;
        });
    }
    /// (sum_i A_i |x_i|^2)^(1/2), all bands together.
    double norm(std::span<const Spectrum> x) const {
        return std::sqrt(dealt.sum<double>([&](std::size_t i) { return area[i] * squared(x[i]); }));
    }
    /// y <- y + sum_j a_j x_j, added in order of j.
    void add_combination(std::span<Spectrum> y, std::span<const double> a,
                         std::span<const std::span<const Spectrum>> x) const {
        dealt.for_each_own([&](std::size_t i) {
            for (std::size_t j = 0; j < a.size(); ++j)
                for (std::size_t band = 0; band < bands; ++band) y[i][band] += a[j] * x[j][i][band];
        });
    }
    /// x <- factor x
    void multiply(std::span<Spectrum> x, double factor) const {
        dealt.for_each_own([&](std::size_t i) { x[i] *= factor; });
    }
};

}  // namespace exitance
