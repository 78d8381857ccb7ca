#include "exitance/direct/sampled_light.hpp"

#include <gtest/gtest.h>

#include "exitance/transport/direct_projection.hpp"
#include "support/built_scene.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// Four furnished rooms with doors between them.
struct Office {
    Office() : scene(built_scene("office", {{"nx", "2"}, {"ny", "2"}, {"nfurn", "2"}})), stage(scene) {}
    Scene scene;
    Stage stage;
    SampledLight sampled{stage.direct, stage.tracer, 1};
    DirectFitRoom room;

    double exact(const ElementTree& tree, ElementId e) { return mean(fit_direct_light(stage, tree, e, 0, room).mean); }
};

TEST(SampledLight, IsUnbiasedOverManyElements) {
    // Includes elements as large as a room, whose centres have different light than their average.
    Office office;
    for (const MeshSize& size : {MeshSize{0.3, 1}, MeshSize{3, 0}}) {
        const ElementTree tree = office.stage.make_elements(size);
        double exact = 0, found = 0;
        const std::vector<ElementId> leaves = tree.leaves();
        const std::size_t step = leaves.size() > 8000 ? 5 : 1;
        for (std::size_t i = 0; i < leaves.size(); i += step) {
            const ElementId e = leaves[i];
            exact += tree.area(e) * office.exact(tree, e);
            const SampledLight::Estimate& all = office.sampled(tree, e, Spectrum(1.0), HUGE_VAL, 256);
            EXPECT_TRUE(all.strong.empty());
            found += tree.area(e) * mean(all.weak);
        }
        // Rays estimate a tenth of the light of an element, of some hundred large elements: an error of half a percent.
        EXPECT_NEAR(found / exact, 1, 0.015) << size.edge;
    }
}

TEST(SampledLight, UsesNoRaysIfNoErrorIsAllowed) {
    Office office;
    const ElementTree tree = office.stage.make_elements({1, 0});
    std::size_t strong = 0;
    for (ElementId e : tree.leaves()) {
        const SampledLight::Estimate& of = office.sampled(tree, e, Spectrum(1.0), 0, 16);
        EXPECT_EQ(of.misfit_squared, 0);
        strong += of.strong.size();
    }
    EXPECT_GT(strong, tree.leaves().size());
}

TEST(SampledLight, PreservesTheLightOfAProjectionOntoManyElements) {
    Office office;
    const StopRequest stop;
    const DirectProjection many =
        project_direct_light(office.stage, {.mesh = {0.2, 1}, .tolerance = 0.2, .max_depth = 1}, stop);
    const std::vector<ElementId> leaves = many.tree.leaves();
    ASSERT_GT(leaves.size(), 8000u);  // enough elements for sampling to be used
    double exact = 0, found = 0, square = 0;
    for (std::size_t i = 0; i < leaves.size(); i += 23) {
        const ElementId e = leaves[i];
        const double E = office.exact(many.tree, e);
        exact += many.tree.area(e) * E, found += many.tree.area(e) * mean(many.fit[e].mean);
        square += many.tree.area(e) * std::pow(E - mean(many.fit[e].mean), 2);
    }
    double area = 0;
    for (std::size_t i = 0; i < leaves.size(); i += 23) area += many.tree.area(leaves[i]);
    EXPECT_NEAR(found / exact, 1, 0.01);
    EXPECT_LT(std::sqrt(square / area), 0.2 * exact / area);  // the tolerance
}

TEST(SampledLight, ComputesNearSourcesExactly) {
    // An L-shaped room with emitting walls. For sources partly hidden by its corner, a ray from the element's centre
    // would always give too much or too little light.
    const Scene scene = test::make(test::l_room(2, 1));
    const Stage stage(scene);
    SampledLight sampled(stage.direct, stage.tracer, 1);
    const ElementTree tree = stage.make_elements({0.25, 0});
    double weak = 0;
    for (ElementId e : tree.leaves())
        weak += tree.area(e) / stage.area * mean(sampled(tree, e, Spectrum(0.5), 4e-4, 16).weak);
    EXPECT_LT(weak, 0.02);  // W/m^2, of about 1; 0.07 if only the light of the sources were considered
}

}  // namespace
}  // namespace exitance
