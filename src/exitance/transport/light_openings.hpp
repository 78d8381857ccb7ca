#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "exitance/transport/ray_rows.hpp"

namespace exitance {

using LeafNumbers = std::vector<std::uint32_t>;

/// Coarse elements, and which of them light joins.
struct Flow {
    const RayRows& rows;
    std::vector<double> area;
    std::vector<double> start;        ///< What differs from room to room as a rule.
    std::vector<std::uint16_t> part;  ///< Of the scene that a leaf is in, so far.
    bool has_sky = false;             ///< What meets nothing is joined by the sky, as if that were a wall.
};

/// Leaves of a part on both sides of an opening.
struct OpeningBetween {
    LeafNumbers small, large;  ///< By area.
};

/// Finds the opening behind which most of a part lies: light that differs from place to place goes to and fro within
/// the part, what is left of it orders the leaves, and a cut of that order is an opening where what crosses it is less
/// than a tenth of the smaller side, and less than what crosses the cuts beside it. None where there is no such cut.
/// O(steps x rays).
std::optional<OpeningBetween> find_opening(const Flow& flow, const LeafNumbers& leaves, std::uint16_t part);

}  // namespace exitance
