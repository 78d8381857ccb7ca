#pragma once

#include "exitance/measure/pictures/camera.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// A camera that shows a solution well. In a closed room it stands near a corner or where light is, at a height of
/// eyes, and looks at the larger part, not at the back of a cupboard nor into a dark room: of some hundred views it is
/// the one that shows most, with the most variety of light. Of an open scene it stands outside, on the side that shows
/// most light and fewest backs, with the whole scene in the picture, or with all that stands on a ground that is much
/// wider. A panorama is taken from the middle of the room, or as near to it as there is room to look around and light
/// to see. Traces some hundred thousand rays.
Camera automatic_camera(const Solution& solution, const RayTracer& tracer, Projection projection, PictureSize size);

}  // namespace exitance
