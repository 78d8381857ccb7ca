#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Sides of sheets that no light reaches: the inside of a closed box, the outside of a room. Scenes that give every
/// polygon two sides have many, which hold no light, but half of the area that errors are relative to.
///
/// A side counts as unlit when all of up to 256 unbiased paths from 16 places all over it, and the exact direct light
/// at these, bring nothing at all. Sides that are lit are mostly found so by the first place. Sides that are no sheets'
/// are not tried: they are there because somebody made them. Paths are fewer where sides are many and small.
/// returns by region whether it is unlit; empty where none is, or a stop was asked for. The same on any number of
/// threads. O(sides x paths)
Field<RegionId, std::uint8_t> find_unlit_sides(const Stage& stage, std::uint64_t seed, const StopRequest& stop);

}  // namespace exitance
