#pragma once

#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Tests whether a region of any shape, holes included, blocks all segments between two convex sets. It does if all
/// segments between their corners cross its plane and the convex hull of the crossings does not touch its border: for a
/// fixed end, the segments that meet a convex set have their other ends in a convex set. Can be reused without new
/// allocations.
class RegionCover {
  public:
    /// Begins with another region. `margin`: distance by which its border may reach into the hull, metres.
    void begin(const Region& region, double margin);
    /// Adds the segment between two corners. Returns false if it does not cross the plane from the same side as the
    /// first one.
    bool add(const Point& x, const Point& y);
    /// Returns whether all segments between the hulls of the end points are blocked. Call after adding all segments.
    bool covers();

  private:
    Vec2 flat(const Point& p) const { return {dot(frame_.u, p - origin_), dot(frame_.v, p - origin_)}; }

    const Region* region_ = nullptr;
    Frame frame_{Normal{0, 0, 1}};
    Point origin_;
    double margin_ = 0, side_ = 0;
    std::vector<Vec2> crossings_, hull_;
};

}  // namespace exitance
