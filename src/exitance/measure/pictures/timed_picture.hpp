#pragma once

#include <functional>

#include "exitance/measure/pictures/picture.hpp"

namespace exitance {

/// Irradiance at a point of a region, W/m^2, that a picture shows in place of the solution's. Empty: the solution. Of
/// the samples of a pixel, four are evaluated if these are alike, else all.
using ShownIrradiance = std::function<Spectrum(RegionId, const Point&)>;

/// A picture that is complete, if coarse, whenever it was stopped.
struct TimedPicture {
    Picture picture;
    /// Minimum number of rays of a pixel. 0: pixels share rays, in squares of side `block`, or nothing was finished.
    int samples = 0;
    int block = 0;  ///< Side of the largest square whose pixels share one ray, pixels; 0: nothing is painted.
    bool is_complete = false;  ///< True if the picture has all samples that the options request.
};

/// Like take_picture, but in passes. The first pass casts one ray per square of 128 pixels a side. The next pass is the
/// finest one that the remaining time allows, judging by the time of the previous pass, and so on up to all samples. A
/// stop keeps the finished tiles of a pass; other pixels keep their values from an earlier pass. A complete picture has
/// the same bits as that of take_picture. Without a deadline the passes before the last one have squares of 128 and 8
/// pixels a side, so that a signal leaves a picture.
TimedPicture take_picture_in_time(const RadiosityFunction& light, const PictureOptions& options, Progress& progress,
                                  const StopRequest& stop, const ShownIrradiance& shown = {});

/// Like take_picture, of another irradiance.
Picture take_picture_of(const ShownIrradiance& shown, const RadiosityFunction& light, const PictureOptions& options,
                        Progress& progress, const StopRequest& stop);

}  // namespace exitance
