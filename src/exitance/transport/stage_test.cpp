#include "exitance/transport/stage.hpp"

#include <gtest/gtest.h>

#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// Leaves of a tree intersect each other everywhere: split along these contacts, each would become several elements.
TEST(Stage, ManySmallPolygonsAreOneElementEach) {
    const Scene scene = built_scene("tree", {{"leaves", "3000"}});
    const Stage stage(scene);
    const ElementTree tree = stage.make_elements({.edge = 5, .grading_levels = 0});
    std::size_t leaves = 0, cut = 0;
    for (ElementId root : tree.roots()) {
        if (tree.area(root) > 0.01) continue;
        ++leaves, cut += tree.is_leaf(root) ? 0 : 1;
    }
    EXPECT_EQ(leaves, 6000u);
    EXPECT_EQ(cut, 0u);
    // Splitting all elements along contacts, the small ones included, adds more than a tenth.
    ElementTree alone;
    for (const Piece& piece : stage.pieces) alone.add_root(piece.region, piece.patch);
    cut_along_contacts(alone, alone.leaves(), stage.contacts);
    EXPECT_GT(alone.leaves().size(), 1.1 * static_cast<double>(alone.roots().size()));
}

TEST(Stage, FewPolygonsAreSplitWhereTheyTouch) {
    const Scene scene = built_scene("tree", {{"leaves", "300"}});
    const Stage stage(scene);
    const ElementTree tree = stage.make_elements({.edge = 5, .grading_levels = 0});
    EXPECT_GT(tree.leaves().size(), tree.roots().size());
}

}  // namespace
}  // namespace exitance
