#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Finds sides of sheets and large regions that no light reaches: the inside of a closed box, the outside of a room,
/// the ground beside a lit house at night. They would make up half or nearly all of the area that errors are relative
/// to, although they have no light.
///
/// A side counts as unlit if up to 256 unbiased paths from 16 places on it (256 if it is no sheet), and the exact
/// direct light at these places, all give zero, no small source lights it (`SmallSources`), and the paths see no place
/// that one lights. Most lit sides are recognized at the first place. Polygons that are not sheets are examined if they
/// have a twentieth of the area. With many small sides fewer paths are traced. Returns 1 for each unlit region; empty
/// if there are none or if a stop was requested. Deterministic on any number of threads. O(sides x paths).
Field<RegionId, std::uint8_t> find_unlit_sides(const Stage& stage, std::uint64_t seed, const StopRequest& stop);

}  // namespace exitance
