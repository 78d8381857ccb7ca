#pragma once

#include <cstdint>
#include <vector>

#include "exitance/transport/stage.hpp"

namespace exitance {

/// A place of the pool that samples of growing cells are drawn from.
struct PoolPoint {
    Point at;
    Normal n;
    RegionId region;
};

/// Points spread evenly over all surfaces, in an order in which aligned blocks of 2^j points lie together, in place and
/// in the way they face. What is drawn near a point lies on the surfaces, then, whatever they are made of: a network
/// that learns from the pool sees their shape and not how they were cut into polygons.
class SurfacePool {
  public:
    /// `count` is rounded up to a power of two. Systematic in area, scrambled Sobol points within pieces. Sides that no
    /// light reaches are left out. O(count log count + pieces).
    SurfacePool(const Stage& stage, std::size_t count, std::uint64_t seed);

    const std::vector<PoolPoint>& points() const { return points_; }
    const PoolPoint& operator[](std::size_t i) const { return points_[i]; }
    std::size_t size() const { return points_.size(); }
    double area() const { return area_; }                                             ///< m^2
    double area_each() const { return area_ / static_cast<double>(points_.size()); }  ///< m^2

    /// Height over a plane up to which a point lies in it, metres: coordinates in files are rounded, and those of
    /// turned scenes are no exact multiples of anything. As `Locator` has it.
    double in_plane() const { return in_plane_; }

    /// A point of the block around point i whose area is about pi width^2, by a number in [0, 1).
    std::uint32_t near(std::uint32_t i, double width, double u) const;

  private:
    void sort(std::size_t first, std::size_t count, double normal_scale);

    std::vector<PoolPoint> points_;
    double area_ = 0, in_plane_ = 0;
};

}  // namespace exitance
