#include "exitance/links/link_refiner.hpp"

#include <gtest/gtest.h>

#include "exitance/calibration/numbers.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "support/built_scene.hpp"
#include "support/lit_elements.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

struct Refined : LitElements {
    LinkRefiner refiner{tree, sites};

    Refined(const Scene& scene, HierarchyBasis kind, double by_height = 1)
        : LitElements(scene, kind, [by_height](const Point& x) { return 1 + by_height * x.z; }) {}

    void refine(double tolerance) {
        Progress silent;
        StopRequest never;
        refiner.refine(b, {}, {.error = tolerance, .interpolation = tolerance, .min_area = 1e-6}, silent, never);
    }
    void scale_light(double factor) {
        for (ElementId e : tree.ids())
            for (std::size_t k = 0; k < sites.nodes(); ++k) b.set_node(e, k, factor * b.node(e, k));
    }
};

constexpr HierarchyBasis kinds[] = {HierarchyBasis::haar, HierarchyBasis::multiwavelet2, HierarchyBasis::multiwavelet3};

TEST(LinkRefiner, KeepsAndScalesLinksThatAreGoodEnough) {
    const Scene scene = built_scene("cornell");
    for (const HierarchyBasis kind : kinds) {
        Refined r(scene, kind);
        r.refine(0.01);
        const std::size_t rays = r.refiner.rays(), links = r.refiner.size();
        const double light = r.refiner.light(), error = r.refiner.error();
        r.scale_light(2);
        r.refine(1);  // at this accuracy all links are accepted
        // Only links whose source was split after they were made are judged again.
        EXPECT_LT(static_cast<double>(r.refiner.rays() - rays), 0.01 * static_cast<double>(rays));
        EXPECT_EQ(r.refiner.size(), links);
        EXPECT_NEAR(r.refiner.light(), 2 * light, 1e-3 * light);
        EXPECT_NEAR(r.refiner.error(), 2 * error, 1e-3 * error);
    }
}

TEST(LinkRefiner, JudgesFewLinksAgainIfTheToleranceFalls) {
    const Scene scene = built_scene("cornell");
    for (const HierarchyBasis kind : kinds) {
        Refined once(scene, kind), twice(scene, kind);
        once.refine(0.003);
        twice.refine(0.006);
        const std::size_t before = twice.refiner.rays();
        twice.refine(0.003);
        EXPECT_LT(twice.refiner.rays() - before, 0.8 * static_cast<double>(once.refiner.rays()));
        // A link is kept while its error is at most this share of its new tolerance, even where judging it again would
        // replace it by links without error.
        EXPECT_LT(twice.refiner.error(), (1 + calibrated::kept_link_share) * once.refiner.error());
    }
}

TEST(LinkRefiner, JudgesLinksAgainIfTheirSourcesLightChangesShape) {
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

/// Difference between the light of links on the first polygon of a scene and the uniform light that all others emit to
/// it: error of the mean, and RMS error.
struct Difference {
    double mean = 0, rms = 0;  ///< Relative to the exact mean and to the exact RMS.
};

Difference on_first_polygon(const Scene& scene, HierarchyBasis kind, double tolerance) {
    Refined r(scene, kind, 0);
    Progress silent;
    StopRequest never;
    r.refiner.refine(r.b, {}, {.error = tolerance, .interpolation = tolerance, .min_area = 1e-8}, silent, never);
    NodalField E(r.sites);
    r.refiner.make_links().gather(r.b, E);
    E.push();
    std::vector<double> factors(r.sites.nodes());
    double found = 0, expected = 0, square = 0, expected_square = 0;
    for (ElementId e : r.tree.leaves()) {
        if (r.tree.region(e) != RegionId(0)) continue;
        constexpr int n = 16;
        const Patch& patch = r.tree.patch(e);
        for (int i = 0; i < n * n; ++i) {
            const Vec2 uv{(i % n + 0.5) / n, (i / n + 0.5) / n};
            r.basis.interpolate(patch.shape, uv, factors);
            double here = 0, right = 0;
            for (std::size_t k = 0; k < factors.size(); ++k) here += factors[k] * E.node(e, k)[0];
            for (ElementId q : r.tree.roots())
                if (r.tree.region(q) != RegionId(0))
                    right += r.b.mean(q)[0] * point_to_polygon(patch.at(uv), r.sites.normal(e), r.tree.outline(q));
            const double dA = r.tree.area(e) / (n * n);
            found += dA * here, expected += dA * right;
            square += dA * (here - right) * (here - right), expected_square += dA * right * right;
        }
    }
    return {found / expected - 1, std::sqrt(square / expected_square)};
}

/// Light between all of a receiver's nodes: a small plate on a long strip; a plate across a strip whose nodes are all
/// behind it or distant; and a low plate on a floor.
TEST(LinkRefiner, DetectsLightBetweenNodes) {
    const Scene along = test::make({{{{0, 0, 0}, {0.5, 0, 0}, {0.5, 0.001, 0}, {0, 0.001, 0}}},
                                    {{{0.24, 0, 0}, {0.24, 0, 0.02}, {0.26, 0, 0.02}, {0.26, 0, 0}}}});
    const Scene across = test::make({{{{0, 0, 0}, {0.4, 0, 0}, {0.4, 0.4, 0}, {0, 0.4, 0}}},
                                     {{{0.36, 0, 0}, {0.36, 0.4, 0}, {0.36, 0.4, 0.2}, {0.36, 0, 0.2}}}});
    const Scene low = test::make({{{{0, 0, 0}, {0.4, 0, 0}, {0.4, 0.4, 0}, {0, 0.4, 0}}},
                                  {{{0, 0, 0}, {0, 0, 0.001}, {0.4, 0, 0.001}, {0.4, 0, 0}}}});
    for (const HierarchyBasis kind : kinds) {
        EXPECT_NEAR(on_first_polygon(along, kind, 2e-4).mean, 0, 0.1) << static_cast<int>(kind);
        EXPECT_NEAR(on_first_polygon(across, kind, 2e-4).mean, 0, 0.1) << static_cast<int>(kind);
        EXPECT_NEAR(on_first_polygon(low, kind, 2e-5).mean, 0, 0.1) << static_cast<int>(kind);
    }
}

/// A wall next to a strip that extends a little beyond the wall and beyond the strip's last nodes.
TEST(LinkRefiner, DetectsEndsOfSources) {
    const Scene beside = test::make({{{{0, 0, 0}, {0.4, 0, 0}, {0.4, 0.02, 0}, {0, 0.02, 0}}},
                                     {{{0, 0, 0}, {0, 0, 0.2}, {0.38, 0, 0.2}, {0.38, 0, 0}}}});
    for (const HierarchyBasis kind : {HierarchyBasis::multiwavelet2, HierarchyBasis::multiwavelet3})
        EXPECT_LT(on_first_polygon(beside, kind, 5e-4).rms, 0.05) << static_cast<int>(kind);
}

}  // namespace
}  // namespace exitance
