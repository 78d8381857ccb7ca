#pragma once

#include <array>
#include <cmath>
#include <map>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Gives one position to the corners of faces that are at the same place. Corners of neighbours may differ by rounding,
/// since each face is flattened when it is read.
class CommonCorners {
  public:
    /// Collects the corners of all faces. O(n log n).
    explicit CommonCorners(const Scene& scene) : cell_(cell_share * scene.size()) {
        for (const SurfaceId s : scene.surfaces().ids())
            for (const Point& p : scene.outline(s)) first_.emplace(key(p), p);
    }

    /// Returns the first corner of the scene at a corner's place. O(log n).
    const Point& at(const Point& corner) const { return first_.at(key(corner)); }

  private:
    using Key = std::array<std::int64_t, 3>;
    /// Side of the cells within which corners are equal, as a share of the scene's size. Derived from the rounding of
    /// single precision. It is no round number, since round coordinates would be at borders of its cells.
    static constexpr double cell_share = 0.7071e-6;

    Key key(const Point& p) const {
        return {std::llround(p.x / cell_), std::llround(p.y / cell_), std::llround(p.z / cell_)};
    }

    double cell_;
    std::map<Key, Point> first_;
};

}  // namespace exitance
