#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "exitance/transport/ray_rows.hpp"

namespace exitance {

using LeafNumbers = std::vector<std::uint32_t>;

/// Coarse elements and the light that they exchange, by leaf number.
struct Flow {
    const RayRows& rows;
    std::vector<double> area;   ///< Area of each leaf, m^2.
    std::vector<double> start;  ///< Starting values of find_opening()'s iteration: a guess that differs between rooms.
    std::vector<std::uint16_t> part;    ///< The part of the scene that each leaf belongs to so far.
    std::vector<std::uint32_t> to_sky;  ///< Rays of each leaf that reach the sky, which connects leaves like a wall.
    std::vector<std::uint32_t> lost;    ///< Without a sky: rays of each leaf that hit no front; 0 if none does.
};

/// Share of a leaf's rays that reach the sky.
double share_to_sky(const Flow& flow, std::uint32_t leaf);

/// Leaves of a part on the two sides of an opening.
struct OpeningBetween {
    LeafNumbers small, large;  ///< The sides with the smaller and the larger area.
};

/// Finds the opening that divides a part into the two most equal sides. Light with an uneven distribution is reflected
/// within the part; the differences that decay slowest order the leaves. Each cut of that order has an opening: the
/// area through which light crosses the cut. It is accepted if it is less than a tenth of the smaller side's area and
/// less than half the opening of the cuts nearby. Returns nullopt if there is no such cut. O(steps x rays).
std::optional<OpeningBetween> find_opening(const Flow& flow, const LeafNumbers& leaves, std::uint16_t part);

}  // namespace exitance
