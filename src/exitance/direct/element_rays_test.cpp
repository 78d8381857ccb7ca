// Light of emitters that contribute little to an element, by rays from the element, compared with exact light.
#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/sanitizers.hpp"
#include "exitance/direct/ray_light.hpp"
#include "exitance/transport/direct_fit.hpp"
#include "support/built_scene.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A scene, and light on its elements.
struct Lit {
    explicit Lit(Scene s) : scene(std::move(s)), stage(scene) {}

    double exact(const ElementTree& tree, ElementId e) { return mean(fit_direct_light(stage, tree, e, 0, room).mean); }
    RayLight::ElementEstimate by_rays(const ElementTree& tree, ElementId e, double weight, double allowed,
                                      std::uint32_t rays) {
        return stage.place_light.rays().on_element(tree, e, Spectrum(weight), allowed, rays, room.place);
    }

    Scene scene;
    Stage stage;
    DirectFitRoom room;
};

/// Four furnished rooms with doors between them.
Scene office() {
    return built_scene("office", {{"nx", "2"}, {"ny", "2"}, {"nfurn", "2"}});
}

TEST(RayLightOnElements, IsUnbiasedWithTheReportedVariance) {
    // Includes elements as large as a room, whose centres have different light than their average.
    Lit lit(office());
    for (const MeshSize& size : {MeshSize{0.3, 1}, MeshSize{3, 0}}) {
        const ElementTree tree = lit.stage.make_elements(size);
        double exact = 0, found = 0, squares = 0, variance = 0;
        const std::vector<ElementId> leaves = tree.leaves();
        const std::size_t step = leaves.size() < 8000 ? 1 : has_address_sanitizer ? 25 : 5;
        for (std::size_t i = 0; i < leaves.size(); i += step) {
            const ElementId e = leaves[i];
            const double of_element = lit.exact(tree, e), area = tree.area(e);
            const RayLight::ElementEstimate all = lit.by_rays(tree, e, 1, HUGE_VAL, 256);
            EXPECT_TRUE(all.strong.empty());
            exact += area * of_element, found += area * mean(all.irradiance);
            squares += area * std::pow(mean(all.irradiance) - of_element, 2), variance += area * all.variance;
        }
        // Rays estimate a tenth of the light of an element, of some hundred large elements: an error of half a percent.
        EXPECT_NEAR(found / exact, 1, 0.015) << size.edge;
        EXPECT_LT(squares, 1.5 * variance) << size.edge;
        EXPECT_GT(squares, 0.4 * variance) << size.edge;
    }
}

TEST(RayLightOnElements, UsesNoRaysIfNoErrorIsAllowed) {
    Lit lit(office());
    const ElementTree tree = lit.stage.make_elements({1, 0});
    std::size_t strong = 0;
    for (ElementId e : tree.leaves()) {
        const RayLight::ElementEstimate of = lit.by_rays(tree, e, 1, 0, 16);
        EXPECT_EQ(of.misfit_squared, 0);
        EXPECT_EQ(of.variance, 0);
        EXPECT_EQ(of.irradiance, Spectrum());
        strong += of.strong.size();
    }
    EXPECT_GT(strong, tree.leaves().size());
}

TEST(RayLightOnElements, PreservesTheLightOfAProjectionOntoManyElements) {
    Lit lit(office());
    const StopRequest stop;
    const DirectProjection many =
        project_direct_light(lit.stage, {.mesh = {0.2, 1}, .tolerance = 0.2, .max_depth = 1}, stop);
    const std::vector<ElementId> leaves = many.tree.leaves();
    ASSERT_GT(leaves.size(), 8000u);  // enough elements for weak emitters to be sampled
    double exact = 0, found = 0, square = 0;
    for (std::size_t i = 0; i < leaves.size(); i += 23) {
        const ElementId e = leaves[i];
        const double E = lit.exact(many.tree, e);
        exact += many.tree.area(e) * E, found += many.tree.area(e) * mean(many.fit[e].mean);
        square += many.tree.area(e) * std::pow(E - mean(many.fit[e].mean), 2);
    }
    double area = 0;
    for (std::size_t i = 0; i < leaves.size(); i += 23) area += many.tree.area(leaves[i]);
    EXPECT_NEAR(found / exact, 1, 0.01);
    EXPECT_LT(std::sqrt(square / area), 0.2 * exact / area);  // the tolerance
}

TEST(RayLightOnElements, LeavesNearSourcesToExactLight) {
    // An L-shaped room with emitting walls. For sources partly hidden by its corner, a ray from the element's centre
    // would always give too much or too little light.
    Lit lit(test::make(test::l_room(2, 1)));
    const ElementTree tree = lit.stage.make_elements({0.25, 0});
    double weak = 0;
    for (ElementId e : tree.leaves())
        weak += tree.area(e) / lit.stage.area * mean(lit.by_rays(tree, e, 0.5, 4e-4, 16).irradiance);
    EXPECT_LT(weak, 0.02);  // W/m^2, of about 1; 0.07 if only the light of the sources were considered
}

TEST(RayLightOnElements, ManyEmittersAreTakenTogether) {
    // Two furnished rooms, one below a panel of 400 emitting triangles.
    Lit lit(built_scene("carpet", {{"u", "20"}, {"v", "10"}, {"cuts", "1"}, {"books", "0"}}));
    const ElementTree tree = lit.stage.make_elements({0.25, 0});
    double exact = 0, found = 0, variance = 0;
    const std::vector<ElementId> leaves = tree.leaves();
    for (std::size_t i = 0; i < leaves.size(); i += 4) {
        const ElementId e = leaves[i];
        const RayLight::ElementEstimate all = lit.by_rays(tree, e, 1, HUGE_VAL, 256);
        exact += tree.area(e) * lit.exact(tree, e), found += tree.area(e) * mean(all.irradiance);
        variance += std::pow(tree.area(e), 2) * all.variance;
    }
    // Emitters that shine on a part of an element but not on its centre are left out: 0.2%.
    EXPECT_NEAR(found, exact, 3 * std::sqrt(variance) + 0.002 * exact);
    EXPECT_LT(std::sqrt(variance), 0.002 * exact);
}

TEST(RayLightOnElements, MeanLightIsThatOfAllElements) {
    Lit lit(office());
    const ElementTree tree = lit.stage.make_elements({0.5, 0});
    const std::vector<ElementId> leaves = tree.leaves();
    double sum = 0, area = 0;
    for (ElementId e : leaves) {
        const Spectrum w = light_weight(lit.scene.material(tree.region(e)));
        sum += tree.area(e) * mean(w * fit_direct_light(lit.stage, tree, e, 0, lit.room).mean), area += tree.area(e);
    }
    // 2000 places of light that varies about as much as its mean, with rays of 16: an error of 3%.
    EXPECT_NEAR(mean_weighted_light(lit.stage, tree, leaves, {}) / (sum / area), 1, 0.09);
}

}  // namespace
}  // namespace exitance
