#pragma once

#include "exitance/mesh/element_tree.hpp"

namespace exitance::test {

/// A parallelogram, a triangle, and a parallelogram that is split into a triangle and a cell with five corners.
inline ElementTree elements_of_every_kind() {
    ElementTree tree;
    const Patch square{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, Patch::Shape::parallelogram};
    const Patch triangle{{0, 0, 1}, {1, 0, 0}, {0, 3, 0}, Patch::Shape::triangle};
    tree.add_root(RegionId(0), square);
    tree.add_root(RegionId(1), triangle);
    tree.add_root(RegionId(2), square);
    tree.split_by_line(ElementId(2), {{1, 1}, 1.6});
    return tree;
}

}  // namespace exitance::test
