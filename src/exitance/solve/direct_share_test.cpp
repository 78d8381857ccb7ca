#include "exitance/solve/direct_share.hpp"

#include <gtest/gtest.h>

#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A closed box of emitting faces. `reflected` computes an element's reflected light from its exitance.
struct GlowingBox {
    Scene scene;
    Stage stage{scene};
    GlobalLight light;

    template <class Reflected>
    GlowingBox(const std::vector<double>& exitances, const Reflected& reflected) : scene(make_box(exitances)) {
        light.tree = stage.make_elements({.edge = 0.5, .grading_levels = 0});
        light.numbering = LeafNumbering(light.tree);
        for (const ElementId e : light.numbering.leaves)
            light.reflected.push_back(Spectrum(reflected(scene.material(light.tree.region(e)).exitance[0])));
    }

    static Scene make_box(const std::vector<double>& exitances) {
        std::vector<test::Face> faces = test::closed_box({}, {2, 1.5, 1});
        for (std::size_t i = 0; i < faces.size(); ++i) faces[i].exitance = exitances[i];
        return test::make(faces);
    }

    double share() const {
        const ElementLocator locator(light.tree, scene.regions().size());
        return find_direct_share(stage, light, locator, 1)[0];
    }
};

TEST(DirectShare, IsOneIfReflectedAndEmittedLightAddUpToAConstant) {
    EXPECT_NEAR(GlowingBox({0.9, 0.2, 0.5, 0.3, 0.7, 0.4}, [](double M) { return 1 - M; }).share(), 1, 1e-12);
}

TEST(DirectShare, IsTheSlopeOfReflectedOverEmittedLight) {
    EXPECT_NEAR(GlowingBox({0.9, 0.2, 0.5, 0.3, 0.7, 0.4}, [](double M) { return 2 - 0.7 * M; }).share(), 0.7, 1e-12);
}

TEST(DirectShare, IsZeroIfItWouldNotReduceTheVariance) {
    // Reflected light is largest for medium exitance, which a linear function of the exitance cannot represent.
    const auto bow = [](double M) { return 1 - (M - 0.5) * (M - 0.5); };
    EXPECT_EQ(GlowingBox({0.9, 0.1, 0.5, 0.5, 0.9, 0.1}, bow).share(), 0);
    // No surface that rays hit emits.
    EXPECT_EQ(GlowingBox({0, 0, 0, 0, 0, 0}, [](double) { return 1.0; }).share(), 0);
}

}  // namespace
}  // namespace exitance
