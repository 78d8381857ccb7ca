#include "exitance/transport/link_refiner.hpp"

#include <gtest/gtest.h>

#include "support/built_scene.hpp"
#include "support/lit_elements.hpp"

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

}  // namespace
}  // namespace exitance
