#include "exitance/mesh/contact_lines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/mesh/pieces.hpp"
#include "support/motion.hpp"

namespace exitance {
namespace {

/// A floor of 4 m x 4 m, and an upright plate along x = 1 from y = 1 to y = 3, `gap` metres above it.
Scene floor_and_plate(double gap) {
    SceneDescription d;
    d.points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, gap}, {1, 3, gap}, {1, 3, 1}, {1, 1, 1}};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = {"all"};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}, {{4, 5, 6, 7}, 0, 0, 2}};
    return std::move(*make_scene(std::move(d)).scene);
}

TEST(ContactLines, AnElementIsCutAlongAPlateOnIt) {
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
    // Split along its own direction, so that the parts are parallelograms.
    EXPECT_FALSE(tree.is_cell(left) || tree.is_cell(right));
}

TEST(ContactLines, AnElementIsCutAlongAPlateThatIsDividedWhereItCrosses) {
    // The faces of the plate meet in the plane of the floor: none of them crosses it, and their common edge is no
    // border of the plate. Models are often divided in this way.
    for (const Motion& motion : {as_written, turned_and_moved})
        for (const bool has_triangles : {false, true}) {
            SceneDescription d;
            for (const Point& p : {Point{0, 0, 0},
                                   {4, 0, 0},
                                   {4, 4, 0},
                                   {0, 4, 0},
                                   {1, 0, -1},
                                   {1, 4, -1},
                                   {1, 4, 0},
                                   {1, 0, 0},
                                   {1, 4, 1},
                                   {1, 0, 1}})
                d.points.push_back(motion(p));
            d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
            d.groups = {"all"};
            d.faces = {{{0, 1, 2, 3}, 0, 0, 1}};
            for (const std::vector<std::uint32_t>& half :
                 {std::vector<std::uint32_t>{4, 5, 6, 7}, std::vector<std::uint32_t>{7, 6, 8, 9}}) {
                if (!has_triangles) d.faces.push_back({half, 0, 0, 2});
                if (has_triangles)
                    d.faces.push_back({{half[0], half[1], half[2]}, 0, 0, 2}),
                        d.faces.push_back({{half[0], half[2], half[3]}, 0, 0, 3});
            }
            const Scene scene = std::move(*make_scene(std::move(d)).scene);
            ASSERT_EQ(scene.regions().size(), 2u);
            ElementTree tree;
            tree.add_root(RegionId(0), {motion({0, 0, 0}), motion({4, 0, 0}) - motion({0, 0, 0}),
                                        motion({0, 4, 0}) - motion({0, 0, 0}), Patch::Shape::parallelogram});
            cut_along_contacts(tree, {ElementId(0)}, ContactLines(scene));
            ASSERT_EQ(tree.leaves().size(), 2u);
            EXPECT_NEAR(tree.area(tree.leaf_at(ElementId(0), {0.2499, 0.5}).element), 4 * motion.scale * motion.scale,
                        1e-9);
        }
}

TEST(ContactLines, AnElementIsCutAlongAPaneOnIt) {
    SceneDescription d;
    d.points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = {"all"};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}};
    Pane pane;
    pane.corners = {{1, 0, 0}, {1, 4, 0}, {1, 4, 1}, {1, 0, 1}};
    d.panes = {pane};
    const Scene scene = std::move(*make_scene(std::move(d)).scene);
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, Patch::Shape::parallelogram});
    cut_along_contacts(tree, {ElementId(0)}, ContactLines(scene));
    ASSERT_EQ(tree.leaves().size(), 2u);
    EXPECT_NEAR(tree.area(tree.leaf_at(ElementId(0), {0.2499, 0.5}).element), 4, 1e-9) << "on its one side";
}

/// A shallow bowl of triangles, seen from inside: over the plane of each, edges of the next faces rise slowly.
Scene shallow_bowl(const Motion& motion) {
    constexpr int side = 12;
    SceneDescription d;
    // Irregular, so that edges of neighbours are nearly parallel to borders here and there.
    for (int j = 0; j <= side; ++j)
        for (int i = 0; i <= side; ++i) {
            const double x = i + 0.2 * std::sin(3.0 * i + 5.0 * j), y = j + 0.2 * std::sin(7.0 * i + 2.0 * j);
            d.points.push_back(motion({x, y, 0.01 * ((x - 6) * (x - 6) + (y - 6) * (y - 6))}));
        }
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = {"all"};
    const auto at = [](int i, int j) { return static_cast<std::uint32_t>(j * (side + 1) + i); };
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            d.faces.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, 0, 0, 1});
            d.faces.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}, 0, 0, 1});
        }
    return std::move(*make_scene(std::move(d)).scene);
}

TEST(ContactLines, TheNextFacesOfACurvedSurfaceCutNothing) {
    for (const Motion& motion : {as_written, turned_and_moved}) {
        const Scene scene = shallow_bowl(motion);
        ElementTree tree;
        for (const Piece& piece : cut_into_pieces(scene)) tree.add_root(piece.region, piece.patch);
        const std::vector<ElementId> faces = tree.leaves();
        cut_along_contacts(tree, faces, ContactLines(scene));
        EXPECT_EQ(tree.leaves().size(), faces.size());
    }
}

/// A leaf that stands up by 1% from the corner of a floor: it shares a corner, and its edges are above the floor.
TEST(ContactLines, ALeafThatBeginsAtACornerCutsWhatItCovers) {
    SceneDescription d;
    d.points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {2, 1, 0.02}, {1, 2, 0.02}};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = {"all"};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}, {{0, 4, 5}, 0, 0, 2}};
    const Scene scene = std::move(*make_scene(std::move(d)).scene);
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, Patch::Shape::parallelogram});
    cut_along_contacts(tree, {ElementId(0)}, ContactLines(scene));
    EXPECT_NE(tree.leaf_at(ElementId(0), {0.25, 0.25}).element, tree.leaf_at(ElementId(0), {0.5, 0.1}).element);
    EXPECT_NE(tree.leaf_at(ElementId(0), {0.25, 0.25}).element, tree.leaf_at(ElementId(0), {0.6, 0.6}).element);
}

TEST(ContactLines, NothingIsCutAfterAStopRequest) {
    const Scene scene = floor_and_plate(0);
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, Patch::Shape::parallelogram});
    StopRequest stop;
    stop.interrupt();
    cut_along_contacts(tree, {ElementId(0)}, ContactLines(scene), &stop);
    EXPECT_TRUE(tree.is_leaf(ElementId(0)));
}

TEST(ContactLines, ASlantingLineCutsAnElementIntoCells) {
    const Scene scene = floor_and_plate(0);
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {3, 1, 0}, {-1, 3, 0}, Patch::Shape::parallelogram});
    cut_along_contacts(tree, {ElementId(0)}, ContactLines(scene));
    ASSERT_EQ(tree.leaves().size(), 2u);
    for (ElementId e : tree.leaves()) EXPECT_TRUE(tree.is_cell(e));
}

/// A floor already split by slanting lines, one cell within another; the plate crosses several of them.
TEST(ContactLines, CellsAreCutLikeWholeElements) {
    const Scene scene = floor_and_plate(0);
    ElementTree tree;
    const ElementId floor = tree.add_root(RegionId(0), {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, Patch::Shape::parallelogram});
    const ElementId left = tree.split_by_line(floor, {{0.8, 0.6}, 0.52});
    ASSERT_FALSE(tree.split_by_line(left, {{-0.6, 0.8}, 0.2}).is_none());
    const std::vector<ElementId> before = tree.leaves();
    ASSERT_EQ(before.size(), 3u);
    cut_along_contacts(tree, before, ContactLines(scene));
    double area = 0;
    for (ElementId e : tree.leaves()) area += tree.area(e);
    EXPECT_NEAR(area, 16, 1e-9);
    // Split each one separately.
    for (ElementId e : before) {
        ElementTree alone;
        alone.add_root(RegionId(0), tree.patch(floor));
        alone.split_by_line(floor, {{0.8, 0.6}, 0.52}), alone.split_by_line(left, {{-0.6, 0.8}, 0.2});
        cut_along_contacts(alone, {e}, ContactLines(scene));
        ASSERT_EQ(tree.is_leaf(e), alone.is_leaf(e));
        for (std::size_t i = 0; i < tree.children(e).size(); ++i) {
            const std::vector<Point> one = tree.outline(tree.children(e)[i]),
                                     other = alone.outline(alone.children(e)[i]);
            ASSERT_EQ(one.size(), other.size());
            for (std::size_t k = 0; k < one.size(); ++k) EXPECT_EQ(norm(one[k] - other[k]), 0);
        }
    }
    for (const double y : {1.2, 1.8, 2.6})
        EXPECT_NE(tree.leaf_at(floor, {0.2499, y / 4}).element, tree.leaf_at(floor, {0.2501, y / 4}).element) << y;
}

TEST(ContactLines, AnEdgeAboveASurfaceHasAStripOnEachSide) {
    const Scene scene = floor_and_plate(0.05);
    const ContactLines contacts(scene);
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, Patch::Shape::parallelogram});
    std::vector<ContactLines::Line> lines = contacts.around(tree, ElementId(0), 16);
    EXPECT_EQ(contacts.inside(tree, ElementId(0), lines).size(), 3u);
    cut_along_contacts(tree, {ElementId(0)}, contacts);
    EXPECT_NEAR(tree.area(tree.leaf_at(ElementId(0), {0.25 + 0.006, 0.5}).element), 0.05 * 4, 1e-9);
}

/// A floor of 4 m x 4 m, and a board of 1 m x 2 m that faces it from `gap` metres above.
Scene floor_under_board(double gap) {
    SceneDescription d;
    d.points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, gap}, {1, 3, gap}, {2, 3, gap}, {2, 1, gap}};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = {"all"};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}, {{4, 5, 6, 7}, 0, 0, 2}};
    return std::move(*make_scene(std::move(d)).scene);
}

/// Ends of the parts of the first element along its middle line, in heights of the gap, measured from below the board's
/// edge at x = 1. The element starts at x = `from` and is `width` wide.
std::vector<double> ends_under_board(const ElementTree& tree, double from, double width, double gap) {
    std::vector<double> out;
    for (double height : {0.0, 1.0, 3.0, 7.0}) {
        const double at = (1 + height * gap - from) / width;
        if (at + 1e-6 < 1 && tree.leaf_at(ElementId(0), {at - 1e-6, 0.5}).element !=
                                 tree.leaf_at(ElementId(0), {at + 1e-6, 0.5}).element)
            out.push_back(height);
    }
    return out;
}

/// A square part of the floor of `width` metres, starting at x = `from`, split along contacts.
ElementTree floor_element(const Scene& scene, double from, double width) {
    ElementTree tree;
    tree.add_root(RegionId(0), {{from, 2 - width / 2, 0}, {width, 0, 0}, {0, width, 0}, Patch::Shape::parallelogram});
    cut_along_contacts(tree, {ElementId(0)}, ContactLines(scene));
    return tree;
}

TEST(ContactLines, StripsOfAGapWidenFromItsMouthInwards) {
    const Scene scene = floor_under_board(0.045);
    EXPECT_EQ(ends_under_board(floor_element(scene, 0.5, 2), 0.5, 2, 0.045), (std::vector<double>{0, 1, 3, 7}));
    // The board itself: strips start at its border, and there is nothing beyond it.
    ElementTree board;
    board.add_root(RegionId(1), {{1, 1, 0.045}, {0, 2, 0}, {1, 0, 0}, Patch::Shape::parallelogram});
    cut_along_contacts(board, {ElementId(0)}, ContactLines(scene));
    for (double height : {1.0, 3.0, 7.0}) {
        const double at = height * 0.045;
        EXPECT_NE(board.leaf_at(ElementId(0), {0.5, at - 1e-6}).element,
                  board.leaf_at(ElementId(0), {0.5, at + 1e-6}).element)
            << height;
    }
}

/// A height that is no discontinuity for an element may still be a gap for it, up to half of the element's width.
TEST(ContactLines, AnElementWiderThanTheHeightOfAGapIsCut) {
    const Scene scene = floor_under_board(0.05);
    EXPECT_EQ(ends_under_board(floor_element(scene, 0.8, 0.4), 0.8, 0.4, 0.05), (std::vector<double>{1, 3}));
    EXPECT_EQ(ends_under_board(floor_element(scene, 0.97, 0.12), 0.97, 0.12, 0.05), (std::vector<double>{1}));
    EXPECT_EQ(floor_element(scene, 0.97, 0.09).leaves().size(), 1u);
}

TEST(ContactLines, StripsEndBeforeTheMiddleOfAGap) {
    for (const auto& [gap, ends] : {std::pair{0.08, std::vector<double>{1, 3}}, {0.2, {1}}, {0.26, {}}}) {
        const Scene scene = floor_under_board(gap);
        EXPECT_EQ(ends_under_board(floor_element(scene, 0.5, 1), 0.5, 1, gap), ends) << gap;
    }
}

/// Only the lowest of several stacked boards makes a gap with the floor; the mouths of the others are not over it.
TEST(ContactLines, TheNearestOfAStackMakesTheGap) {
    SceneDescription d;
    d.points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = {"all"};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}};
    for (const double z : {0.05, 0.08, 0.11}) {
        const auto first = static_cast<std::uint32_t>(d.points.size());
        d.points.insert(d.points.end(), {{1, 1, z}, {1, 3, z}, {2, 3, z}, {2, 1, z}});
        d.faces.push_back({{first, first + 1, first + 2, first + 3}, 0, 0, static_cast<int>(first)});
    }
    const Scene scene = std::move(*make_scene(std::move(d)).scene);
    const Scene alone = floor_under_board(0.05);
    EXPECT_EQ(floor_element(scene, 0.8, 0.4).leaves().size(), floor_element(alone, 0.8, 0.4).leaves().size());
}

/// A strip is as wide as the gap is high, and as far from the middle. The board is 2 m long, so that a gap with strips
/// is at most half a metre high.
TEST(ContactLines, ABoardFarAboveMakesNoGap) {
    const Scene scene = floor_under_board(0.6);
    ElementTree board;
    board.add_root(RegionId(1), {{1, 1, 0.6}, {0, 2, 0}, {1, 0, 0}, Patch::Shape::parallelogram});
    cut_along_contacts(board, {ElementId(0)}, ContactLines(scene));
    EXPECT_EQ(board.leaves().size(), 1u);
}

/// Parallel slats 2 m long and 25 mm wide. At a height of 5 mm, a fifth of the width, polynomials can follow the light
/// across a slat, so that only strips at its ends are cut off, which are not cut again. At 1 mm there are strips along
/// its edges; those at the ends would be 7 mm of 2 m, too little to matter.
TEST(ContactLines, StripsOfASlatAreAsWideAsTheGapIsHigh) {
    for (const double gap : {0.005, 0.001}) {
        SceneDescription d;
        d.points = {{0, 0, 0},      {2, 0, 0},       {2, 0.025, 0},   {0, 0.025, 0},
                    {0, 0.01, gap}, {0, 0.035, gap}, {2, 0.035, gap}, {2, 0.01, gap}};
        d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
        d.groups = {"all"};
        d.faces = {{{0, 1, 2, 3}, 0, 0, 1}, {{4, 5, 6, 7}, 0, 0, 2}};
        const Scene scene = std::move(*make_scene(std::move(d)).scene);
        ElementTree tree;
        tree.add_root(RegionId(0), {{0, 0, 0}, {2, 0, 0}, {0, 0.025, 0}, Patch::Shape::parallelogram});
        cut_along_contacts(tree, {ElementId(0)}, ContactLines(scene));
        double shortest = 2, narrowest = 0.025, across_ends = 0.025;
        for (ElementId e : tree.leaves()) {
            const Patch& patch = tree.patch(e);
            const double along = norm(patch.a), across = norm(patch.b);
            shortest = std::min(shortest, along), narrowest = std::min(narrowest, across);
            if (along < 0.1) across_ends = std::min(across_ends, across);
        }
        EXPECT_NEAR(shortest, gap < 0.002 ? 2 : gap, 1e-9) << gap;
        EXPECT_EQ(narrowest < 0.02, gap < 0.002) << gap;
        EXPECT_NEAR(across_ends, 0.025, 1e-9) << gap;
    }
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

TEST(ContactLines, TrianglesOfTheOtherSideOfASheetCutNothing) {
    // A disc with two sides, each of 48 triangles around one corner, as written by exporters.
    constexpr std::uint32_t n = 50;
    SceneDescription d;
    for (std::uint32_t k = 0; k < n; ++k) d.points.push_back({std::cos(2 * pi * k / n), std::sin(2 * pi * k / n), 0});
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = {"all"};
    for (std::uint32_t k = 2; k < n; ++k)
        d.faces.push_back({{0, k - 1, k}, 0, 0, 1}), d.faces.push_back({{0, k, k - 1}, 0, 0, 2});
    const Scene scene = std::move(*make_scene(std::move(d)).scene);
    ASSERT_EQ(scene.regions().size(), 2u);
    ElementTree tree;
    tree.add_root(RegionId(0), {{0.5, -0.3, 0}, {0.4, 0, 0}, {0, 0.6, 0}, Patch::Shape::parallelogram});
    cut_along_contacts(tree, {ElementId(0)}, ContactLines(scene));
    EXPECT_EQ(tree.leaves().size(), 1u);
}

TEST(ContactLines, LimitsOfHeightShrinkWithTheElement) {
    // Forty plates close together on a large floor, and a board 2 m above them. For half of the floor, 45 m wide, that
    // height is small; for the smaller parts into which the plates split it, it is not.
    SceneDescription d;
    d.points = {{0, 0, 0}, {64, 0, 0}, {64, 64, 0}, {0, 64, 0}, {8.5, 1, 2}, {8.5, 3, 2}, {11, 3, 2}, {11, 1, 2}};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = {"all"};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}, {{4, 5, 6, 7}, 0, 0, 2}};
    for (std::uint32_t k = 0; k < 40; ++k) {
        const double x = 9.8 + 0.01 * k;
        const auto first = static_cast<std::uint32_t>(d.points.size());
        for (const Point& p : {Point{x, 1.9, 0}, Point{x, 2.1, 0}, Point{x, 2, 0.1}}) d.points.push_back(p);
        d.faces.push_back({{first, first + 1, first + 2}, 0, 0, 3});
    }
    const Scene scene = std::move(*make_scene(std::move(d)).scene);
    const ContactLines contacts(scene);
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {64, 0, 0}, {0, 64, 0}, Patch::Shape::parallelogram});
    const double root_half = std::sqrt(0.5);
    tree.split_by_line(ElementId(0), {{root_half, -root_half}, 0});
    const ElementId half = tree.leaf_at(ElementId(0), {10. / 64, 2. / 64}).element;
    ASSERT_TRUE(tree.is_cell(half));
    std::vector<ContactLines::Line> lines = contacts.around(tree, half, tree.area(half));
    ASSERT_TRUE(std::any_of(lines.begin(), lines.end(), [](const auto& line) { return line.a.x == 8.5; }));
    cut_along_contacts(tree, {half}, contacts);
    EXPECT_EQ(tree.leaf_at(ElementId(0), {8.5 / 64 - 1e-9, 2. / 64}).element,
              tree.leaf_at(ElementId(0), {8.5 / 64 + 1e-9, 2. / 64}).element);
    EXPECT_NE(tree.leaf_at(ElementId(0), {10.005 / 64, 2. / 64}).element,
              tree.leaf_at(ElementId(0), {10.015 / 64, 2. / 64}).element);
}

TEST(ContactLines, CuttingEndsAtAPointWhereManyFacesMeet) {
    SceneDescription d;
    d.points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1.3, 1.7, 0}, {1.3, 1.7, 1}};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = {"all"};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}};
    for (std::uint32_t k = 0; k < 40; ++k) {  // sheets that share an edge, like the leaves of an open book
        d.points.push_back({1.3 + std::cos(0.1 + 0.15 * k), 1.7 + std::sin(0.1 + 0.15 * k), 0});
        d.faces.push_back({{4, static_cast<std::uint32_t>(d.points.size()) - 1, 5}, 0, 0, 2});
    }
    const Scene scene = std::move(*make_scene(std::move(d)).scene);
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, Patch::Shape::parallelogram});
    cut_along_contacts(tree, {ElementId(0)}, ContactLines(scene));
    EXPECT_LT(tree.leaves().size(), 5000u);
    EXPECT_GT(tree.leaves().size(), 40u);
}

}  // namespace
}  // namespace exitance
