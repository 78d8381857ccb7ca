#include "exitance/methods/light/light_below.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/parallel.hpp"
#include "support/built_scene.hpp"
#include "support/lit_elements.hpp"

namespace exitance {
namespace {

TEST(LightBelow, EqualsTheLightOfAllLeaves) {
    const Scene scene = built_scene("cornell");
    const Stage stage(scene);
    const ElementTree tree = stage.make_elements({0.05, 0});
    const NodalBasis basis(HierarchyBasis::multiwavelet2);
    const LinkSites sites(stage, tree, basis, LinkSites::Held::roots);
    std::size_t read = 0;
    const auto of_leaf = [&](ElementId e) {
        ++read;
        NodalValues out{};
        for (std::size_t k = 0; k < sites.nodes(); ++k) out[k] = Spectrum(std::exp(sites.node(e, k).x));
        return out;
    };
    LightBelow below(sites, of_leaf);
    set_threads(1);
    const std::vector<FromBelow> found = below.look_at(tree.roots());
    EXPECT_EQ(read, tree.leaves().size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        const FromBelow all = pull_from_leaves(sites, tree.roots()[i], of_leaf);
        EXPECT_EQ(found[i].values, all.values);
        EXPECT_EQ(found[i].departure_squared, all.departure_squared);
        if (tree.is_leaf(tree.roots()[i])) continue;
        for (ElementId child : tree.children(tree.roots()[i])) {
            read = 0;
            EXPECT_EQ(below.at(child).values, pull_from_leaves(sites, child, of_leaf).values);
        }
    }
    read = 0;
    for (ElementId root : tree.roots()) below.at(root);
    EXPECT_LT(4 * read, tree.leaves().size()) << "what large elements come to is kept";
    set_threads(0);
}

}  // namespace
}  // namespace exitance
