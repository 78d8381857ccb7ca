#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// A triangle of a face, with the normals of the scene's file at its corners.
struct NormalTriangle {
    SurfaceId surface;
    std::array<Point, 3> corner;   ///< Metres.
    std::array<Normal, 3> normal;  ///< Normals at the corners, on the front side of the face.
};

/// The place on the curved surface that corresponds to a point of a face.
struct CurvedPlace {
    Point x;                         ///< On the curved patch or, where that is behind the face, on the face; metres.
    Normal n;                        ///< Normal, interpolated between the corners.
    std::size_t triangle = 0;        ///< Index into CurvedFaces::triangles().
    std::array<double, 3> weight{};  ///< Barycentric coordinates in the triangle.
};

/// Faces that approximate a curved surface, with the normals of the scene's file.
///
/// A region is curved if a corner's normal differs from that of its face by more than a tenth of a degree. It is flat
/// if a normal differs by more than 45 degrees, since a mesh that coarse approximates nothing, if its surface emits,
/// or if it is a side of a diffusing pane.
///
/// A triangle's patch is a point-normal triangle [Vlachos01]: a cubic Bezier patch whose boundary curve along edge ij
/// depends on the positions P and normals N of its two corners alone,
///
///     b_iij = (2 P_i + P_j - w_ij N_i) / 3,    w_ij = (P_j - P_i) . N_i,
///
/// so that patches of neighbours meet. Here w_ij is at most 0: the patch follows convex edges and stays on the face at
/// concave ones. The patch is therefore never behind the face, whose neighbours do not block rays that leave it.
class CurvedFaces {
  public:
    CurvedFaces() = default;
    /// Triangles of flat regions are left out. O(triangles).
    CurvedFaces(const Scene& scene, std::span<const NormalTriangle> triangles);

    bool empty() const { return triangles_.empty(); }
    bool is_curved(RegionId region) const { return !empty() && is_curved_[region] != 0; }
    std::span<const NormalTriangle> triangles() const { return triangles_; }

    /// Returns the place of a point of a face; none if the file has no normals there. O(triangles of the face).
    std::optional<CurvedPlace> find(SurfaceId surface, const Point& x) const;
    /// Returns the place at barycentric coordinates in a triangle.
    CurvedPlace at(std::size_t triangle, const std::array<double, 3>& weight) const;

  private:
    std::vector<NormalTriangle> triangles_;  ///< Triangles, in the order of their faces.
    Field<SurfaceId, std::uint32_t> first_;  ///< First triangle of each face.
    Field<SurfaceId, std::uint32_t> count_;  ///< Number of triangles of each face.
    Field<RegionId, std::uint8_t> is_curved_;
};

}  // namespace exitance
