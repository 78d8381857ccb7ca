#include "exitance/methods/light/next_light.hpp"

#include <gtest/gtest.h>

#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// A furnace, B = M / (1 - rho) everywhere, M = 1: direct light is M, indirect light rho / (1 - rho).
class StepFurnace : public testing::Test {
  protected:
    static constexpr double rho = 0.8, exact = rho / (1 - rho);
    Scene scene = box_scene(2, 1, 1.5, rho, 1, 1);
    Stage stage{scene};
    DirectProjection direct{stage.make_elements({.edge = 0.5, .grading_levels = 1}), {}};
    GlobalLight light;

    StepFurnace() {
        light.tree = direct.tree, light.numbering = LeafNumbering(light.tree), light.on_projection = true;
        direct.fit.resize(direct.tree.size());
        for (ElementId e : direct.tree.leaves())
            direct.fit[e].mean = Spectrum(1.0), direct.fit[e].corners.fill(Spectrum(1.0));
    }

    ElementFunction constant(double value) const {
        ElementFunction out;
        out.tree = direct.tree, out.first_value.resize(out.tree.size(), 0);
        for (ElementId e : out.tree.leaves()) {
            out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
            for (int i = 0; i < 4; ++i) out.add_value(Spectrum(value));
        }
        return out;
    }

    double read(const ReflectedLight& b, ElementId e) const {
        const RayEnd hit{direct.tree.patch(e).at(direct.tree.centre(e)), direct.tree.region(e)};
        Spectrum value;
        b.read({&hit, 1}, {&value, 1});
        return value[0];
    }

    NextLight step(NextLight before, double delivered) const {
        const ElementFunction indirect = constant(delivered);
        return next_light({stage, light, indirect, direct, Spectrum(), {.average = 64}, 1}, std::move(before));
    }
};

TEST_F(StepFurnace, OneStepCorrectsAUniformError) {
    constexpr double wrong = 1.03;
    // In a closed room, gathering b yields b.
    const NextLight next = step({{constant(wrong * exact)}}, wrong * exact);
    const ReadNextLight b(next, scene.regions().size());
    ASSERT_TRUE(b.change());
    for (ElementId e : direct.tree.leaves()) {
        // The solver's residual leaves a fiftieth of the 3%, multiplied by reflections.
        EXPECT_NEAR(read(b.whole(), e), exact, 3e-3 * exact);
        EXPECT_NEAR(read(*b.change(), e), read(b.whole(), e) - wrong * exact, 1e-5 * exact);  // single precision
    }
}

TEST_F(StepFurnace, ASecondStepStartsFromTheFirst) {
    NextLight first = step({{constant(1.03 * exact)}}, 1.03 * exact);
    std::vector<double> before;
    for (ElementId e : direct.tree.leaves())
        before.push_back(read(ReadNextLight(first, scene.regions().size()).whole(), e));
    first.rest.clear();
    EXPECT_FALSE(ReadNextLight(first, scene.regions().size()).change());
    const NextLight next = step(std::move(first), 0.98 * exact);
    const ReadNextLight b(next, scene.regions().size());
    std::size_t i = 0;
    for (ElementId e : direct.tree.leaves()) {
        EXPECT_NEAR(read(*b.change(), e), read(b.whole(), e) - before[i++], 1e-5 * exact);
        EXPECT_NEAR(read(b.whole(), e),
                    rho * (1 + 0.98 * exact) + (rho / (1 - rho)) * (rho * 0.98 * exact + rho - exact),
                    5e-3 * exact);  // b1 plus the response to b1 - b, where b is exact; tolerance as above
    }
}

}  // namespace
}  // namespace exitance
