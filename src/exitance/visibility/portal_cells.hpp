#pragma once

#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// A parallelogram that covers all or part of an opening.
struct PortalCell {
    Point corner;  ///< Its points are corner + s u + t v, s and t in [0, 1).
    Vec3 u, v;     ///< Edges, perpendicular to each other.
    Normal n;      ///< Unit normal of the parallelogram's plane.
    double area = 0;
    double light = 0;  ///< Approximate ratio of the light that comes through it to the light of the place.
};

/// Returns directions that are spread evenly over the sphere, always the same ones for a number of them.
std::vector<Vec3> directions_all_around(unsigned count);

/// Returns the smallest rectangle around some points, among 48 orientations and those near the best of them. It is
/// enlarged by 3% per side, about the margin that 64 random points leave.
/// at, frame  a point and the frame of a plane, in which the points have coordinates
PortalCell rectangle_around(const Point& at, const Frame& frame, std::span<const Vec2> points);

/// Splits an opening along its longer side into pieces that are about as long as wide, since rays are not aimed at
/// pieces that are nearer than their length. Adds them to `cells`, up to `most` in total.
void add_portal_cells(const PortalCell& opening, std::size_t most, std::vector<PortalCell>& cells);

/// Cuts parallelograms near x into parts that are shorter than their distance, down to a sixteenth, and into `max`
/// parts in total. Rays are not aimed at parts that are nearer than their length, but next to a narrow door most light
/// comes from its nearest part. Returns `cells` or the parts, which are stored in `parts`.
std::span<const PortalCell> cut_near_cells(std::span<const PortalCell> cells, const Point& x, std::size_t max,
                                           std::vector<PortalCell>& parts);

/// True if a ray passes through a parallelogram, or past it at a distance below the share `beside` of its size.
bool passes_near(const Point& from, const Vec3& direction, const PortalCell& cell, double beside = 0.5);

}  // namespace exitance
