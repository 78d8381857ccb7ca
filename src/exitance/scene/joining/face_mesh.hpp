#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// Lengths and angles below which things count as the same.
struct Tolerances {
    double place = 0;    ///< Metres: points nearer than this are one point.
    double plane = 0;    ///< Metres: how far a face's corners may stand off its plane.
    double tilt = 1e-3;  ///< Radians: how far normals of faces that are meant to be coplanar may differ.
};

/// Tolerances of a scene whose points lie in `box`. Places: 1e-9 of the scene's size, which exceeds the rounding of
/// decimal files; less where edges are short beside that (a chair on a plain of a thousand kilometres), but never below
/// the spacing of doubles at the coordinates. Planes: 1e-5 of the size, within which scene-file conventions count a
/// point as lying on a face.
/// short_edge  a length that few edges are shorter than, metres
Tolerances tolerances(const Box& box, double short_edge);

/// Checked faces as the joining of regions sees them: corners are numbers of welded points.
struct FaceMesh {
    std::span<const Point> points;
    std::vector<std::uint32_t> first;  ///< First corner of every face, then the number of all corners.
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> material;
    std::vector<Vec3> area_vector;  ///< m^2, along the face's normal.

    std::size_t size() const { return material.size(); }
    std::span<const std::uint32_t> outline(std::uint32_t face) const {
        return std::span(corners).subspan(first[face], first[face + 1] - first[face]);
    }
};

}  // namespace exitance
