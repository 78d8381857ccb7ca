#pragma once

#include <vector>

#include "exitance/direct/direct_light.hpp"
#include "exitance/direct/source_point.hpp"

namespace exitance {

/// A sun: a distant emitter without a sky, and how the scene's middle sees it.
struct DistantDisc {
    DirectLight::SourceName name;
    SeenPolygon seen;
};

/// The suns among the emitters. `direct` must outlive them.
std::vector<DistantDisc> distant_discs(const DirectLight& direct);

/// The domes of the scene whose facets are among the emitters.
DistantLight kept_domes(const DirectLight& direct);

}  // namespace exitance
