#include "exitance/transport/linear_rows.hpp"

#include <gtest/gtest.h>

#include "support/built_scene.hpp"

namespace exitance {
namespace {

TEST(LinearRows, ReturnTheReflectanceInAFurnace) {
    const double rho = 0.4;
    const Scene scene = box_scene(2, 1, 1, rho, 1, 1);
    const Stage stage(scene);
    const StopRequest stop;
    const DirectProjection direct = project_direct_light(stage, {.mesh = {0.5, 1}, .tolerance = 0.1}, stop);
    const LeafNumbering numbering(direct.tree);
    const ElementLocator locator(direct.tree, scene.regions().size());
    const LinearRows H(stage, direct, numbering, locator, {.average = 32, .min = 16, .max = 64}, 1);
    std::vector<Spectrum> ones(H.size(), Spectrum(1.0)), out(H.size());
    H.gather(ones, out);
    // Every row sums to 1, up to single precision of the corner weights.
    for (std::size_t k = 0; k < H.size(); ++k) {
        EXPECT_NEAR(out[k][0], rho, 1e-6);
        EXPECT_NEAR(H.gather_at(k, ones)[0], out[k][0], 1e-12);
    }
    // E_dir is 1 everywhere, and rho after one reflection.
    for (const Spectrum& first : H.first_reflection(direct)) EXPECT_NEAR(first[0], rho, 1e-6);
    double area = 0;
    for (double a : H.node_areas()) area += a;
    EXPECT_NEAR(area, stage.area, 1e-9);
}

TEST(LinearRows, ReproduceALinearFunctionAtCornersAndInTheMean) {
    const Scene scene = box_scene(1, 1, 1, 0.5, 1);
    const Stage stage(scene);
    const StopRequest stop;
    const DirectProjection direct = project_direct_light(stage, {.mesh = {1.1, 0}, .tolerance = 10}, stop);
    const LeafNumbering numbering(direct.tree);
    const ElementLocator locator(direct.tree, scene.regions().size());
    const LinearRows H(stage, direct, numbering, locator, {.average = 16, .min = 16, .max = 16}, 1);
    ASSERT_EQ(H.size(), 24u);  // six squares with four nodes each
    const double g = 0.5 / std::sqrt(3.0);
    // f = 1 + u + 2 v at the nodes (0.5 -+ g, 0.5 -+ g), in the order of the rule, u first.
    std::vector<Spectrum> nodal(24);
    for (std::size_t k = 0; k < 4; ++k)
        nodal[k] = Spectrum(1 + (0.5 + (k % 2 ? g : -g)) + 2 * (0.5 + (k / 2 ? g : -g)));
    const std::array<Spectrum, 4> corner = H.corners(0, nodal);
    const double expected[] = {1, 2, 4, 3};
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(corner[c][0], expected[c], 1e-6);
    EXPECT_NEAR(H.mean(0, nodal)[0], 2.5, 1e-12);
}

}  // namespace
}  // namespace exitance
