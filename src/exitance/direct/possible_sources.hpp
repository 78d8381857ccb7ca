#pragma once

#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/direct/direct_light.hpp"

namespace exitance {

/// Which emitters may send light to which regions, and how much at most, before anything is looked at exactly. In
/// buildings nearly all emitters are behind walls: they are found for whole groups of regions at once, halves of halves
/// by place, where one region of the scene, openings left out, hides all of the group's box from all of a source. Of
/// what remains of a source on a region,
///
///     E <= M A / (pi d^2) min(1, a/d) min(1, b/d),
///
/// d the least distance of the two, a how far the source rises over the region's plane, b the region over the source's.
/// Sources that are left out send nothing, but for those that together bring less than `negligible` by these bounds.
///
/// O((groups + large regions) x sources that may be seen), some microseconds each.
class PossibleSources {
  public:
    struct Source {
        DirectLight::SourceName name;
        double bound = 0;  ///< Of E, mean of the bands, W/m^2.
    };

    /// `negligible`: W/m^2 on any region. What is not looked at once `stop` is requested keeps all sources of its
    /// group.
    PossibleSources(const DirectLight& direct, double negligible, const StopRequest& stop);

    /// The weakest first.
    std::span<const Source> of(RegionId r) const { return of_region_[r]; }

    /// Are there diffuse emitters alone, and no panes? Others have no such bounds.
    static bool suits(const DirectLight& direct);

  private:
    class Divider;

    Field<RegionId, std::vector<Source>> of_region_;
};

}  // namespace exitance
