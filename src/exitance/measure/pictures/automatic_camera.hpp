#pragma once

#include "exitance/measure/pictures/camera.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Chooses a camera that shows a solution well. In a closed room the eye is near a corner or where light is, at eye
/// level. The view is towards the larger part of the room, not at the back of a cupboard or into a dark room: of some
/// hundred views it is the one that shows most, with the most variety of light. In an open scene the eye is outside, on
/// the side that shows most light and fewest backs. The picture then contains the whole scene, or all objects on a
/// ground that is much wider. A panorama is taken from the middle of the room, or the nearest place with enough space
/// and light. Traces some hundred thousand rays.
Camera automatic_camera(const Solution& solution, const RayTracer& tracer, Projection projection, PictureSize size);

}  // namespace exitance
