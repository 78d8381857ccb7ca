#pragma once

#include <utility>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Colours that panes of clear glass give to rays. A ray passes a pane, or is mirrored by it, at random, in proportion
/// to the mean over the bands (`RayFates`). Its bands are right in the mean if they are multiplied by T / mean(T) for
/// each pane that it has passed, T the transmission, and likewise for the pane that has mirrored it. O(log panes).
class GlassColours {
  public:
    explicit GlassColours(const Scene& scene);

    /// True if all panes are grey: all factors are then 1.
    bool empty() const { return panes_.empty(); }
    /// Factors for a ray from x to y that no pane has stopped.
    Spectrum between(const Point& x, const Point& y) const { return between(x, y, no_pane); }
    /// Factors for a ray that ends at a hit, or leaves the scene.
    Spectrum of(const RayHit& hit, const Point& origin, const Vec3& direction) const;

  private:
    static constexpr std::int32_t no_pane = -1;
    Spectrum between(const Point& x, const Point& y, std::int32_t ignored) const;

    const Scene* scene_;
    std::vector<std::int32_t> panes_;  ///< Indices of the panes whose transmission differs between bands.
    Bvh tree_;                         ///< Over these panes.
};

}  // namespace exitance
