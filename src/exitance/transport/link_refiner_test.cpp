#include "exitance/transport/link_refiner.hpp"

#include <gtest/gtest.h>

#include "exitance/transport/form_factor.hpp"
#include "support/built_scene.hpp"
#include "support/lit_elements.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

struct Refined : LitElements {
    LinkRefiner refiner{tree, sites};

    Refined(const Scene& scene, HierarchyBasis kind)
        : LitElements(scene, kind, [](const Point& x) { return 1 + x.z; }) {}

    void refine(double tolerance) {
        Progress silent;
        StopRequest never;
        refiner.refine(b, {}, {.error = tolerance, .interpolation = tolerance, .least_area = 1e-6}, silent, never);
    }
    void scale_light(double factor) {
        for (ElementId e : tree.ids())
            for (std::size_t k = 0; k < sites.nodes(); ++k) b.set_node(e, k, factor * b.node(e, k));
    }
};

constexpr HierarchyBasis kinds[] = {HierarchyBasis::haar, HierarchyBasis::multiwavelet2, HierarchyBasis::multiwavelet3};

TEST(LinkRefiner, KeepsLinksThatAreGoodEnoughAndLetsThemGrowWithTheirLight) {
    const Scene scene = built_scene("cornell");
    for (const HierarchyBasis kind : kinds) {
        Refined r(scene, kind);
        r.refine(0.01);
        const std::size_t rays = r.refiner.rays(), links = r.refiner.size();
        const double light = r.refiner.light(), error = r.refiner.error();
        r.scale_light(2);
        r.refine(1);  // where all of them are good enough
        // Those alone are judged again whose source was cut after they were made.
        EXPECT_LT(static_cast<double>(r.refiner.rays() - rays), 0.01 * static_cast<double>(rays));
        EXPECT_EQ(r.refiner.size(), links);
        EXPECT_NEAR(r.refiner.light(), 2 * light, 1e-3 * light);
        EXPECT_NEAR(r.refiner.error(), 2 * error, 1e-3 * error);
    }
}

TEST(LinkRefiner, JudgesFewLinksAgainWhereToleranceFalls) {
    const Scene scene = built_scene("cornell");
    for (const HierarchyBasis kind : kinds) {
        Refined once(scene, kind), twice(scene, kind);
        once.refine(0.003);
        twice.refine(0.006);
        const std::size_t before = twice.refiner.rays();
        twice.refine(0.003);
        EXPECT_LT(twice.refiner.rays() - before, 0.8 * static_cast<double>(once.refiner.rays()));
        // What was kept is as good as what is judged from the beginning.
        EXPECT_LT(twice.refiner.error(), 1.15 * once.refiner.error());
    }
}

TEST(LinkRefiner, JudgesLinksOfASourceAgainWhoseLightHasAnotherShape) {
    const Scene scene = built_scene("cornell");
    Refined r(scene, HierarchyBasis::multiwavelet2);
    r.refine(0.01);
    const std::size_t rays = r.refiner.rays();
    for (ElementId e : r.tree.ids())
        for (std::size_t k = 0; k < r.sites.nodes(); ++k)
            r.b.set_node(e, k, Spectrum(1 + std::sin(9 * r.sites.node(e, k).x)));
    r.b.pull();
    r.refine(1);
    EXPECT_GT(r.refiner.rays(), rays);
}

/// What a small plate sends to the long strip that it stands on, between all of the strip's nodes, and to a strip that
/// it stands across, all of whose nodes lie behind it or far off.
TEST(LinkRefiner, SeesWhatShinesBetweenNodes) {
    const Scene along = test::make({{{{0, 0, 0}, {0.5, 0, 0}, {0.5, 0.001, 0}, {0, 0.001, 0}}},
                                    {{{0.24, 0, 0}, {0.24, 0, 0.02}, {0.26, 0, 0.02}, {0.26, 0, 0}}}});
    const Scene across = test::make({{{{0, 0, 0}, {0.4, 0, 0}, {0.4, 0.4, 0}, {0, 0.4, 0}}},
                                     {{{0.36, 0, 0}, {0.36, 0.4, 0}, {0.36, 0.4, 0.2}, {0.36, 0, 0.2}}}});
    for (const Scene* scene : {&along, &across})
        for (const HierarchyBasis kind : kinds) {
            Refined r(*scene, kind);
            Progress silent;
            StopRequest never;
            const double tolerance = 2e-4;
            r.refiner.refine(r.b, {}, {.error = tolerance, .interpolation = tolerance, .least_area = 1e-8}, silent,
                             never);
            NodalField E(r.sites);
            r.refiner.make_links().gather(r.b, E);
            E.push();
            // Sums over the leaves on the floor, and over points of them.
            double found = 0, expected = 0;
            for (ElementId e : r.tree.leaves()) {
                if (r.tree.region(e) != RegionId(0)) continue;
                found += r.tree.area(e) * E.mean(e)[0];
                constexpr int n = 16;
                for (int i = 0; i < n * n; ++i) {
                    const Point x = r.tree.patch(e).at((i % n + 0.5) / n, (i / n + 0.5) / n);
                    for (ElementId q : r.tree.roots())
                        if (r.tree.region(q) != RegionId(0))
                            expected += r.tree.area(e) / (n * n) * r.b.mean(q)[0] *
                                        point_to_polygon(x, r.sites.normal(e), r.tree.outline(q));
                }
            }
            EXPECT_NEAR(found, expected, 0.1 * expected) << static_cast<int>(kind);
        }
}

}  // namespace
}  // namespace exitance
