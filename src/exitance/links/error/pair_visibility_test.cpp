#include "exitance/links/error/pair_visibility.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/lit_elements.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// Two plates of 1 m x 1 m that face each other, 1 m apart, and halfway between them a third one over the half x < 0.5.
Scene half_covered_plates() {
    return test::make({{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
                       {{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}},
                       {{{0, 0, 0.5}, {0, 1, 0.5}, {0.5, 1, 0.5}, {0.5, 0, 0.5}}}});
}

struct Plates : LitElements {
    explicit Plates(const Scene& scene, HierarchyBasis kind)
        : LitElements(scene, kind, [](const Point&) { return 1.0; }) {}
    ElementId lower = tree.roots()[0], upper = tree.roots()[1];
};

TEST(PairVisibility, IsOneHalfForHalfCoveredPlates) {
    const Scene scene = half_covered_plates();
    const Plates plates(scene, HierarchyBasis::haar);
    PairVisibility visible(plates.sites, false, 1);
    // A ray passes if the mean of its ends' x is above 0.5: half of all pairs of points.
    const double error = visible.look(plates.lower, plates.upper, 1024);
    EXPECT_NEAR(visible.share(0), 0.5, 3 * error);
    EXPECT_NEAR(error, std::sqrt(0.25 / 1024), 1e-4);
    EXPECT_EQ(visible.rays(), 1024u);
}

TEST(PairVisibility, ByNodeIsExactPerPairOfNodes) {
    const Scene scene = half_covered_plates();
    const Plates plates(scene, HierarchyBasis::multiwavelet2);
    PairVisibility visible(plates.sites, true, 1);
    visible.look_by_node(plates.lower, plates.upper, 1, false);
    const LinkSites& sites = plates.sites;
    for (std::size_t k = 0; k < sites.nodes(); ++k)
        for (std::size_t l = 0; l < sites.nodes(); ++l) {
            const double x = 0.5 * (sites.node(plates.lower, k).x + sites.node(plates.upper, l).x);
            if (std::abs(x - 0.5) < 1e-6) continue;  // the line passes through the edge: either result is valid
            EXPECT_EQ(visible.share(k * sites.nodes() + l), x > 0.5 ? 1 : 0) << k << " " << l;
        }
}

/// A floor split along a line, with a lid over one side, and a ceiling: the other side sees all of it.
TEST(PairVisibility, RaysOfACellStartInsideIt) {
    const Scene scene = test::make({{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
                                    {{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}},
                                    {{{0.75, 0, 1e-9}, {1, 0, 1e-9}, {1, 1, 1e-9}, {0, 1, 1e-9}, {0, 0.5625, 1e-9}}}});
    const Stage stage(scene);
    ElementTree tree;
    const ElementId floor = tree.add_root(RegionId(0), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
                    ceiling = tree.add_root(RegionId(1), {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}),
                    cell = tree.split_by_line(floor, {{0.6, 0.8}, 0.45});
    ASSERT_TRUE(tree.is_cell(cell));
    for (const HierarchyBasis kind : {HierarchyBasis::multiwavelet2, HierarchyBasis::multiwavelet3}) {
        const NodalBasis basis(kind);
        const LinkSites sites(stage, tree, basis);
        PairVisibility visible(sites, false, 1);
        visible.look_by_node(cell, ceiling, 16, false);
        for (std::size_t i = 0; i < sites.nodes() * sites.nodes(); ++i) EXPECT_EQ(visible.share(i), 1) << i;
    }
}

}  // namespace
}  // namespace exitance
