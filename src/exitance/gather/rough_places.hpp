#pragma once

#include "exitance/transport/stage.hpp"

namespace exitance {

/// A place at which the delivered light was measured to be far from the light gathered there: so far that this one
/// point has a notable share of all of the error. Light varies there over a distance that the elements miss, as at the
/// mouth of a narrow gap.
struct RoughPlace {
    RegionId region;
    Point at;

    template <class Archive>
    friend void archive(Archive& a, RoughPlace& place) {
        a(place.region, place.at);
    }
};

}  // namespace exitance
