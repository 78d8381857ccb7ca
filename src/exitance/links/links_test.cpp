#include "exitance/links/links.hpp"

#include <gtest/gtest.h>

#include "exitance/base/parallel.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/links/link_refiner.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "support/built_scene.hpp"
#include "support/lit_elements.hpp"

namespace exitance {
namespace {

constexpr HierarchyBasis all_kinds[] = {HierarchyBasis::haar, HierarchyBasis::flatlet2, HierarchyBasis::flatlet3,
                                        HierarchyBasis::multiwavelet2, HierarchyBasis::multiwavelet3};

/// Links of a scene whose elements reflect b(x), refined until each error is below `tolerance`.
struct Linked : LitElements {
    LinkRefiner refiner;

    template <class Light>
    Linked(const Scene& scene, HierarchyBasis kind, double tolerance, const Light& light, bool constants = false)
        : LitElements(scene, kind, light), refiner(tree, sites) {
        Progress silent;
        StopRequest never;
        refiner.refine(b, {},
                       {.error = tolerance, .interpolation = tolerance, .min_area = 1e-6, .corrected = constants},
                       silent, never);
    }

    NodalField gathered() const {
        NodalField E(sites);
        refiner.make_links().gather(b, E);
        E.push();
        return E;
    }
    /// RMS over the surfaces of E - expected(x).
    template <class Light>
    double error(const Light& expected) const {
        const NodalField E = gathered();
        double sum = 0;
        for (ElementId e : tree.leaves())
            for (std::size_t k = 0; k < sites.nodes(); ++k) {
                const double d = E.node(e, k)[0] - expected(e, sites.node(e, k));
                sum += tree.area(e) * sites.weight(e, k) * d * d;
            }
        return std::sqrt(sum / stage.area);
    }
    /// Error estimate of the links, as a mean over the surfaces of reflectance `rho`.
    double estimate(double rho) const { return refiner.error() / std::sqrt(stage.area) / rho; }
};

TEST(Links, GiveOneEverywhereInAClosedBoxOfUniformLight) {
    const Scene box = box_scene(1, 2, 3, 0.8, 1);
    for (const HierarchyBasis kind : all_kinds) {
        const Linked linked(box, kind, 0.01, [](const Point&) { return 1.0; });
        const double error = linked.error([](ElementId, const Point&) { return 1.0; });
        // The errors of parts cancel in the whole, so the estimate is only required to be an upper bound of the right
        // order.
        // blocks are stored in single precision
        EXPECT_LT(error, 1.5 * linked.estimate(0.8) + 1e-7) << static_cast<int>(kind);
        EXPECT_LT(error, kind == HierarchyBasis::haar ? 0.03 : 0.01) << static_cast<int>(kind);
        EXPECT_EQ(linked.refiner.open_light(), linked.refiner.light()) << static_cast<int>(kind);
    }
}

/// Light that decreases along a tube, compared with the sum over all leaves.
TEST(Links, AgreeWithTheSumOverAllLeavesWithinTheirEstimate) {
    const Scene box = box_scene(1, 1, 4, 0.8, 1);
    const auto light = [](const Point& x) { return std::exp(-x.z); };
    for (const HierarchyBasis kind : {HierarchyBasis::multiwavelet2, HierarchyBasis::multiwavelet3}) {
        for (const double tolerance : {0.003, 0.0006}) {
            const Linked linked(box, kind, tolerance, light);
            NearRow row(linked.sites);
            const auto exact = [&](ElementId e, const Point& x) {
                double sum = 0;
                for (ElementId q : linked.tree.leaves()) {
                    if (linked.tree.region(q) == linked.tree.region(e)) continue;
                    std::array<double, 9> share;
                    row.set_source(q);
                    row(x, linked.sites.normal(e), share.data());
                    for (std::size_t l = 0; l < linked.sites.nodes(); ++l) sum += share[l] * linked.b.node(q, l)[0];
                }
                return sum;
            };
            EXPECT_LT(linked.error(exact), 2 * linked.estimate(0.8)) << static_cast<int>(kind) << " " << tolerance;
        }
    }
}

TEST(Links, HigherOrdersNeedFewerLinks) {
    const Scene box = box_scene(1, 1, 4, 0.8, 1);
    const auto light = [](const Point& x) { return std::exp(-x.z); };
    std::array<std::size_t, 3> count{};
    std::size_t i = 0;
    for (const HierarchyBasis kind :
         {HierarchyBasis::haar, HierarchyBasis::multiwavelet2, HierarchyBasis::multiwavelet3})
        count[i++] = Linked(box, kind, 0.002, light).refiner.size();
    EXPECT_LT(count[1], count[0] / 5);
    EXPECT_LT(count[2], count[1]);
}

TEST(Links, GatherAgreesWithTheListedFormFactors) {
    const Scene scene = built_scene("cornell");
    for (const HierarchyBasis kind : all_kinds) {
        const Linked linked(
            scene, kind, 0.003, [](const Point&) { return 1.0; }, true);
        const Links links = linked.refiner.make_links();
        NodalField E(linked.sites);
        links.gather(linked.b, E);
        Field<ElementId, double> listed(linked.tree.size(), 0.0);
        for (const KeptLink& link : links.list()) listed[link.receiver] += static_cast<double>(link.form_factor);
        for (ElementId e : linked.tree.ids()) {
            double mean = 0;
            for (std::size_t k = 0; k < linked.sites.nodes(); ++k) mean += linked.sites.weight(e, k) * E.node(e, k)[0];
            // Sums of a few hundred floats; the list's kernels are double.
            EXPECT_NEAR(mean, listed[e], 3e-6 * std::max(listed[e], 0.01)) << static_cast<int>(kind);
        }
    }
}

/// The error of a rule has the same sign all over a wall, and would accumulate with every reflection.
TEST(Links, UniformLightHasTheExactMeanOverAReceiver) {
    const Scene box = box_scene(1, 1, 4, 0.8, 1);
    for (const HierarchyBasis kind : all_kinds) {
        const Linked linked(box, kind, 0.01, [](const Point& x) { return std::exp(-x.z); });
        const LinkSites& sites = linked.sites;
        for (const KeptLink& link : linked.refiner.make_links().list()) {
            if (sites.nodes() == 1) continue;  // constant links store means over points other than the nodes
            double exact = 0;
            for (std::size_t k = 0; k < sites.nodes(); ++k)
                exact += sites.weight(link.receiver, k) * point_to_polygon(sites.node(link.receiver, k),
                                                                           sites.normal(link.receiver),
                                                                           linked.tree.outline(link.source));
            // Links are scaled if they may be wrong by 1e-5; blocks and scales are floats.
            EXPECT_NEAR(link.form_factor, exact, 2e-5 * exact + 1e-9) << static_cast<int>(kind);
        }
    }
}

/// Links with a small contribution are constants even at higher orders: less is stored and read for the same light.
TEST(Links, WeakLinksOfHigherOrdersAreConstants) {
    const Scene scene = built_scene("cornell");
    const auto light = [](const Point& x) { return 1 + std::sin(3 * x.x); };
    for (const HierarchyBasis kind : {HierarchyBasis::multiwavelet2, HierarchyBasis::multiwavelet3}) {
        const Linked pure(scene, kind, 0.03, light), mixed(scene, kind, 0.03, light, true);
        const Links links = mixed.refiner.make_links();
        EXPECT_LT(links.memory_bytes(), pure.refiner.make_links().memory_bytes()) << static_cast<int>(kind);
        EXPECT_LT(3 * mixed.refiner.form_factors(), 2 * pure.refiner.form_factors()) << static_cast<int>(kind);
        const NodalField E = pure.gathered();
        // Elements may be split differently: E of one is evaluated at the nodes of the other.
        const ElementLocator locator(pure.tree, pure.stage.scene.regions().size());
        const double apart = mixed.error([&](ElementId e, const Point& x) {
            const ElementTree::Place at = locator.find(pure.tree.region(e), x);
            std::array<double, 9> factors{};
            pure.basis.interpolate(pure.tree.patch(at.element).shape, at.uv, factors);
            double value = 0;
            for (std::size_t k = 0; k < pure.sites.nodes(); ++k) value += factors[k] * E.node(at.element, k)[0];
            return value;
        });
        EXPECT_LT(apart, 1.5 * std::hypot(pure.estimate(0.75), mixed.estimate(0.75))) << static_cast<int>(kind);
        EXPECT_GT(apart, 0);
    }
}

/// Most links between near elements contribute little, and their kernel is recomputed. The error of that is included in
/// the links' error and is small relative to the tolerance.
TEST(Links, StoreBlocksOnlyForSignificantLight) {
    const Scene scene = built_scene("cornell");
    const Linked linked(scene, HierarchyBasis::multiwavelet3, 0.05, [](const Point&) { return 1.0; });
    const Links links = linked.refiner.make_links();
    // 20 bytes per link, and 324 for one link in six.
    EXPECT_LT(links.memory_bytes(), 75 * links.size());
    const Scene box = box_scene(1, 1, 1, 0.8, 1);
    const Linked even(box, HierarchyBasis::multiwavelet3, 0.5, [](const Point&) { return 1.0; });
    EXPECT_LT(even.error([](ElementId, const Point&) { return 1.0; }), 1.5 * even.estimate(0.8) + 1e-7);
}

/// Below the elements that links touch, receivers get the same light, and sources act as a whole.
TEST(LinkOperator, OnTheLinkedPartAgreesWithThatOnAllLeaves) {
    const Scene scene = built_scene("cornell");
    for (const HierarchyBasis kind : all_kinds) {
        const Linked linked(scene, kind, 0.05, [](const Point& x) { return 1 + x.z + x.x * x.y; });
        const LinkSites& sites = linked.sites;
        const Links links = linked.refiner.make_links();
        const ElementPart all{sites.inner(), linked.tree.leaves()}, part = linked_part(sites, links, nullptr);
        EXPECT_LT(part.ends.size(), all.ends.size()) << static_cast<int>(kind);
        NodalField E[] = {NodalField(sites), NodalField(sites)};
        for (const ElementPart* of : {&all, &part}) {
            const LinkOperator F(sites, links, nullptr, *of);
            std::vector<Spectrum> b, irradiance(F.size());
            for (ElementId e : of->ends)
                for (std::size_t k = 0; k < sites.nodes(); ++k) b.push_back(linked.b.node(e, k));
            F.gather(b, irradiance);
            NodalField& out = E[of == &part];
            for (std::size_t i = 0; i < irradiance.size(); ++i)
                out.set_node(of->ends[i / sites.nodes()], i % sites.nodes(), irradiance[i]);
            out.push();
        }
        for (ElementId e : all.ends)  // single precision in the gather may round differently
            for (std::size_t k = 0; k < sites.nodes(); ++k)
                EXPECT_NEAR(E[1].node(e, k)[0], E[0].node(e, k)[0], 1e-6) << static_cast<int>(kind);
    }
}

TEST(Links, DoNotDependOnTheNumberOfThreads) {
    const Scene scene = built_scene("cornell");
    std::vector<double> before;
    for (const int count : {1, 2}) {
        set_threads(count);
        const Linked linked(scene, HierarchyBasis::multiwavelet2, 0.003, [](const Point& x) { return 1 + x.z; });
        const NodalField E = linked.gathered();
        std::vector<double> now{static_cast<double>(linked.refiner.size()), static_cast<double>(linked.tree.size())};
        for (ElementId e : linked.tree.leaves())
            for (std::size_t k = 0; k < linked.sites.nodes(); ++k) now.push_back(E.node(e, k)[0]);
        if (count > 1) {
            EXPECT_EQ(now, before);
        }
        before = now;
    }
    set_threads(0);
}

TEST(Links, DoNotLeakThroughAThinWall) {
    // Two rooms side by side, separated by 1 mm of wall; light in one of them only.
    SceneDescription d;
    d.file = "rooms.obj";
    d.materials = {{"wall", Spectrum(0.8), Spectrum()}, {"lamp", Spectrum(0.8), Spectrum(1.0)}};
    d.groups = {"rooms"};
    for (const double y : {0.0, 2.001}) {
        const auto first = static_cast<std::uint32_t>(d.points.size());
        for (const double z : {0.0, 2.0})
            d.points.insert(d.points.end(), {{0, y, z}, {2, y, z}, {2, y + 2, z}, {0, y + 2, z}});
        const std::vector<std::vector<std::uint32_t>> faces = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                                               {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
        for (std::size_t i = 0; i < faces.size(); ++i) {
            std::vector<std::uint32_t> corners = faces[i];
            for (std::uint32_t& c : corners) c += first;
            d.faces.push_back({corners, y == 0 && i == 1 ? 1u : 0u, 0, static_cast<int>(i + 1)});
        }
    }
    CheckedScene checked = make_scene(std::move(d));
    ASSERT_TRUE(checked.scene);
    for (const HierarchyBasis kind : {HierarchyBasis::haar, HierarchyBasis::multiwavelet2}) {
        const Linked linked(*checked.scene, kind, 0.01, [](const Point& x) { return x.y < 2.0005 ? 1.0 : 0.0; });
        const NodalField E = linked.gathered();
        for (ElementId e : linked.tree.leaves())
            for (std::size_t k = 0; k < linked.sites.nodes(); ++k)
                if (linked.sites.node(e, k).y > 2.0005) {
                    EXPECT_LT(E.node(e, k)[0], 1e-6) << static_cast<int>(kind);
                }
    }
}

}  // namespace
}  // namespace exitance
