#pragma once

#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/direct/direct_light.hpp"

namespace exitance {

/// For each region, the emitters that may illuminate it, with upper bounds of their irradiance; computed before any
/// exact visibility. In buildings nearly all emitters are behind walls. They are excluded for whole groups of regions
/// at once (recursive halves by position) if one region without openings hides all of the group's box from all of a
/// source. For the remaining sources the bound on a region is
///
///     E <= M A / (pi d^2) min(1, a/d) min(1, b/d),
///
/// where d is the least distance of the two, a the height of the source over the region's plane, and b that of the
/// region over the source's plane. Excluded sources contribute nothing, except for those that together contribute less
/// than `negligible` by these bounds.
///
/// O((groups + large regions) x sources that may be visible), some microseconds each.
class PossibleSources {
  public:
    struct Source {
        DirectLight::SourceName name;
        double bound = 0;  ///< Upper bound of E, mean of the bands, W/m^2.
    };

    /// `negligible`: total irradiance that may be dropped per region, W/m^2. Once a stop is requested, the remaining
    /// groups keep all of their sources.
    PossibleSources(const DirectLight& direct, double negligible, const StopRequest& stop);

    /// Returns the possible sources of a region, the weakest first.
    std::span<const Source> of(RegionId r) const { return of_region_[r]; }

    /// True if the bounds are valid for the scene: all emitters are diffuse regions, and there are no panes.
    static bool suits(const DirectLight& direct);

  private:
    class Divider;

    Field<RegionId, std::vector<Source>> of_region_;
};

}  // namespace exitance
