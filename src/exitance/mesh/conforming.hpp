#pragma once

#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/mesh/contact_lines.hpp"

namespace exitance {

/// The nodes of a conforming mesh: places at which the corners of leaves meet and hold one value. Corners at one place
/// share a node where they can be walked to around it without crossing a line at which light jumps.
struct SharedNodes {
    Field<ElementId, std::uint32_t> first_corner;  ///< Of a leaf in `node_of`; of inner elements: unused.
    std::vector<std::uint32_t> node_of;            ///< The node of a corner; nodes of a plane stand side by side,
    std::vector<std::uint32_t> first_node;         ///< from here on: one a plane, and one past the last.

    std::span<const std::uint32_t> of(ElementId leaf, const ElementTree& tree) const {
        const int corners = leaf < tree.first_of_fans() ? tree.patch(leaf).corner_count() : 3;
        return std::span(node_of).subspan(first_corner[leaf], static_cast<std::size_t>(corners));
    }
};

/// Makes a function that is one polynomial a leaf and one value a node continuous over whole planes: leaves on whose
/// sides corners of others stand, and cells, are cut into fans of triangles. A sliver that has no triangles keeps nodes
/// of its own. Light jumps at contacts, as leaves of their size see it. O(n log n).
/// Where `stop` is requested before all leaves are looked at, no nodes are returned, and the tree is of no use.
SharedNodes make_conforming(ElementTree& tree, const Field<RegionId, std::uint32_t>& plane,
                            const ContactLines& contacts, const StopRequest* stop = nullptr);

}  // namespace exitance
