#pragma once

#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/mesh/contact_lines.hpp"

namespace exitance {

/// The nodes of a conforming mesh: points at which leaf corners meet and share one value. Corners at one point share a
/// node if a path around the point connects them without crossing a line of discontinuity.
struct SharedNodes {
    /// Per leaf: index of its first corner in `node_of`. Entries of inner elements are unused.
    Field<ElementId, std::uint32_t> first_corner;
    std::vector<std::uint32_t> node_of;     ///< Node of each corner. The nodes of a plane are contiguous.
    std::vector<std::uint32_t> first_node;  ///< First node of each plane; last entry: number of nodes.

    std::span<const std::uint32_t> of(ElementId leaf, const ElementTree& tree) const {
        const int corners = leaf < tree.first_of_fans() ? tree.patch(leaf).corner_count() : 3;
        return std::span(node_of).subspan(first_corner[leaf], static_cast<std::size_t>(corners));
    }
};

/// Makes a tree conforming, so that a function with one polynomial per leaf and one value per node is continuous over
/// whole planes. Leaves with hanging nodes (corners of other leaves on their sides), and cells, are split into fans of
/// triangles. A sliver that cannot be triangulated gets nodes of its own. Lines of contact are discontinuities, as
/// judged by the size of the leaves. O(n log n).
/// stop  if requested before all leaves are processed, returns no nodes, and the tree is unusable
SharedNodes make_conforming(ElementTree& tree, const Field<RegionId, std::uint32_t>& plane,
                            const ContactLines& contacts, const StopRequest* stop = nullptr);

}  // namespace exitance
