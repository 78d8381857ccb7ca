#pragma once

#include "exitance/measure/pictures/picture.hpp"

namespace exitance {

/// A picture that is whole whenever it was stopped.
struct TimedPicture {
    Picture picture;
    /// Rays of every pixel, at least. 0: pixels share rays, in squares of side `block`, or nothing was finished.
    int samples = 0;
    int block = 0;  ///< Side of the largest square whose pixels share one ray, pixels; 0: nothing is painted.
    bool is_complete = false;  ///< All samples that the options request.
};

/// Like take_picture, but in passes: the first has one ray for a square of 128 pixels a side. The next one is the
/// finest that the time left allows, by the seconds of the pass before it, and so on to all samples. A stop keeps the
/// finished tiles of a pass; other pixels stay as an earlier pass had them. A picture that is complete has the bits of
/// take_picture. Without a deadline the passes before the last have squares of 128 and 8 pixels a side, for signals.
TimedPicture take_picture_in_time(const RadiosityFunction& light, const PictureOptions& options, Progress& progress,
                                  const StopRequest& stop);

}  // namespace exitance
