#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "exitance/solution/solution.hpp"

namespace exitance {

/// The leaves of a solution's interpolant as polygons for other programs. Each polygon has its own points, since light
/// may be discontinuous between leaves. Points are counter-clockwise seen from the front.
struct ElementMesh {
    std::vector<std::uint32_t> first_point = {0};  ///< First point of each polygon, and the end of the last one.
    std::vector<std::uint32_t> connectivity;       ///< Point indices of the polygons; empty: points are in order.
    std::vector<Point> points;
    std::vector<std::array<float, bands>> irradiance, radiosity;  ///< Values at the points, W/m^2.
    /// Per polygon. If a leaf covers several faces of its region, `surface` is the face at its centre.
    std::vector<std::int32_t> surface, region, material, group;

    std::size_t size() const { return surface.size(); }
    std::size_t corner_count(std::size_t polygon) const { return first_point[polygon + 1] - first_point[polygon]; }
    std::array<std::pair<const char*, const std::vector<std::int32_t>*>, 4> cell_ids() const {
        return {{{"surface", &surface}, {"region", &region}, {"material", &material}, {"group", &group}}};
    }
    /// Polygons; triangles of six nodes (corners, then the middles of the edges); or cubic triangles of ten nodes
    /// (corners, two points on each of the edges 01, 12, 20, and the centroid).
    enum class Cells : std::uint8_t { polygons, quadratic, cubic } cells = Cells::polygons;

    /// Point indices of all cells, and VTK's type of each cell.
    std::vector<std::int64_t> cell_points() const;
    std::vector<std::uint8_t> cell_types() const;
};

ElementMesh make_element_mesh(const Solution& solution);

/// Iterates over the corners of an element mesh without storing the mesh.
class CornerWalk {
  public:
    /// `tree` must outlive this object.
    explicit CornerWalk(const ElementTree& tree) : tree_(tree) {}

    /// Moves to the next corner, which must exist; the first call moves to the first corner.
    void next();
    ElementId leaf() const { return leaf_; }
    Vec2 uv() const { return corners_[at_]; }

  private:
    const ElementTree& tree_;
    ElementId leaf_;
    std::size_t next_leaf_ = 0, at_ = 0;
    std::vector<Vec2> corners_;
};

/// Returns the face that each leaf of a solution's interpolant shows.
std::vector<std::int32_t> faces_of_leaves(const Solution& solution);

/// Like make_element_mesh(), but for a solution with a discontinuity mesh returns its quadratic triangles, with shared
/// nodes. Clough-Tocher elements become three cubic triangles each.
ElementMesh make_cells(const Solution& solution);

/// VTK's cell type of a polygon: triangle, quadrilateral or polygon.
constexpr std::uint8_t vtk_cell_type(std::size_t corners) {
    return corners == 3 ? 5 : corners == 4 ? 9 : 7;
}

/// The numbers in rows of `n` as one span, without copying.
template <class T, std::size_t n>
std::span<const T> numbers_of(const std::vector<std::array<T, n>>& rows) {
    static_assert(sizeof(std::array<T, n>) == n * sizeof(T));
    return {rows.empty() ? nullptr : rows.front().data(), rows.size() * n};
}
inline std::span<const double> numbers_of(const std::vector<Point>& points) {
    static_assert(sizeof(Point) == 3 * sizeof(double));
    return {points.empty() ? nullptr : &points.front().x, points.size() * 3};
}

}  // namespace exitance
