#pragma once

#include <vector>

#include "exitance/measure/light_maps/light_map.hpp"
#include "exitance/measure/light_maps/uv_light_map.hpp"
#include "exitance/measure/light_maps/uv_set.hpp"

namespace exitance {

struct UnwrapOptions {
    MapSize size = {};   ///< Texels of the map; 0: a square whose side is a power of two, chosen by `density`.
    double density = 0;  ///< Texels per metre, at least; 0: `automatic_density`.
    int padding = 4;     ///< Texels around every chart, at least 1.
    int most = 8192;     ///< Limit on texels along a side.
};

/// Texture coordinates for a light map that were made for a scene.
struct Unwrapped {
    MapSize size;
    double density = 0;         ///< Texels per metre in the planes of the charts.
    int padding = 0;            ///< Texels.
    std::size_t charts = 0;     ///< Number of charts.
    double filled = 0;          ///< Share of the map that faces cover, without padding.
    double smallest_scale = 1;  ///< Least ratio of a face's area in the map to that of a face parallel to it.
    /// The linear map of every region, in the order of ids. The first region of a chart has the chart's rectangle
    /// (`room`); the rectangles of its other regions are empty.
    std::vector<Chart> regions;

    /// Projection of a chart to the map, texels.
    struct Projection {
        Vec3 right, down;  ///< Directions of increasing column and row; their lengths are texels per metre.
        Vec2 origin;       ///< Position of the point (0, 0, 0).
    };
    std::vector<Projection> projections;  ///< Projection of each chart.
    std::vector<std::uint32_t> chart_of;  ///< The chart of every region.

    /// Coordinates of a point of a region: (0, 0) is the upper left of the map, (1, 1) the lower right. All regions of
    /// a chart have the same bits at a common corner.
    Vec2 place(RegionId region, const Point& p) const {
        const Projection& to = projections[chart_of[region.value]];
        return {(to.origin.x + dot(to.right, p)) / size.width, (to.origin.y + dot(to.down, p)) / size.height};
    }
};

/// Makes texture coordinates in one map for a scene: charts of connected faces (find_face_charts), projected along
/// their axes, at the highest density at which all fit into the map with their padding (pack_charts). No charts
/// overlap, none is mirrored, and every face has one. Independent of threads. O(n log n), plus a dozen packings.
/// Returns an error of code `usage` if the charts do not fit into the map.
Result<Unwrapped> unwrap(const Scene& scene, const UnwrapOptions& options);

/// Returns these coordinates as a set for bake_uv_light_maps.
UvSet uv_set_of(const Scene& scene, const Unwrapped& unwrapped);

/// Returns the baked maps with one chart per region, as bake_light_maps returns them.
LightMaps as_region_charts(const Unwrapped& unwrapped, const UvLightMaps& light);

}  // namespace exitance
