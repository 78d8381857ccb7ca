#include "exitance/what_if/light_groups/kept_transport.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "exitance/what_if/light_groups/cast_transport.hpp"
#include "exitance/what_if/light_groups/reflected_light.hpp"

namespace exitance {
namespace {

/// A closed grey cube of edge 1.
Scene cube() {
    SceneDescription d;
    d.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(1)}};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}, {{4, 7, 6, 5}, 0, 0, 2}, {{0, 4, 5, 1}, 0, 0, 3},
               {{1, 5, 6, 2}, 0, 0, 4}, {{2, 6, 7, 3}, 0, 0, 5}, {{3, 7, 4, 0}, 0, 0, 6}};
    d.groups = {"cube"};
    return std::move(*make_scene(std::move(d)).scene);
}

/// E = 1 on elements that were split `cuts` times.
ElementFunction ones(const Stage& stage, int cuts) {
    ElementFunction out;
    for (const auto& [region, patch] : stage.pieces) out.tree.add_root(region, patch);
    for (; cuts > 0; --cuts)
        for (const ElementId e : out.tree.leaves()) out.tree.split(e, Cut::both);
    out.first_value.resize(out.tree.size(), 0);
    for (const ElementId e : out.tree.leaves()) {
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        for (int i = 0; i < out.tree.patch(e).corner_count(); ++i) out.add_value(Spectrum(1));
    }
    return out;
}

class KeptTransportOfACube : public testing::Test {
  protected:
    KeptTransportOfACube() : solution{.scene = cube()}, stage(solution.scene) {
        solution.indirect = ones(stage, 2), solution.interpolant = ones(stage, 4);
    }
    KeptTransport cast(std::vector<std::uint32_t> receivers, double form_factor) {
        layout = make_layout(solution, receivers);
        return cast_transport(stage, solution, std::move(receivers), layout,
                              {.rays = {.average = 256}, .form_factor = form_factor, .seed = 1}, {});
    }
    std::vector<std::uint32_t> leaves() const {
        std::vector<std::uint32_t> out;
        for (const ElementId e : solution.indirect.tree.leaves()) out.push_back(e.value);
        return out;
    }
    Solution solution;
    Stage stage;
    TransportLayout layout;
};

}  // namespace

TEST_F(KeptTransportOfACube, ConservesLightInAClosedScene) {
    for (const double form_factor : {0.0, 0.01, 1.0}) {
        const KeptTransport kept = cast(leaves(), form_factor);
        const KeptOperator F(kept, layout, solution.interpolant.tree.size());
        std::vector<Spectrum> E(F.size());
        F.gather(std::vector<Spectrum>(F.size(), Spectrum(1)), E);
        for (const Spectrum& e : E) EXPECT_NEAR(e[0], 1, 1e-5) << "weights are in single precision";
    }
}

TEST_F(KeptTransportOfACube, AgreesWithTheFormFactorOfOppositeFaces) {
    const KeptTransport kept = cast(leaves(), 1.0 / 256);
    const KeptOperator F(kept, layout, solution.interpolant.tree.size());
    // The face opposite to the first one: z = 1.
    std::vector<Spectrum> b(F.size()), E(F.size());
    const auto on = [&](std::size_t i, double z) {
        const ElementId e = layout.sources[i];
        const Point c = solution.interpolant.tree.patch(e).centre();
        return std::abs(c.z - z) < 1e-9;
    };
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = Spectrum(on(i, 1) ? 1 : 0);
    F.gather(b, E);
    double arrives = 0;
    for (std::size_t i = 0; i < b.size(); ++i)
        if (on(i, 0)) arrives += layout.area[i] * E[i][0];
    // 0.19982 [Howell, C-11]; the noise of 37,000 stratified rays is less than a hundredth of that.
    EXPECT_NEAR(arrives, 0.19982, 0.002);
}

TEST_F(KeptTransportOfACube, MergesSmallElementsAccurately) {
    const KeptTransport fine = cast(leaves(), 0), merged = cast(leaves(), 1.0 / 64);
    EXPECT_EQ(fine.rays, merged.rays);
    EXPECT_LT(merged.source.size(), fine.source.size() / 4);
    // A source that varies: E by individual rays, and by means over elements with form factors of at most 1/64.
    std::vector<Spectrum> b(layout.sources.size());
    for (std::size_t i = 0; i < b.size(); ++i) {
        const Point c = solution.interpolant.tree.patch(layout.sources[i]).centre();
        b[i] = Spectrum(c.x + 2 * c.y * c.z);
    }
    std::vector<Spectrum> by_fine(b.size()), by_merged(b.size());
    KeptOperator(fine, layout, solution.interpolant.tree.size()).gather(b, by_fine);
    KeptOperator(merged, layout, solution.interpolant.tree.size()).gather(b, by_merged);
    double off = 0, all = 0;
    for (std::size_t i = 0; i < b.size(); ++i)
        off += std::pow(by_fine[i][0] - by_merged[i][0], 2), all += by_fine[i][0] * by_fine[i][0];
    // The errors of about 64 entries are independent, each at most half of an element's variation, an eighth of the
    // mean.
    EXPECT_LT(std::sqrt(off / all), 1.0 / 64);
    EXPECT_GT(off, 0);
}

TEST_F(KeptTransportOfACube, ChoosesLargeReceiversForUniformLight) {
    const std::vector<std::uint32_t> receivers = choose_receivers(solution, 1e-6);
    EXPECT_EQ(receivers.size(), 6u) << "light is 1 everywhere: faces as they are";
    solution.indirect.values[0][0] = 2;
    EXPECT_GT(choose_receivers(solution, 1e-6).size(), 6u);
    EXPECT_EQ(choose_receivers(solution, 1.0).size(), 6u);
}

TEST_F(KeptTransportOfACube, SolvesTheClosedFormOfAGreyEnclosure) {
    const KeptTransport kept = cast(leaves(), 1.0 / 256);
    const KeptOperator F(kept, layout, solution.interpolant.tree.size());
    const std::vector<Spectrum> rho(F.size(), Spectrum(0.5)), direct(F.size(), Spectrum(1));
    // b = rho (D + b): all points are equal.
    for (const Spectrum& b : reflected_light(F, rho, layout.area, direct, -1)) EXPECT_NEAR(b[0], 1, 1e-3);
    // Two reflections: rho D + rho^2 D.
    for (const Spectrum& b : reflected_light(F, rho, layout.area, direct, 2)) EXPECT_NEAR(b[0], 0.75, 1e-5);
}

}  // namespace exitance
