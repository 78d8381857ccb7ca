#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/mesh/leaf_finder.hpp"

namespace exitance {

/// Finds the leaf of a tree that contains a point of a region. Regions with few roots are searched linearly, those with
/// many use a grid over the plane; below the root a LeafFinder takes over. A query takes a few steps, independent of
/// the number of roots and of the depth. Results refer to the tree as it was at construction.
class ElementLocator {
  public:
    ElementLocator(const ElementTree& tree, std::size_t region_count);

    /// Returns the leaf of `region` that contains the projection of `p` (metres) onto the region's plane, and the
    /// coordinates in it. A point outside all roots is assigned to the nearest root; a point on a border, to the root
    /// with the lower id. Returns element none if the region has no roots. Thread-safe.
    ElementTree::Place find(RegionId region, const Point& p) const;

    /// Like find(), but returns the leaf's index among all leaves in the order of their ids; `no_leaf` if there is
    /// none.
    LeafFinder::Found find_leaf(RegionId region, const Point& p) const;
    static constexpr std::uint32_t no_leaf = 0xffffffffu;

    /// Finds the root of a region that contains a point, and the coordinates in it, for LeafFinder::find(). The region
    /// must have roots. Does not set `leaf`. Writes to `out` directly because copying a result that was just written
    /// would stall.
    void find_root(RegionId region, const Point& p, LeafFinder::Query& out) const;
    const LeafFinder& leaves() const { return leaves_; }

  private:
    /// A root with the gradients of its coordinates: u = du . (p - origin), v = dv . (p - origin).
    struct Root {
        Point origin;
        Vec3 du, dv;
        std::uint32_t number = 0;  ///< Index among the tree's roots.
        Patch::Shape shape = Patch::Shape::parallelogram;

        Vec2 coordinates(const Point& p) const {
            const Vec3 w = p - origin;
            return {dot(du, w), dot(dv, w)};
        }
        bool holds(Vec2 at) const {
            const bool square = at.x >= 0 && at.y >= 0 && at.x <= 1 && at.y <= 1;
            return square && (shape == Patch::Shape::parallelogram || at.x + at.y <= 1);
        }
        Vec2 held(Vec2 at) const { return holds(at) ? at : into_shape(at, shape); }
    };
    /// Roots of a region per cell of a grid, over the two axes on which the region's plane projects best.
    struct Grid {
        std::uint8_t s = 0, t = 1;  ///< Indices of the coordinates (0: x, 1: y, 2: z) along the grid's axes.
        std::uint32_t columns = 1, rows = 1;
        double s0 = 0, t0 = 0, s_scale = 0, t_scale = 0;  ///< cell = floor((p - origin) scale)
        std::vector<std::uint32_t> first;                 ///< Per cell, and one past the last: first index in `roots`.
        std::vector<Root> roots;

        std::uint32_t column(double x) const;
        std::uint32_t row(double y) const;
        std::span<const Root> cell(std::uint32_t i) const {
            return std::span(roots).subspan(first[i], first[i + 1] - first[i]);
        }
    };

    struct Nearest;
    Nearest nearest_root(RegionId region, const Point& p) const;

    std::span<const Root> roots(RegionId region) const {
        return std::span(roots_).subspan(first_root_[region.value],
                                         first_root_[region.value + 1] - first_root_[region.value]);
    }
    static Grid make_grid(std::span<const Root> roots);

    LeafFinder leaves_;
    std::vector<std::uint32_t> first_root_;  ///< Per region, and one past the last: first index in `roots_`.
    std::vector<Root> roots_;                ///< Sorted by region, then by index.
    std::vector<std::int32_t> grid_of_;      ///< Per region: index in `grids_`; -1 for regions with few roots.
    std::vector<Grid> grids_;
};

}  // namespace exitance
