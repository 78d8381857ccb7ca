#pragma once

#include "exitance/reconstruct/pictures/camera.hpp"
#include "exitance/reconstruct/solution.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// A camera that shows a solution well. In a closed room it stands near a corner, at a height of eyes, looks at the
/// larger part, and not at the back of a cupboard: of some dozen places and heights the one from which most is seen,
/// with the most variety of light. Of an open scene it stands outside, on the side that shows most fronts, with the
/// whole scene in the picture. A panorama is taken from the middle of the room, or as near to it as there is room to
/// look around. Traces some ten thousand rays.
Camera automatic_camera(const Solution& solution, const RayTracer& tracer, Projection projection, PictureSize size);

}  // namespace exitance
