#pragma once

#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Where one region lies in the light maps: a rectangle of texels on a lattice in the region's plane. Regions of one
/// plane share their lattice, so that texels on both sides of a border continue one another.
struct Chart {
    /// A rectangle of a map, in texels; rows run downwards.
    struct Rectangle {
        int x = 0, y = 0, width = 0, height = 0;
    };

    RegionId region;
    Point origin;               ///< Centre of texel (0, 0), in the region's plane, metres.
    Vec3 du, dv;                ///< From a texel to its neighbour on the right and to the one below, metres.
    int width = 0, height = 0;  ///< Texels that the region's box touches.
    std::uint32_t map = 0;      ///< Which map holds it,
    int x = 0, y = 0;           ///< and where in it texel (0, 0) is.
    Rectangle room;             ///< With the padding around it: no other chart has texels there.

    /// The point at a place counted in texels from the corner of texel (0, 0), whose centre is (0.5, 0.5).
    Point at(Vec2 place) const { return origin + (place.x - 0.5) * du + (place.y - 0.5) * dv; }
    /// The place of a point, the inverse of at().
    Vec2 place(const Point& p) const {
        const Vec3 d = p - origin;
        return {dot(d, du) / squared_norm(du) + 0.5, dot(d, dv) / squared_norm(dv) + 0.5};
    }
};

/// A chart a region, in the order of their ids; not yet in maps. Rows run along the longest edge of each plane.
/// density  texels per metre, above 0
/// returns  an error of code `usage` where a region is longer than `most` texels. O(corners).
Result<std::vector<Chart>> make_charts(const Scene& scene, double density, int most);

struct MapSize {
    int width = 0, height = 0;
    std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Packs charts into as few maps as is simple: the tallest first, each as far up as it goes. A skyline algorithm, see
/// [Jylanki10]. Around every chart stay at least `padding` texels of its own, and its room begins and ends at multiples
/// of the largest power of two 2^m up to `padding`: then bilinear lookups on the region read no texel of another chart
/// down to the m-th mip level. O(charts x charts side by side).
/// most     texels along a side of a map; no chart with its padding may be longer
/// returns  the sizes of the maps, multiples of 2^m
std::vector<MapSize> pack_charts(std::vector<Chart>& charts, int padding, int most);

}  // namespace exitance
