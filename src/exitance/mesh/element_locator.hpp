#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Finds the leaf of a tree that holds a point of a region. A region of few roots looks at each of them; one of many
/// keeps a grid over its plane, so that a query costs O(1 + depth) whatever the number of roots.
/// The tree must outlive the locator, and its roots must not change; leaves may be split at any time.
class ElementLocator {
  public:
    ElementLocator(const ElementTree& tree, std::size_t region_count);

    /// The leaf of `region` that holds the foot of `p` (metres) in the region's plane, and the coordinates there. A
    /// point outside every root, by rounding or more, goes to the root nearest by; one on a border to the root of the
    /// lower id. The element is none when the region has no roots. Safe to call from any thread.
    ElementTree::Place find(RegionId region, const Point& p) const;

  private:
    /// Roots by the cell of a grid over the two axes along which the region's plane can be told apart.
    struct Grid {
        std::uint8_t s = 0, t = 1;  ///< The axes.
        std::uint32_t columns = 1, rows = 1;
        double s0 = 0, t0 = 0, s_scale = 0, t_scale = 0;  ///< cell = floor((p - origin) scale)
        std::vector<std::uint32_t> first;                 ///< Per cell, and one past the last: where its roots begin.
        std::vector<ElementId> roots;

        std::uint32_t column(double x) const;
        std::uint32_t row(double y) const;
        std::span<const ElementId> cell(std::uint32_t i) const {
            return std::span(roots).subspan(first[i], first[i + 1] - first[i]);
        }
    };

    std::span<const ElementId> roots(RegionId region) const {
        return std::span(roots_).subspan(first_root_[region.value],
                                         first_root_[region.value + 1] - first_root_[region.value]);
    }
    Grid make_grid(std::span<const ElementId> roots) const;

    const ElementTree* tree_;
    std::vector<std::uint32_t> first_root_;  ///< Per region, and one past the last, into `roots_`.
    std::vector<ElementId> roots_;           ///< Sorted by region, then by id.
    std::vector<std::int32_t> grid_of_;      ///< Per region; -1 for those of few roots.
    std::vector<Grid> grids_;
};

}  // namespace exitance
