#include "exitance/methods/light/corrected_sums.hpp"

#include <gtest/gtest.h>

#include "exitance/evaluate/radiosity_function.hpp"
#include "support/built_scene.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

TEST(RefinedLight, CorrectsGatheredLightInAFurnace) {
    // B = M / (1 - rho) everywhere; the gathered light is 3% too bright.
    constexpr double rho = 0.8, wrong = 1.03;
    const Scene scene = box_scene(2, 1, 1.5, rho, 1, 1);
    const Stage stage(scene);
    DirectProjection direct{stage.make_elements({.edge = 0.5, .grading_levels = 1}), {}};
    GlobalLight light;
    light.tree = direct.tree, light.numbering = LeafNumbering(light.tree);
    direct.fit.resize(direct.tree.size());
    ElementFunction gathered;
    gathered.tree = direct.tree, gathered.first_value.resize(gathered.tree.size(), 0);
    for (ElementId e : direct.tree.leaves()) {
        // light of emitters with exitance M = 1
        direct.fit[e].mean = Spectrum(1.0), direct.fit[e].corners.fill(Spectrum(1.0));
        gathered.first_value[e] = static_cast<std::uint32_t>(gathered.values.size());
        for (int i = 0; i < 4; ++i) gathered.add_value(Spectrum(wrong * rho / (1 - rho)));
    }
    constexpr double share = 1e-4;
    const std::vector<ElementFunction> parts =
        corrected_sums({stage, light, gathered, direct, Spectrum(), {.average = 64}, 1}, share);
    for (ElementId e : direct.tree.leaves()) {
        double b = 0;
        for (const ElementFunction& part : parts) b += part.at({e, direct.tree.centre(e)})[0];
        // The solver's residual leaves a fiftieth of the 3%, multiplied by reflections; plus the error of sums.
        EXPECT_NEAR(b, rho / (1 - rho), 4e-3 * rho / (1 - rho));
    }
}

TEST(RefinedLight, LeavesNoBiasInABrightTube) {
    // A method's constant elements spread light evenly and thus transport too much of it along the tube: without the
    // step, the mean would be off by up to 0.36%, depending on the seed.
    const Scene scene = built_scene("tube", {{"rho", "0.9"}});
    const auto mean_light = [&](const SolveOptions& options) {
        const Solution solution = solved(scene, options);
        const RadiosityFunction function(solution);
        std::vector<ProbePoint> points;
        constexpr int places = 64;
        for (int i = 0; i < places; ++i)
            for (const double y : {0.1, 0.5, 0.9}) points.push_back({{8 * (i + 0.5) / places, y, 0}, {0, 0, 1}});
        double sum = 0;
        for (const Light& l : function.at(points)) sum += l.irradiance[0];
        return sum;
    };
    const double exact = mean_light({.method = Method::matrix, .error = 0.003});
    for (const Method method : {Method::matrix, Method::hierarchical})
        for (const std::uint64_t seed : {1, 2})
            EXPECT_NEAR(mean_light({.method = method, .error = 0.02, .seed = seed}) / exact, 1, 3e-3);
}

}  // namespace
}  // namespace exitance
