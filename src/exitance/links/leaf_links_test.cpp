#include "exitance/links/leaf_links.hpp"

#include <gtest/gtest.h>

#include "exitance/base/parallel.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "support/built_scene.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

constexpr HierarchyBasis orders[] = {HierarchyBasis::haar, HierarchyBasis::multiwavelet2,
                                     HierarchyBasis::multiwavelet3};

/// A scene whose elements reflect b(region, x), and the light that its leaves gather.
struct Gathered {
    Stage stage;
    ElementTree tree;
    NodalBasis basis;
    LinkSites sites;
    NodalField b, E;
    LeafLinks found;

    template <class Light>
    Gathered(const Scene& scene, HierarchyBasis kind, MeshSize size, double tolerance, const Light& light)
        : stage(scene),
          tree(stage.make_elements(size)),
          basis(kind),
          sites(stage, tree, basis),
          b(sites),
          E(sites),
          found(link(tolerance, light)) {
        found.links.gather(b, E);
    }

    template <class Light>
    LeafLinks link(double tolerance, const Light& light) {
        for (ElementId e : tree.leaves())
            for (std::size_t k = 0; k < sites.nodes(); ++k)
                b.set_node(e, k, Spectrum(light(tree.region(e), sites.node(e, k))));
        const StopRequest never;
        return link_leaves(sites, b, {.error = tolerance}, never);
    }

    /// RMS over `leaves` of the elements' functions minus exact(e, x), at 4 x 4 points each.
    template <class Function>
    double error(const std::vector<ElementId>& leaves, const Function& exact) const {
        double sum = 0, area = 0;
        std::array<double, 9> factor{};
        for (ElementId e : leaves)
            for (int i = 0; i < 16; ++i) {
                const Vec2 uv{(i % 4 + 0.5) / 4, (i / 4 + 0.5) / 4};
                basis.interpolate(tree.patch(e).shape, uv, std::span(factor).first(sites.nodes()));
                double value = -exact(e, tree.patch(e).at(uv));
                for (std::size_t k = 0; k < sites.nodes(); ++k) value += factor[k] * E.node(e, k)[0];
                sum += tree.area(e) * value * value, area += tree.area(e);
            }
        return std::sqrt(sum / area);
    }
};

/// Two plates of 1 m x 1 m that face each other, 1 m apart.
Scene two_plates() {
    return test::make({{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, {{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}}});
}

}  // namespace

TEST(LeafLinks, ConvergeWithTheOrderOfTheirElements) {
    const Scene plates = two_plates();
    for (std::size_t i = 0; i < 3; ++i) {
        std::array<double, 2> error{};
        for (std::size_t level = 0; level < 2; ++level) {
            const double edge = level == 0 ? 0.26 : 0.13;
            const Gathered g(plates, orders[i], {edge, 0}, 1e-9, [](RegionId, const Point&) { return 1.0; });
            error[level] = g.error(g.tree.leaves(), [&](ElementId e, const Point& x) {
                double sum = 0;
                for (ElementId q : g.tree.roots()) sum += point_to_polygon(x, g.sites.normal(e), g.tree.outline(q));
                return sum;
            });
        }
        // The error of functions of order M falls by 2^M if edges are halved; the coarser mesh is not quite asymptotic.
        const double rate = std::log2(error[0] / error[1]);
        EXPECT_NEAR(rate, static_cast<double>(i + 1), 0.15) << error[0] << " " << error[1];
    }
}

TEST(LeafLinks, GiveOneEverywhereInAClosedBoxOfUniformLight) {
    const Scene box = box_scene(1, 2, 3, 0.8, 1);
    for (const HierarchyBasis kind : orders) {
        const Gathered g(box, kind, {0.7, 2}, 1e-6, [](RegionId, const Point&) { return 1.0; });
        const double error = g.error(g.tree.leaves(), [](ElementId, const Point&) { return 1.0; });
        // A link's rule may be wrong by a fifth of the tolerance; about a hundred links add up.
        EXPECT_LT(error, 1e-4) << static_cast<int>(kind);
        EXPECT_EQ(g.found.open_share, 1);
    }
}

TEST(LeafLinks, AgreeWithExactLightBehindOccluders) {
    const Scene scene = built_scene("cornell");
    const RegionId lamp = scene.surfaces()[scene.emitters()[0]].region;
    const double M = scene.material(lamp).exitance[0];
    for (const HierarchyBasis kind : orders) {
        const Gathered lit(scene, kind, {0.2, 1}, 1e-4,
                           [&](RegionId region, const Point&) { return region == lamp ? 1.0 : 0.0; });
        DirectLight::Workspace workspace;
        double sum = 0, error = 0;
        for (ElementId e : lit.tree.leaves()) {
            if (max(scene.material(lit.tree.region(e)).reflectance) <= 0) continue;
            double exact = 0, found = 0;
            for (int i = 0; i < 16; ++i) {
                const Point x = lit.tree.patch(e).at(lit.tree.uniform(e, (i % 4 + 0.5) / 4, (i / 4 + 0.5) / 4));
                exact += lit.stage.direct.irradiance(x, lit.sites.normal(e), lit.tree.region(e), workspace)[0] / M / 16;
            }
            for (std::size_t k = 0; k < lit.sites.nodes(); ++k) found += lit.sites.weight(e, k) * lit.E.node(e, k)[0];
            sum += lit.tree.area(e) * exact * exact, error += lit.tree.area(e) * (found - exact) * (found - exact);
        }
        // RMS; 16 to 256 rays per pair in the penumbrae, which are a tenth of the lit area.
        EXPECT_LT(std::sqrt(error / sum), 0.05) << static_cast<int>(kind);
    }
}

TEST(LeafLinks, AreNotMadeAfterAStopRequest) {
    const Scene box = box_scene(1, 2, 3, 0.8, 1);
    const Gathered g(box, HierarchyBasis::multiwavelet2, {0.7, 0}, 1e-3, [](RegionId, const Point&) { return 1.0; });
    StopRequest stop;
    stop.interrupt();
    const LeafLinks stopped = link_leaves(g.sites, g.b, {.error = 1e-3}, stop);
    EXPECT_GT(g.found.links.size(), 0u);
    EXPECT_EQ(stopped.links.size(), 0u);
}

TEST(LeafLinks, DoNotDependOnTheNumberOfThreads) {
    const Scene scene = built_scene("cornell");
    std::vector<double> before;
    for (const int count : {1, 2}) {
        set_threads(count);
        const Gathered g(scene, HierarchyBasis::multiwavelet2, {0.3, 1}, 1e-3,
                         [](RegionId, const Point& x) { return 1 + x.z; });
        std::vector<double> now{static_cast<double>(g.found.rays), g.found.error, g.found.open_share};
        for (ElementId e : g.tree.leaves())
            for (std::size_t k = 0; k < g.sites.nodes(); ++k) now.push_back(g.E.node(e, k)[0]);
        if (count > 1) {
            EXPECT_EQ(now, before);
        }
        before = now;
    }
    set_threads(0);
}

}  // namespace exitance
