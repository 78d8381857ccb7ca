#pragma once

#include "exitance/what_if/daylight/daylight_sample.hpp"

namespace exitance {

/// Light of the patches of the sky on the elements of a scene: all that sensors need to receive it.
struct DaylightLight {
    /// Numbers of rays and elements with which the light was found; sensors must use the same number of rays.
    DaylightOptions options;
    DaylightBias bias;
    ElementLight elements;  ///< Light on the elements, one column per patch.
    /// Per group of panes: the part of the light that has crossed panes of the group.
    std::vector<ElementLight> through = {};
    double twice = 0;  ///< Light that has crossed such panes at least twice, relative to the mean at the sample.
};

/// Finds the light on the elements, with as many rays and elements as the requested error of every grid needs: first
/// adds rays, until the noise leaves room for the bias, then elements. The errors are estimated at `sample`. Ends after
/// 7 attempts, or after a stop request, when the result must be discarded. error  requested relative RMS error of the
/// daylight factors and of the lux hours of every grid
DaylightLight find_daylight_light(const DaylightSetting& setting, DaylightTransport& transport, DaylightSample& sample,
                                  double error, Progress& progress, const StopRequest& stop);

}  // namespace exitance
