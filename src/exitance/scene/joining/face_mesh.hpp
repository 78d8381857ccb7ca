#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// Lengths and angles below which points, planes and normals count as equal.
struct Tolerances {
    double place = 0;    ///< Points nearer than this are one point, metres.
    double plane = 0;    ///< Maximum distance of a face's corners from its plane, metres.
    double tilt = 1e-3;  ///< Angle between normals of faces that are meant to be coplanar, at most, radians.
};

/// Tolerances of a scene whose points are in `box`. Places: 1e-9 of the scene's size, which exceeds the rounding of
/// decimal files. It is smaller if edges are short compared with the scene (a chair on a plain of a thousand
/// kilometres), but at least the spacing of doubles at the coordinates. Planes: 1e-5 of the size, the distance within
/// which scene-file conventions consider a point to be on a face.
/// short_edge  length that few edges are shorter than, metres
Tolerances tolerances(const Box& box, double short_edge);

/// Checked faces in the form needed for joining: corners are numbers of welded points.
struct FaceMesh {
    std::span<const Point> points;
    std::vector<std::uint32_t> first;  ///< First corner of every face, then the number of all corners.
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> material;
    std::vector<Vec3> area_vector;  ///< Area vector of every face: m^2, along its normal.

    std::size_t size() const { return material.size(); }
    std::span<const std::uint32_t> outline(std::uint32_t face) const {
        return std::span(corners).subspan(first[face], first[face + 1] - first[face]);
    }
};

}  // namespace exitance
