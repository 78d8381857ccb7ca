#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/mesh/leaf_finder.hpp"

namespace exitance {

/// Finds the leaf of a tree that holds a point of a region. A region of few roots looks at each of them; one of many
/// keeps a grid over its plane; below the root the leaf finder takes over. So a query costs a few steps whatever the
/// number of roots and the depth. What is found are the leaves that there were when the locator was made.
class ElementLocator {
  public:
    ElementLocator(const ElementTree& tree, std::size_t region_count);

    /// The leaf of `region` that holds the foot of `p` (metres) in the region's plane, and the coordinates there. A
    /// point outside every root, by rounding or more, goes to the root nearest by; one on a border to the root of the
    /// lower id. The element is none when the region has no roots. Safe to call from any thread.
    ElementTree::Place find(RegionId region, const Point& p) const;

    /// The same by the leaf's number, its place among the leaves in the order of their ids; `no_leaf` for none.
    LeafFinder::Found find_leaf(RegionId region, const Point& p) const;
    static constexpr std::uint32_t no_leaf = 0xffffffffu;

    /// The root of a region that holds a point, and the coordinates there, for LeafFinder::find; the region must have
    /// roots. `leaf` is left open. Written in place, since a copy at once would wait for what was just written.
    void find_root(RegionId region, const Point& p, LeafFinder::Query& out) const;
    const LeafFinder& leaves() const { return leaves_; }

  private:
    /// A root, and how to take coordinates in it: u = du . (p - origin), v = dv . (p - origin).
    struct Root {
        Point origin;
        Vec3 du, dv;
        std::uint32_t number = 0;  ///< Among the tree's roots.
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
    /// Roots by the cell of a grid over the two axes along which the region's plane can be told apart.
    struct Grid {
        std::uint8_t s = 0, t = 1;  ///< The axes.
        std::uint32_t columns = 1, rows = 1;
        double s0 = 0, t0 = 0, s_scale = 0, t_scale = 0;  ///< cell = floor((p - origin) scale)
        std::vector<std::uint32_t> first;                 ///< Per cell, and one past the last: where its roots begin.
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
    std::vector<std::uint32_t> first_root_;  ///< Per region, and one past the last, into `roots_`.
    std::vector<Root> roots_;                ///< Sorted by region, then by number.
    std::vector<std::int32_t> grid_of_;      ///< Per region; -1 for those of few roots.
    std::vector<Grid> grids_;
};

}  // namespace exitance
