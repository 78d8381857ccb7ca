#pragma once

#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Does a region of any shape, holes included, block all segments between two convex sets? It does if the segments
/// between their corners all cross its plane and the convex hull of the crossings misses its border: for a fixed end
/// the segments that meet a convex set have their other ends in a convex set. Reusable, keeps its memory.
class RegionCover {
  public:
    /// `margin`: by how much (metres) the border may reach into the hull.
    void begin(const Region& region, double margin);
    /// Adds the segment between two corners; false if it does not cross the plane from the side of the first one added.
    bool add(const Point& x, const Point& y);
    /// After all were added: are all segments between the hulls of the ends blocked?
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
