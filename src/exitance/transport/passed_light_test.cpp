// Tests of light through diffusing panes whose sides have different meshes.
#include "exitance/transport/passed_light.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"
#include "exitance/basis/nodal_basis.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

constexpr double through = 0.25;

/// A pane of 2 x 1 m in the plane z = 0, with both sides visible.
Scene sheet() {
    SceneDescription d;
    d.file = "sheet.obj";
    d.materials = {{"opal", Spectrum(0.8), {}, {}, through}};
    d.groups = {"all"};
    d.points = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}};
    CheckedScene checked = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

/// Meshes of the two sides: the first is split into halves and quarters, the second along slanted lines.
ElementTree cut_unlike(const Scene& scene) {
    ElementTree tree;
    for (const RegionId r : scene.regions().ids()) {
        const auto& loop = scene.regions()[r].loops[0];
        tree.add_root(r, {loop[0], loop[1] - loop[0], loop[3] - loop[0]});
    }
    tree.split(ElementId(0), Cut::u, 0.5);
    tree.split(tree.children(ElementId(0)).front(), Cut::both, 0.5);
    const ElementId cells = tree.split_by_line(ElementId(1), {{0.8, 0.6}, 0.6});
    tree.split_by_line(cells, {{-0.3, 0.9}, 0.2});
    return tree;
}

}  // namespace

TEST(PassedLight, ConservesFluxBetweenDifferentMeshes) {
    const Scene scene = sheet();
    const ElementTree tree = cut_unlike(scene);
    const std::vector<ElementId> leaves = tree.leaves();
    const PassedLight passed(scene, tree, leaves);
    std::vector<Spectrum> E;
    RandomStream random(1, Stream::mesh);
    double arrived = 0, met = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        E.emplace_back(random.uniform());
        arrived += tree.area(leaves[i]) * E[i][0];
        double sum = 0;
        passed.visit_behind(i, [&](std::size_t, double weight) { sum += weight; });
        EXPECT_NEAR(sum, 1, 1e-12);
    }
    const std::vector<Spectrum> before = E;
    passed.meet(std::span(E));
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        met += tree.area(leaves[i]) * E[i][0];
        EXPECT_EQ(passed.met_at(i, [&](std::size_t k) { return before[k]; })[0], E[i][0]);
    }
    EXPECT_NEAR(met, arrived, 1e-12);
}

/// A polynomial on each side is represented exactly by both meshes.
TEST(PassedLight, IsExactForPolynomials) {
    const Scene scene = sheet();
    ElementTree tree;
    for (const RegionId r : scene.regions().ids()) {
        const auto& loop = scene.regions()[r].loops[0];
        tree.add_root(r, {loop[0], loop[1] - loop[0], loop[3] - loop[0]});
    }
    tree.split(ElementId(0), Cut::both, 0.5);
    tree.split(tree.children(ElementId(0)).front(), Cut::v, 0.3);
    tree.split(ElementId(1), Cut::u, 0.4);
    const std::vector<ElementId> leaves = tree.leaves();
    for (const HierarchyBasis kind : {HierarchyBasis::multiwavelet2, HierarchyBasis::multiwavelet3}) {
        const NodalBasis basis(kind);
        const std::size_t n = basis.count();
        const PassedLight passed(scene, tree, leaves, n, basis.order() - 1,
                                 [&](ElementId e, const Point& x, std::span<double> factors) {
                                     basis.interpolate(tree.patch(e).shape, tree.patch(e).coordinates(x), factors);
                                 });
        const auto on_side = [&](ElementId e, const Point& x) {  // bilinear, different on each side
            return tree.region(e).value == 0 ? 1 + x.x + 2 * x.y - x.x * x.y : 3 - x.x + 0.5 * x.x * x.y;
        };
        std::vector<Spectrum> E;
        std::vector<double> exact;
        for (const ElementId e : leaves)
            for (const PlanarNode& node : basis.nodes(tree.patch(e).shape)) {
                const Point x = tree.patch(e).at(node.at);
                const ElementId other(1 - tree.region(e).value);
                E.emplace_back(on_side(e, x));
                exact.push_back((1 - through) * on_side(e, x) + through * on_side(other, x));
            }
        passed.meet(std::span(E));
        for (std::size_t i = 0; i < E.size(); ++i) EXPECT_NEAR(E[i][0], exact[i], 1e-9) << i;
    }
}

TEST(PassedLight, IsEmptyInASceneWithoutPanes) {
    SceneDescription d;
    d.file = "face.obj";
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.groups = {"all"};
    d.points = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}};
    const CheckedScene checked = make_scene(std::move(d));
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}});
    const PassedLight passed(*checked.scene, tree, tree.leaves());
    EXPECT_TRUE(passed.empty());
    EXPECT_EQ(passed.met_at(0, [](std::size_t) { return Spectrum(3); })[0], 3);
}

}  // namespace exitance
