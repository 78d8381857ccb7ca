#pragma once

#include <cstdint>
#include <vector>

#include "exitance/transport/stage.hpp"

namespace exitance {

/// Points spread evenly over all surfaces, ordered so that aligned blocks of 2^j points are close in position and
/// normal. Points drawn near another one are thus on the surfaces again, however these are divided into polygons: a
/// network that learns from the pool depends on their shape only.
class SurfacePool {
  public:
    /// `count` is rounded up to a power of two. Points are systematic in area, scrambled Sobol points within pieces.
    /// Sides of surfaces that no light reaches are omitted. O(count log count + pieces).
    SurfacePool(const Stage& stage, std::size_t count, std::uint64_t seed);

    const std::vector<SurfacePoint>& points() const { return points_; }
    const SurfacePoint& operator[](std::size_t i) const { return points_[i]; }
    std::size_t size() const { return points_.size(); }
    double area() const { return area_; }                                             ///< m^2
    double area_each() const { return area_ / static_cast<double>(points_.size()); }  ///< m^2

    /// Height over a plane up to which a point counts as in it, metres. It allows for rounded coordinates in files and
    /// for rotated scenes. As in `Locator`.
    double in_plane() const { return in_plane_; }

    /// Returns a point of the block around point i whose area is about pi width^2, chosen by a number u in [0, 1).
    std::uint32_t near(std::uint32_t i, double width, double u) const;

  private:
    void sort(std::size_t first, std::size_t count, double normal_scale);

    std::vector<SurfacePoint> points_;
    double area_ = 0, in_plane_ = 0;
};

}  // namespace exitance
