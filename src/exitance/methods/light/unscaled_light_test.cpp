#include "exitance/methods/light/unscaled_light.hpp"

#include <gtest/gtest.h>

#include "exitance/evaluate/energy.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// A closed box where all surfaces emit M and B = M / (1 - rho).
struct UnscaledFurnace {
    static constexpr double rho = 0.5, M = 1, E_dir = M, E_ind = rho * M / (1 - rho);
    Scene scene = box_scene(2, 1, 1.5, rho, M, 1);
    Stage stage{scene};
    DirectProjection direct{stage.make_elements({.edge = 0.5, .grading_levels = 0}), {}};
    GlobalLight light;
    Solution solution{.scene = scene};

    UnscaledFurnace() {
        light.tree = direct.tree, light.numbering = LeafNumbering(light.tree);
        const std::size_t n = light.numbering.leaves.size();
        light.direct.assign(n, Spectrum(E_dir)), light.indirect.assign(n, Spectrum(E_ind));
        light.reflected.assign(n, Spectrum(rho * (E_dir + E_ind)));
        direct.fit.resize(direct.tree.size());
        solution.indirect.tree = direct.tree, solution.indirect.first_value.resize(direct.tree.size(), 0);
        for (ElementId e : direct.tree.leaves()) {
            direct.fit[e].mean = Spectrum(E_dir);
            solution.indirect.first_value[e] = static_cast<std::uint32_t>(solution.indirect.values.size());
            for (int i = 0; i < 4; ++i) solution.indirect.add_value(Spectrum(E_ind));
        }
    }
};

TEST(UnscaledLight, DefectEqualsTheCorrectionByScaling) {
    const UnscaledFurnace furnace;
    const EnergyBalance energy = energy_balance(furnace.solution, furnace.direct, furnace.stage);
    ASSERT_NEAR(energy.defect, 0, 1e-12);
    const auto before = [&](double direct, double indirect) {
        return energy_defect_before(energy, furnace.solution, furnace.direct, {Spectrum(direct), Spectrum(indirect)});
    };
    // Direct and indirect light are absorbed equally: half of the emitted light each.
    EXPECT_NEAR(before(1, 1), 0, 1e-12);
    EXPECT_NEAR(before(0.99, 1), 0.005, 1e-12);
    EXPECT_NEAR(before(1, 1.02), 0.01, 1e-12);
    EXPECT_NEAR(before(0.99, 1.02), 0.005, 1e-12) << "they make up for each other";
}

TEST(UnscaledLight, UsesTheUnitOfTheBalance) {
    // Excess light in one band counts by that band's weight: a third in watts.
    if constexpr (bands != 3) GTEST_SKIP() << "the bands of this build weigh alike";
    const UnscaledFurnace furnace;
    const EnergyBalance energy = energy_balance(furnace.solution, furnace.direct, furnace.stage);
    Spectrum less(1);
    less[0] = 0.98;
    const UnscaledShare share{Spectrum(1), less};
    EXPECT_NEAR(energy_defect_before(energy, furnace.solution, furnace.direct, share), 0.01 / 3, 1e-12);
}

TEST(UnscaledLight, SentPowerFollowsTheScalesOfDirectAndReturnedLight) {
    const UnscaledFurnace furnace;
    const auto sent = [&](double direct, double returned, double c) {
        return unscaled_sent(furnace.scene, furnace.light, Spectrum(direct), Spectrum(returned), Spectrum(c))[0];
    };
    // rho E_dir and rho E_ind are equal here.
    EXPECT_NEAR(sent(0.99, 1, 0), 0.99, 1e-12);
    EXPECT_NEAR(sent(1, 0.98, 0), 0.99, 1e-12);
    EXPECT_NEAR(sent(0.99, 1, 1), (0.99 + 1) / 2, 1e-12) << "what is emitted is gathered as it is";
}

TEST(UnscaledLight, IsReportedForAClosedScene) {
    Progress progress;
    const StopRequest stop;
    const Result<Solution> solution = solve_scene(built_scene("gaps"), {.error = 0.05}, progress, stop);
    ASSERT_TRUE(solution);
    const std::optional<double> before = solution->statistics.energy.defect_before;
    ASSERT_TRUE(before);
    EXPECT_LT(solution->statistics.energy.defect, 1e-6) << "rounding of values in single precision";
    EXPECT_GT(*before, 1e-6) << "noise of rays";
    EXPECT_LT(*before, 0.01) << "six times its root mean square over seeds";
}

}  // namespace
}  // namespace exitance
