#include "exitance/links/link_sites.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/links/error/near_row.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

constexpr double rounding = 1e-12, single = 1e-6;  // fields are stored in single precision

/// A floor whose second element is split into cells along slanted lines.
ElementTree tree_with_cells(const Stage& stage) {
    ElementTree tree = stage.make_elements({1e9, 0});
    const ElementId floor = tree.roots()[0];
    tree.split(floor, Cut::both);
    const ElementId second = tree.children(floor)[1];
    tree.split_by_line(second, {{0.6, 0.8}, 0.7});
    tree.split_by_line(tree.children(second)[0], {{0.8, -0.6}, 0.1});
    return tree;
}

TEST(LinkSites, ACellIsReplacedByAParallelogramWithItsAreaAndMoments) {
    const Scene scene = box_scene(1, 2, 3, 0.8, 1);
    const Stage stage(scene);
    const ElementTree tree = tree_with_cells(stage);
    const NodalBasis basis(HierarchyBasis::multiwavelet2);
    const LinkSites sites(stage, tree, basis);
    int cells = 0;
    for (ElementId e : tree.ids()) {
        if (!tree.is_cell(e)) continue;
        ++cells;
        // Mean of x y + 2 x^2 - y / 2 over the cell: by a fan of triangles, and from the four nodes.
        const auto f = [&](const Point& p) { return p.x * p.y + 2 * p.x * p.x - 0.5 * p.y; };
        const std::vector<Point> outline = tree.outline(e);
        double exact = 0, area = 0;
        for (std::size_t i = 2; i < outline.size(); ++i) {
            const Vec3 a = outline[i - 1] - outline[0], b = outline[i] - outline[0];
            for (const PlanarNode& node : triangle_rule(4))
                exact += 0.5 * norm(cross(a, b)) * node.weight * f(outline[0] + node.at.x * a + node.at.y * b);
            area += 0.5 * norm(cross(a, b));
        }
        double nodes = 0;
        for (std::size_t k = 0; k < sites.nodes(); ++k) nodes += sites.weight(e, k) * f(sites.node(e, k));
        EXPECT_NEAR(nodes, exact / area, rounding);
    }
    EXPECT_EQ(cells, 4);
}

TEST(NodalField, PullAndPushKeepLinearFunctionsOnRegularElementsAndCells) {
    const Scene scene = box_scene(1, 2, 3, 0.8, 1);
    const Stage stage(scene);
    const ElementTree tree = tree_with_cells(stage);
    for (const HierarchyBasis kind : {HierarchyBasis::multiwavelet2, HierarchyBasis::multiwavelet3}) {
        const NodalBasis basis(kind);
        const LinkSites sites(stage, tree, basis);
        const auto f = [&](const Point& p) { return 1 + p.x - 2 * p.y + p.z; };
        NodalField field(sites);
        for (ElementId e : tree.leaves())
            for (std::size_t k = 0; k < sites.nodes(); ++k) field.set_node(e, k, Spectrum(f(sites.node(e, k))));
        field.pull();
        for (ElementId e : tree.ids())
            for (std::size_t k = 0; k < sites.nodes(); ++k)
                if (sites.weight(e, k) > 0) {
                    EXPECT_NEAR(field.node(e, k)[0], f(sites.node(e, k)), 10 * single);
                }
        for (double r : field.roughness()) EXPECT_NEAR(r, 0, 10 * single);
    }
}

TEST(LinkSites, OpeningStepByStepEqualsHoldingAll) {
    const Scene scene = box_scene(1, 2, 3, 0.8, 1);
    const Stage stage(scene);
    const ElementTree tree = tree_with_cells(stage);
    for (const HierarchyBasis kind :
         {HierarchyBasis::haar, HierarchyBasis::multiwavelet2, HierarchyBasis::multiwavelet3}) {
        const NodalBasis basis(kind);
        const LinkSites all(stage, tree, basis);
        LinkSites some(stage, tree, basis, LinkSites::Held::roots);
        const auto f = [&](ElementId e) {
            NodalValues out{};
            for (std::size_t k = 0; k < all.nodes(); ++k) out[k] = Spectrum(std::exp(all.node(e, k).x));
            return out;
        };
        NodalField whole(all);
        for (ElementId e : tree.leaves()) whole.set(e, f(e));
        whole.pull();
        const Field<ElementId, double> roughness = whole.roughness();
        EXPECT_EQ(some.ends(), tree.roots());
        for (bool opened = true; opened;) {
            opened = false;
            for (ElementId end : some.ends()) {
                const FromBelow found = pull_from_leaves(some, end, f);
                EXPECT_NEAR(std::sqrt(found.departure_squared), roughness[end], single);
                for (std::size_t k = 0; k < all.nodes(); ++k)
                    EXPECT_NEAR(found.values[k][0], whole.node(end, k)[0], 2 * single * std::exp(1.0));
                if (tree.is_leaf(end)) continue;
                EXPECT_EQ(some.held_above(tree.children(end).front()), end);
                some.open(std::vector{end});
                opened = true;
            }
        }
        EXPECT_EQ(some.size(), tree.size());
        for (ElementId e : tree.ids()) {
            EXPECT_EQ(some.radius(e), all.radius(e));
            if (tree.parent(e).is_none()) continue;
            EXPECT_TRUE(std::ranges::equal(some.push(e), all.push(e)) && std::ranges::equal(some.pull(e), all.pull(e)));
        }
    }
}

TEST(NodalField, BelowHeldElementsIsTheFunctionOfTheNearestOne) {
    const Scene scene = box_scene(1, 2, 3, 0.8, 1);
    const Stage stage(scene);
    const ElementTree tree = tree_with_cells(stage);
    const NodalBasis basis(HierarchyBasis::multiwavelet3);
    const LinkSites sites(stage, tree, basis, LinkSites::Held::roots);
    const auto f = [](const Point& p) { return 1 + p.x * p.y - 2 * p.y * p.y + p.z; };
    NodalField field(sites);
    for (ElementId e : tree.roots())
        for (std::size_t k = 0; k < sites.nodes(); ++k) field.set_node(e, k, Spectrum(f(sites.node(e, k))));
    for (ElementId e : tree.leaves()) {
        const NodalValues values = field.values(e);
        for (std::size_t k = 0; k < sites.nodes(); ++k) EXPECT_NEAR(values[k][0], f(sites.node(e, k)), 10 * single);
    }
}

/// Points at all distances from a wall, down to its edge.
TEST(NearRow, SumsToTheFormFactorAndHasTheRightFirstMoments) {
    const Scene scene = box_scene(1, 1, 1, 0.8, 1);
    const Stage stage(scene);
    const ElementTree tree = stage.make_elements({1e9, 0});
    const NodalBasis basis(HierarchyBasis::multiwavelet2), fine(HierarchyBasis::multiwavelet3);
    const LinkSites sites(stage, tree, basis);
    NearRow row(sites);
    const ElementId floor = tree.roots()[0], wall = tree.roots()[2];
    row.set_source(wall);
    const std::vector<Point> outline = tree.outline(wall);
    for (const double distance : {0.9, 0.3, 0.1, 0.03, 0.01}) {
        const Point x{0.4, distance, 0};
        std::array<double, 9> K{};
        row(x, sites.normal(floor), K.data());
        double sum = 0, height = 0, exact_height = 0;
        for (std::size_t l = 0; l < sites.nodes(); ++l) sum += K[l], height += K[l] * sites.node(wall, l).z;
        EXPECT_NEAR(sum, point_to_polygon(x, sites.normal(floor), outline), 1e-12);
        // Reference: thin strips of the wall, each with its exact form factor.
        constexpr int strips = 400;
        const Patch frame = sites.frame(wall);
        const bool along_a = std::abs(frame.a.z) > 0.5;
        for (int i = 0; i < strips; ++i) {
            const double lo = static_cast<double>(i) / strips, hi = (i + 1.0) / strips;
            const auto at = [&](double s, double t) { return along_a ? frame.at(s, t) : frame.at(t, s); };
            std::vector<Point> strip = {at(lo, 0), at(hi, 0), at(hi, 1), at(lo, 1)};
            if (!along_a) std::reverse(strip.begin(), strip.end());
            exact_height += point_to_polygon(x, sites.normal(floor), strip) * 0.5 * (strip[0].z + strip[1].z);
        }
        // The last boxes are 1/32 of the wall, and their light is assumed to come from the centre.
        EXPECT_NEAR(height, exact_height, 3e-3 * sum) << distance;
    }
}

}  // namespace
}  // namespace exitance
