#include "exitance/links/ray_links.hpp"

#include <gtest/gtest.h>

#include "exitance/base/parallel.hpp"
#include "exitance/transport/open_share.hpp"
#include "support/built_scene.hpp"
#include "support/lit_elements.hpp"

namespace exitance {
namespace {

struct Kept {
    Scene scene;
};

/// Elements of a scene that reflect b(x), with rows of 32 rays each.
struct Rows : Kept, LitElements {
    LeafNumbering numbering{tree};
    ElementLocator locator{tree, stage.scene.regions().size()};
    NumberedLeaves numbered{tree, numbering, locator};
    RayRows rows{stage, numbered, {{.average = 32, .min = 8, .max = 256}, 1, Dealing::by_piece}};

    template <class Light>
    Rows(Scene given, const Light& light) : Kept{std::move(given)}, LitElements(scene, HierarchyBasis::haar, light) {}

    Links links(double allowed) const { return link_by_rays(sites, numbering, rows, b, allowed); }
    /// Returns the irradiance E that the links bring to each leaf.
    std::vector<double> over(const Links& links) const {
        NodalField E(sites);
        links.gather(b, E);
        E.push();
        std::vector<double> out;
        for (ElementId e : numbering.leaves) out.push_back(E.node(e, 0)[0]);
        return out;
    }
    std::vector<double> by_rays() const {
        std::vector<Spectrum> light;
        for (ElementId e : numbering.leaves) light.push_back(b.node(e, 0));
        std::vector<double> out;
        for (std::size_t i = 0; i < light.size(); ++i) out.push_back(rows.gather_at(i, light)[0]);
        return out;
    }
};

double uneven(const Point& x) {
    return 1 + x.z + 0.3 * std::sin(7 * x.x);
}

TEST(RayLinks, SumToOneAtEveryLeafOfAClosedScene) {
    const Rows box(box_scene(1, 2, 3, 0.5, 1), uneven);
    for (const double allowed : {0.0, 0.01, 1.0}) {
        Field<ElementId, double> sum(box.tree.size(), 0.0);
        for (const KeptLink& link : box.links(allowed).list())
            sum[link.receiver] += static_cast<double>(link.form_factor);
        // entries are multiples of 1/256 in single precision
        for (ElementId e : box.numbering.leaves) EXPECT_NEAR(sum[e], 1, 1e-6);
    }
}

TEST(RayLinks, AgreeWithRaysIfNoErrorIsAllowed) {
    const Rows scene(built_scene("cornell"), uneven);
    const std::vector<double> by_links = scene.over(scene.links(0)), by_rays = scene.by_rays();
    // sums in single precision
    for (std::size_t i = 0; i < by_rays.size(); ++i) EXPECT_NEAR(by_links[i], by_rays[i], 1e-6);
}

TEST(RayLinks, LeadToLargerSourcesWithinTheAllowedError) {
    const Rows scene(built_scene("cornell"), uneven);
    const std::vector<double> by_rays = scene.by_rays();
    std::size_t before = scene.links(0).size();
    for (const double allowed : {0.001, 0.003, 0.01}) {
        const Links links = scene.links(allowed);
        EXPECT_LT(links.size(), before);
        before = links.size();
        const std::vector<double> by_links = scene.over(links);
        double squares = 0;
        for (std::size_t i = 0; i < by_rays.size(); ++i) {
            const ElementId e = scene.numbering.leaves[i];
            const double rho = mean(scene.stage.scene.material(scene.tree.region(e)).reflectance);
            squares += scene.tree.area(e) * std::pow(rho * (by_links[i] - by_rays[i]), 2);
        }
        // Each link has at most its share; errors of a source and of its neighbours do not all cancel.
        EXPECT_LT(std::sqrt(squares), 1.5 * allowed * std::sqrt(static_cast<double>(links.size()))) << allowed;
        EXPECT_GT(squares, 0);
    }
}

TEST(RayLinks, DoNotDependOnTheNumberOfThreads) {
    const Rows scene(built_scene("cornell"), uneven);
    set_threads(1);
    const std::vector<KeptLink> once = scene.links(0.003).list();
    set_threads(3);
    const std::vector<KeptLink> again = scene.links(0.003).list();
    set_threads(0);
    ASSERT_EQ(once.size(), again.size());
    for (std::size_t i = 0; i < once.size(); ++i) {
        EXPECT_EQ(once[i].source, again[i].source);
        EXPECT_EQ(once[i].form_factor, again[i].form_factor);
    }
}

TEST(OpenShare, IsOneWithoutOccludersAndSmallInARoomWithBoxes) {
    const auto share = [](Scene scene) {
        const Rows r(std::move(scene), [](const Point&) { return 1.0; });
        const std::vector<Spectrum> even(r.numbering.leaves.size(), Spectrum(1.0));
        return open_share(r.stage, r.numbered, even, 1);
    };
    EXPECT_EQ(share(box_scene(1, 2, 3, 0.5, 1)), 1);
    const auto mostly = [](Scene scene) {
        const Rows r(std::move(scene), [](const Point&) { return 1.0; });
        const std::vector<Spectrum> even(r.numbering.leaves.size(), Spectrum(1.0));
        return is_mostly_open(r.stage, r.numbered, even, 1);
    };
    EXPECT_TRUE(mostly(box_scene(1, 2, 3, 0.5, 1)));
    EXPECT_FALSE(mostly(built_scene("cornell")));
    const double cornell = share(built_scene("cornell"));
    EXPECT_GT(cornell, 0.1) << "ceiling and walls see each other over the boxes";
    EXPECT_LT(cornell, 0.6) << "the floor sees nothing whole";
}

TEST(IsClosed, DistinguishesABoxFromAnOpenRoom) {
    const auto closed = [](Scene scene) {
        const Rows r(std::move(scene), [](const Point&) { return 1.0; });
        return is_closed(r.stage, r.numbered, 1);
    };
    EXPECT_TRUE(closed(box_scene(1, 2, 3, 0.5, 1)));
    EXPECT_FALSE(closed(built_scene("spiral")));
}

}  // namespace
}  // namespace exitance
