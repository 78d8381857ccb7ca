#include "exitance/mesh/contact_lines.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

/// A floor of 4 m x 4 m, and a plate that stands on it upright along x = 1, from y = 1 to y = 3, `gap` metres over it.
Scene floor_and_plate(double gap) {
    SceneDescription d;
    d.points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, gap}, {1, 3, gap}, {1, 3, 1}, {1, 1, 1}};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = {"all"};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}, {{4, 5, 6, 7}, 0, 0, 2}};
    return std::move(*make_scene(std::move(d)).scene);
}

TEST(ContactLines, AnElementIsCutWhereAPlateStandsOnIt) {
    const Scene scene = floor_and_plate(0);
    const ContactLines contacts(scene);
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, Patch::Shape::parallelogram});
    cut_along_contacts(tree, {ElementId(0)}, contacts);
    ASSERT_EQ(tree.leaves().size(), 2u);
    const auto left = tree.leaf_at(ElementId(0), {0.2499, 0.5}).element;
    const auto right = tree.leaf_at(ElementId(0), {0.2501, 0.5}).element;
    EXPECT_NE(left, right);
    EXPECT_NEAR(tree.area(left), 4, 1e-9);
    EXPECT_NEAR(tree.area(right), 12, 1e-9);
}

TEST(ContactLines, AnEdgeThatHoversHasAStripOnEitherSide) {
    const Scene scene = floor_and_plate(0.05);
    const ContactLines contacts(scene);
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, Patch::Shape::parallelogram});
    EXPECT_EQ(contacts.within(tree, ElementId(0)).size(), 3u);
    cut_along_contacts(tree, {ElementId(0)}, contacts);
    EXPECT_NEAR(tree.area(tree.leaf_at(ElementId(0), {0.25 + 0.006, 0.5}).element), 0.05 * 4, 1e-9);
}

TEST(ContactLines, AnEdgeFarAboveAndABorderCutNothing) {
    const Scene scene = floor_and_plate(0.6);
    const ContactLines contacts(scene);
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, Patch::Shape::parallelogram});
    cut_along_contacts(tree, {ElementId(0)}, contacts);
    EXPECT_EQ(tree.leaves().size(), 1u);
    const Scene touching = floor_and_plate(0);
    ElementTree beside;
    beside.add_root(RegionId(0), {{1, 0, 0}, {3, 0, 0}, {0, 4, 0}, Patch::Shape::parallelogram});
    cut_along_contacts(beside, {ElementId(0)}, ContactLines(touching));
    EXPECT_EQ(beside.leaves().size(), 1u);
}

}  // namespace
}  // namespace exitance
