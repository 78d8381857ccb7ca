#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "exitance/measure/light_maps/uv_set.hpp"

namespace exitance {

/// An object's charts in its light map, and their faults. Faces are counted as triangles.
struct UvObject {
    std::string name;
    std::uint32_t map = 0;  ///< Index of its map.
    std::size_t triangles = 0;
    std::size_t charts = 0;       ///< Number of connected parts in the map.
    std::size_t mirrored = 0;     ///< Triangles that are mirrored in the map.
    std::size_t overlapping = 0;  ///< Triangles that overlap others of this object in the map.
    std::size_t outside = 0;      ///< Triangles that are partly or wholly outside the map and get no texels there.
    /// Number of charts that lie outside the unit square and are moved into it by whole numbers, as texture repetition
    /// does.
    std::size_t moved_charts = 0;
    std::size_t collapsed = 0;     ///< Triangles without area in the map, which get no texels.
    bool overlaps_others = false;  ///< True if it overlaps another object, so that each object has a map of its own.
    double area = 0;               ///< m^2
    double map_area = 0;           ///< Area in the map, whose whole area is 1.
};

/// Positions of a set of texture coordinates in one or several light maps.
struct UvLayout {
    static constexpr std::uint32_t no_chart = std::numeric_limits<std::uint32_t>::max();

    std::vector<UvObject> objects;  ///< Results for each object, in the order of UvSet::objects.
    std::size_t maps = 1;
    std::size_t charts = 0;
    std::vector<std::array<Vec2, 3>> places;  ///< Corners of each triangle in its map, (0, 0) to (1, 1).
    std::vector<std::uint32_t> chart;         ///< Chart of each triangle; no_chart: it has no area in the map.
    std::vector<std::uint8_t> is_overlapped;  ///< For each triangle: true if it overlaps another one of its object.
};

/// Finds the charts of each object: its triangles that are connected by vertices with equal positions and texture
/// coordinates. All objects share one map, unless charts of different objects overlap; then each object has its own.
/// Triangles overlap if more is common than a strip along an edge with a width of 1e-6, which allows for coordinates
/// that are rounded to single precision. O(n log n) if few triangles overlap in any small part of the map.
UvLayout lay_out(const UvSet& set);

/// Area that two triangles have in common; each may be mirrored.
double common_area(const std::array<Vec2, 3>& a, const std::array<Vec2, 3>& b);

}  // namespace exitance
