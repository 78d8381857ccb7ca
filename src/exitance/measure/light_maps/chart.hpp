#pragma once

#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Position of one region in the light maps: a rectangle of texels on a lattice in the region's plane. Regions of one
/// plane share their lattice, so that texels continue across a common border.
struct Chart {
    /// A rectangle of a map, in texels; rows are counted downwards.
    struct Rectangle {
        int x = 0, y = 0, width = 0, height = 0;
    };

    RegionId region;
    Point origin;               ///< Centre of texel (0, 0), in the region's plane, metres.
    Vec3 du, dv;                ///< Vectors from a texel to its right and lower neighbours, metres.
    double skew = 0;            ///< du . dv, m^2; 0 if texels are rectangles.
    int width = 0, height = 0;  ///< Number of texels that the region's bounding box touches.
    std::uint32_t map = 0;      ///< Index of the map that contains the chart.
    int x = 0, y = 0;           ///< Position of texel (0, 0) in that map.
    Rectangle room;             ///< Rectangle of the chart including its padding; no other chart has texels in it.

    /// The point at a position in texels, counted from the corner of texel (0, 0), whose centre is (0.5, 0.5).
    Point at(Vec2 place) const { return origin + (place.x - 0.5) * du + (place.y - 0.5) * dv; }
    /// Position of a point in texels; the inverse of at().
    Vec2 place(const Point& p) const {
        const Vec3 d = p - origin;
        const double x = dot(d, du), y = dot(d, dv), xx = squared_norm(du), yy = squared_norm(dv);
        if (skew == 0) return {x / xx + 0.5, y / yy + 0.5};
        const double area = xx * yy - skew * skew;
        return {(x * yy - y * skew) / area + 0.5, (y * xx - x * skew) / area + 0.5};
    }
};

/// Makes one chart per region, in the order of their ids, without positions in maps. Rows are along the longest edge of
/// each plane.
/// density  texels per metre, above 0
/// Returns an error of code `usage` if a region is longer than `most` texels. O(corners).
Result<std::vector<Chart>> make_charts(const Scene& scene, double density, int most);

struct MapSize {
    int width = 0, height = 0;
    std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Packs charts into few maps: in descending order of height, each as high up as it fits. A skyline algorithm, see
/// [Jylanki10]. Every chart has a margin of at least `padding` texels, and its rectangle starts and ends at multiples
/// of the largest power of two 2^m up to `padding`. Bilinear lookups on the region then read no texel of another chart
/// down to the m-th mip level. O(charts x charts side by side).
/// most         texels along a side of a map; no chart with its padding may be longer
/// given_width  texels along the horizontal sides; 0: such that a map is approximately square
/// Returns the sizes of the maps, multiples of 2^m.
std::vector<MapSize> pack_charts(std::vector<Chart>& charts, int padding, int most, int given_width = 0);

}  // namespace exitance
