#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/visibility/visible_source.hpp"

namespace exitance {

/// What VisibleSource computes, for four points at a time that see the source alike: the same faces of every blocker,
/// the same edges cut by the same planes. Points of one cell between critical lines do.
class VisibleFromFour {
  public:
    VisibleFromFour();
    ~VisibleFromFour();

    /// Sets out[k] to the form factor from x[k] (normal n) to the visible part, and `seen` to how much all of them see.
    /// False, and nothing set, when the four do not see alike. Source and blockers as for VisibleSource, up to 12
    /// corners. About 0.1 us a point.
    bool operator()(std::span<const Point> source, std::span<const ConvexBlocker* const> blockers,
                    const std::array<Point, 4>& x, const Normal& n, std::array<double, 4>& out, Seen& seen);

  private:
    class Work;
    Work* work_;  ///< Vector registers stay out of this header.
    VisibleFromFour(const VisibleFromFour&) = delete;
    VisibleFromFour& operator=(const VisibleFromFour&) = delete;
};

}  // namespace exitance
