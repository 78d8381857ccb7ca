#pragma once

#include <array>
#include <cstdint>

#include "exitance/view_factors/row_scene.hpp"

namespace exitance {

/// Estimates view factors of pairs of faces that are not too near to each other, by the unoccluded factor and shadow
/// rays:
///
///     F_ij = b U_ij + mean of k(x, y) (V(x, y) - b),   k = A_j cos cos / (pi r^2),
///
/// over points x of i and y of j. U is the unoccluded factor (the mean of k), V the visibility, 0 or 1. b is a control
/// variate from a pilot, which removes the variation of k from the mean. One object serves one thread.
class PairSampler {
  public:
    explicit PairSampler(const RowScene& scene) : scene_(scene) {}

    static constexpr std::size_t pilot_rays = 16;
    /// Share of `pilot_rays` pairs of points that are mutually visible.
    double visible_share(std::size_t i, std::size_t j, std::uint64_t seed);

    struct Estimate {
        double F, variance;
    };
    /// `expected`: b; `batches`: at least 4 independent batches of `rays_a_batch` Owen-scrambled Sobol points.
    Estimate operator()(std::size_t i, std::size_t j, double unoccluded, double expected, std::size_t batches,
                        std::size_t rays_a_batch, std::uint64_t seed);

  private:
    static constexpr std::size_t block = 64;  ///< Number of rays traced in one call.
    struct Sums {
        double kernel = 0, visible = 0;  ///< Sums of k and of k V.
        std::size_t seen = 0;
    };
    Sums sample(std::size_t i, std::size_t j, std::size_t rays, std::uint64_t seed);

    const RowScene& scene_;
    std::array<Point, block> xs_, ys_;
    std::array<double, block> kernels_;
    std::array<double, block> coordinates_[4];
    std::array<bool, block> blocked_;
};

}  // namespace exitance
