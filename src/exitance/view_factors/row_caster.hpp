#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/view_factors/row_scene.hpp"

namespace exitance {

/// Casts rays of density cos / pi from a face and counts the faces whose fronts they hit first:
///
///     F_ij = h_ij / n,   h_ij hits of the front of j among n rays.
///
/// Rays are in independent batches of Owen-scrambled Sobol points over the face and the directions; the spread of the
/// batches gives the variances. One object serves one thread.
class RowCaster {
  public:
    /// `stop`: ends casting; counts are then incomplete.
    RowCaster(const RowScene& scene, const StopRequest& stop);

    struct Count {
        std::uint32_t column;
        double hits, squares;  ///< Sums over batches: of the hits in a batch, and of the squares of these.
    };

    /// `rays_a_batch`: a power of two, at least 16; `under_others`: true if another face may cover part of the face.
    void cast(std::size_t face, std::size_t batches, std::size_t rays_a_batch, bool under_others, std::uint64_t seed);

    std::span<const Count> counts() const { return counts_; }  ///< Sorted by column.
    const Count& sky() const { return sky_; }    ///< Count of rays that hit nothing; its column is unused.
    const Count& back() const { return back_; }  ///< Rays that hit a back or started below another face.
    std::size_t rays() const { return batches_ * rays_a_batch_; }
    double share(const Count& count) const { return count.hits / static_cast<double>(rays()); }
    /// Variance of share().
    double variance(const Count& count) const;
    double missed_variance() const { return variance(missed_); }  ///< Variance of the share of sky and backs together.

  private:
    void sort_by_direction(std::size_t count);
    void cast_batch(std::size_t face, bool under_others, std::uint64_t seed);
    void trace(std::size_t face, bool under_others);
    void finish_batch();

    static constexpr std::size_t block = 4096;        ///< Number of rays traced in one call.
    static constexpr std::size_t rays_a_packet = 16;  ///< Size of the packets of RayTracer.
    const RowScene& scene_;
    const StopRequest& stop_;
    std::size_t batches_ = 0, rays_a_batch_ = 0;
    std::vector<std::uint32_t> of_batch_;  ///< Hits of every face in the current batch.
    std::vector<double> hits_, squares_;   ///< Sums over batches, for every face.
    std::vector<std::uint32_t> met_in_batch_, met_;
    std::uint32_t sky_in_batch_ = 0, back_in_batch_ = 0;
    Count sky_{}, back_{}, missed_{};
    std::vector<Count> counts_;
    std::vector<double> coordinates_[4];
    /// Indices of the points of a block, in the order in which their rays are traced.
    std::vector<std::uint16_t> order_;
    std::vector<double> sorted_[2];  ///< The coordinates of the directions in that order.
    std::vector<Point> origins_;
    std::vector<Vec3> directions_;
    std::vector<RayHit> found_;
};

}  // namespace exitance
