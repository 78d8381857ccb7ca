#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "exitance/solution/solution.hpp"

namespace exitance {

/// The leaves of a solution's interpolant as polygons for other programs. Every polygon has points of its own, since
/// light may jump from one to the next; they go counter-clockwise seen from its front.
struct ElementMesh {
    std::vector<std::uint32_t> first_point = {0};  ///< Per polygon, and one past the last.
    std::vector<std::uint32_t> connectivity;       ///< Points of the polygons; empty: one after the other.
    std::vector<Point> points;
    std::vector<std::array<float, bands>> irradiance, radiosity;  ///< Per point, W/m^2.
    /// Per polygon. A region of many faces may have leaves that lie on several of them: the face at the leaf's centre.
    std::vector<std::int32_t> surface, region, material, group;

    std::size_t size() const { return surface.size(); }
    std::size_t corner_count(std::size_t polygon) const { return first_point[polygon + 1] - first_point[polygon]; }
    std::array<std::pair<const char*, const std::vector<std::int32_t>*>, 4> cell_ids() const {
        return {{{"surface", &surface}, {"region", &region}, {"material", &material}, {"group", &group}}};
    }
    /// Polygons; triangles of six nodes, corners, then the middles of the edges; or triangles of ten, corners, thirds
    /// of the edges 01, 12, 20, and the centroid, through which cubic polynomials lead.
    enum class Cells : std::uint8_t { polygons, quadratic, cubic } cells = Cells::polygons;

    /// Points of all cells, and what VTK calls each cell.
    std::vector<std::int64_t> cell_points() const;
    std::vector<std::uint8_t> cell_types() const;
};

ElementMesh make_element_mesh(const Solution& solution);

/// Its corners, one after the other, where nobody needs the whole of it.
class CornerWalk {
  public:
    /// The tree must outlive it.
    explicit CornerWalk(const ElementTree& tree) : tree_(tree) {}

    /// Goes to the next corner, at first to the first one; there has to be one.
    void next();
    ElementId leaf() const { return leaf_; }
    Vec2 uv() const { return corners_[at_]; }

  private:
    const ElementTree& tree_;
    ElementId leaf_;
    std::size_t next_leaf_ = 0, at_ = 0;
    std::vector<Vec2> corners_;
};

/// The face that each leaf of a solution's interpolant shows.
std::vector<std::int32_t> faces_of_leaves(const Solution& solution);

/// The same with the quadratic triangles of a discontinuity mesh, whose nodes are shared, where there is one; of Clough
/// and Tocher's elements, three cubic triangles each.
ElementMesh make_cells(const Solution& solution);

/// VTK's type of a polygon of so many corners: triangle, quadrilateral or polygon.
constexpr std::uint8_t vtk_cell_type(std::size_t corners) {
    return corners == 3 ? 5 : corners == 4 ? 9 : 7;
}

/// Numbers in rows, one row after the other, where they stand.
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
