#pragma once

#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Connected regions that are shown together in a light map, by parallel projection along an axis.
struct FaceChart {
    std::vector<RegionId> regions;
    Normal axis;  ///< Normal of the chart, at most 40 degrees from the normals of all its regions.
};

/// Divides the regions of a scene into charts. A chart has regions of one object and one material that are connected by
/// edges with equal ends, with less than 40 degrees between neighbours. Its projection neither overlaps itself nor
/// mirrors a face, and shrinks areas by a factor of 0.77 at most. Charts grow from the largest region that is left. If
/// a projection overlaps itself, the half that was reached last is divided again. Independent of threads, and of
/// rotations and scales up to rounding. O(n log n).
std::vector<FaceChart> find_face_charts(const Scene& scene);

/// Two directions of the plane perpendicular to an axis, counter-clockwise about it, along the sides of the rectangle
/// around a chart with the smallest area.
struct ChartFrame {
    Vec3 right, up;
};
ChartFrame smallest_frame(const Scene& scene, const FaceChart& chart);

}  // namespace exitance
