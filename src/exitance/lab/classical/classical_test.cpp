#include <gtest/gtest.h>

#include <cmath>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

Result<Solution> try_to_solve(const Scene& scene, SolveOptions options, const ClassicalOptions& classical,
                              const ShowLight& show = {}) {
    Progress progress;
    const StopRequest stop;
    options.classical = classical;
    return solve_scene(scene, options, progress, stop, nullptr, show);
}

Solution solve(const Scene& scene, const SolveOptions& options, const ClassicalOptions& classical,
               const ShowLight& show = {}) {
    Result<Solution> solution = try_to_solve(scene, options, classical, show);
    EXPECT_TRUE(solution) << solution.error().message;
    return std::move(*solution);
}

std::size_t initial_links(const Solution& solution) {
    return static_cast<std::size_t>(solution.statistics.figures.at("initial_links"));
}

ClassicalOptions carried_raw(bool uniform) {
    ClassicalOptions out;
    out.direct = ClassicalDirect::carried;
    if (uniform) out.mesh = MeshKind::uniform;
    out.gather = false;
    return out;
}
const ClassicalOptions raw = carried_raw(true);

ClassicalOptions by_power(double threshold) {
    ClassicalOptions out = carried_raw(false);
    out.threshold = threshold;
    return out;
}

/// RMS difference between the irradiance of elements and exact direct light, relative to its mean; for black scenes.
double error_of(const Solution& solution) {
    Solution exact{.scene = solution.scene, .indirect = solution.indirect};
    for (auto& value : exact.indirect.values) value = {};
    const RadiosityFunction found(solution), right(exact);
    std::vector<ProbePoint> points;
    const ElementTree& tree = solution.indirect.tree;
    constexpr int n = 24;
    for (ElementId root : tree.roots()) {
        if (solution.scene.material(tree.region(root)).emits()) continue;
        for (int i = 0; i < n * n; ++i)
            points.push_back({tree.patch(root).at((i % n + 0.37) / n, (i / n + 0.61) / n), tree.patch(root).normal()});
    }
    const std::vector<Light> a = found.at(points), b = right.at(points);
    double square = 0, mean = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        square += std::pow(a[i].irradiance[0] - b[i].irradiance[0], 2);
        mean += b[i].irradiance[0];
    }
    const auto count = static_cast<double>(points.size());
    return std::sqrt(square / count) / (mean / count);
}

bool same_bits(const Solution& a, const Solution& b) {
    return a.indirect.values == b.indirect.values;
}

class EveryClassicalMethod : public testing::TestWithParam<std::pair<Method, BasisKind>> {
  protected:
    SolveOptions options(double mesh_size) const {
        SolveOptions o{.method = GetParam().first, .mesh_size = mesh_size};
        if (o.method == Method::wavelet) o.basis = GetParam().second;
        return o;
    }
};
INSTANTIATE_TEST_SUITE_P(Methods, EveryClassicalMethod,
                         testing::Values(std::pair(Method::matrix, BasisKind::constant),
                                         std::pair(Method::progressive, BasisKind::constant),
                                         std::pair(Method::substructuring, BasisKind::constant),
                                         std::pair(Method::hierarchical, BasisKind::haar),
                                         std::pair(Method::wavelet, BasisKind::flatlet2),
                                         std::pair(Method::wavelet, BasisKind::flatlet3),
                                         std::pair(Method::wavelet, BasisKind::multiwavelet2),
                                         std::pair(Method::wavelet, BasisKind::multiwavelet3)));

TEST_P(EveryClassicalMethod, SolvesAFurnace) {
    const double rho = 0.5;
    const Scene scene = box_scene(1, 1, 1, rho, 1, 1);
    SolveOptions o = options(0.25);
    o.residual = 1e-6;
    const Solution solution = solve(scene, o, raw);
    // E = M / (1 - rho). Form factors of elements at edges are exact, and rows sum to 1.
    const RadiosityFunction light(solution);
    for (const Light& l : light.at(std::vector<ProbePoint>{{{0.4, 0.3, 0}, {0, 0, 1}}, {{1, 0.6, 0.7}, {-1, 0, 0}}}))
        EXPECT_NEAR(l.irradiance[0], 1 / (1 - rho), 0.02 / (1 - rho));
    EXPECT_TRUE(solution.direct_in_elements);
    EXPECT_TRUE(solution.statistics.converged);
    EXPECT_FALSE(solution.statistics.relative_error_estimate);
}

TEST_P(EveryClassicalMethod, SolvesABlackSceneThroughItsOwnTransport) {
    const Scene scene = built_scene("blocker", {{"h", "0.7"}});
    const double coarse = error_of(solve(scene, options(0.5), raw));
    const double fine = error_of(solve(scene, options(0.25), raw));
    EXPECT_LT(fine, 0.12);
    EXPECT_LT(fine, 0.75 * coarse);  // one visibility per link makes shadows blocky: first order with any basis
}

TEST(Classical, ExactVisibilityMakesHighOrdersMoreAccurate) {
    const Scene scene = built_scene("blocker", {{"h", "0.7"}});
    SolveOptions o{.method = Method::wavelet, .basis = BasisKind::multiwavelet3, .mesh_size = 0.5};
    const double fractional = error_of(solve(scene, o, raw));
    o.visibility = VisibilityKind::exact;
    EXPECT_LT(error_of(solve(scene, o, raw)), 0.25 * fractional);
}

TEST(Classical, NumberOfLinksIsInverseToTheThreshold) {
    const Scene scene = built_scene("tube", {{"rho", "0.7"}});
    const SolveOptions o{.method = Method::hierarchical, .oracle = LinkOracle::power};
    const Solution coarse = solve(scene, o, by_power(0.08)), fine = solve(scene, o, by_power(0.02));
    const double ratio = static_cast<double>(fine.statistics.links) / static_cast<double>(coarse.statistics.links);
    EXPECT_NEAR(ratio, 4, 1);
    EXPECT_EQ(initial_links(fine), 30u);  // six polygons that all see each other
}

TEST(Classical, TheKernelOracleAddsFewerLinksForHigherOrders) {
    const Scene scene = built_scene("tube", {{"rho", "0.7"}});
    const auto added = [&](BasisKind basis, std::optional<ClassicalOracle> oracle) {
        ClassicalOptions classical = by_power(0.05);
        classical.oracle = oracle;
        const SolveOptions o{.method = Method::wavelet, .basis = basis, .oracle = LinkOracle::power};
        const Solution s = solve(scene, o, classical);
        return static_cast<double>(s.statistics.links) - static_cast<double>(initial_links(s));
    };
    const double haar = added(BasisKind::haar, ClassicalOracle::kernel),
                 M2 = added(BasisKind::multiwavelet2, ClassicalOracle::kernel),
                 M3 = added(BasisKind::multiwavelet3, ClassicalOracle::kernel);
    EXPECT_LT(M2, haar);
    EXPECT_LT(M3, M2);
    // The power of a link is the same in every basis, up to the light that it carries.
    EXPECT_NEAR(added(BasisKind::multiwavelet3, {}) / added(BasisKind::haar, {}), 1, 0.1);
}

TEST(Classical, NoElementIsSmallerThanTheMinimumArea) {
    const Scene scene = built_scene("tube", {{"rho", "0.7"}});
    const double least = 0.04;
    ClassicalOptions c = by_power(1e-3);
    const Solution solution =
        solve(scene, {.method = Method::hierarchical, .min_area = least, .oracle = LinkOracle::form_factor}, c);
    for (ElementId e : solution.indirect.tree.leaves()) EXPECT_GE(solution.indirect.tree.area(e), least);
}

TEST(Classical, GatherAndSmoothingDoNotChangeTheSolve) {
    const Scene scene = built_scene("tube", {{"rho", "0.7"}});
    SolveOptions o{.method = Method::progressive, .mesh_size = 0.5};
    const Solution plain = solve(scene, o, raw);
    ClassicalOptions gathers = raw;
    gathers.gather = true;
    const Solution gathered = solve(scene, o, gathers);
    o.smoothing = true;
    const Solution smooth = solve(scene, o, raw);
    for (const Solution* s : {&gathered, &smooth}) {
        EXPECT_EQ(s->statistics.iterations, plain.statistics.iterations);
        EXPECT_EQ(s->statistics.residual, plain.statistics.residual);
        EXPECT_FALSE(same_bits(*s, plain));
    }
    EXPECT_EQ(smooth.indirect.tree.size(), plain.indirect.tree.size());
}

TEST(Classical, SnapshotsAreTakenAfterShotsAndAmbientLightIsAdded) {
    const Scene scene = built_scene("tube", {{"rho", "0.7"}});
    ClassicalOptions c = raw;
    SolveOptions o{.method = Method::progressive, .mesh_size = 0.5, .snapshots = {.shots = {5, 2}}};
    std::vector<double> unshot;
    const auto flux = [&](bool ambient) {
        c.ambient = ambient;
        std::vector<double> out;
        unshot.clear();
        solve(scene, o, c, [&](const Solution& s) {
            double sum = 0;
            for (ElementId e : s.indirect.tree.leaves())
                sum += s.indirect.tree.area(e) * s.indirect.at({e, s.indirect.tree.centre(e)})[0];
            out.push_back(sum), unshot.push_back(s.statistics.residual);
        });
        return out;
    };
    const std::vector<double> bare = flux(false), filled = flux(true);
    ASSERT_EQ(bare.size(), 2u);
    ASSERT_EQ(filled.size(), 2u);
    EXPECT_LT(bare[0], bare[1]);
    EXPECT_GT(unshot[0], unshot[1]) << "what is left to be shot, of all that there was";
    EXPECT_GT(unshot[1], 0);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_GT(filled[i], bare[i]);
}

TEST(Classical, RefinementCutsElementsDuringShootingOrAfter) {
    const Scene scene = built_scene("blocker", {{"h", "0.7"}});
    ClassicalOptions c = raw;
    c.receivers = ShootingReceivers::vertex;
    c.refine_gradient = 0.5;
    const SolveOptions o{.method = Method::substructuring, .mesh_size = 0.5, .min_area = 1e-3};
    std::size_t elements[2];
    for (RefineWhen when : {RefineWhen::during, RefineWhen::after}) {
        c.refine = when;
        elements[when == RefineWhen::after] = solve(scene, o, c).statistics.leaf_elements;
    }
    c.refine.reset(), c.refine_gradient.reset();
    const std::size_t unrefined = solve(scene, o, c).statistics.leaf_elements;
    EXPECT_GT(elements[0], unrefined);
    EXPECT_GT(elements[1], unrefined);
    EXPECT_NE(elements[0], elements[1]);
}

TEST(Classical, RefinementDuringShootingComputesNoFormFactorTwice) {
    // A light above a floor that only the light illuminates: every element of the floor is paired with each patch of
    // the light once.
    const Scene scene = built_scene("blocker", {{"h", "0.7"}});
    ClassicalOptions c = raw;
    c.refine_gradient = 0.5;
    const SolveOptions o{.method = Method::substructuring, .mesh_size = 0.5, .min_area = 1e-3};
    std::size_t rays[2], elements[2];
    for (RefineWhen when : {RefineWhen::during, RefineWhen::after}) {
        c.refine = when;
        const SolveStatistics s = solve(scene, o, c).statistics;
        const auto i = static_cast<std::size_t>(when == RefineWhen::after);
        rays[i] = s.rays, elements[i] = s.leaf_elements;
    }
    const double by_elements = static_cast<double>(elements[0]) / static_cast<double>(elements[1]);
    EXPECT_NEAR(static_cast<double>(rays[0]) / static_cast<double>(rays[1]), by_elements, 0.15 * by_elements);
}

TEST(Classical, ShootingCutsCellsOfContactLines) {
    // Boxes on the floor: their outlines cut it into cells, which are not parallelograms.
    const Scene scene = built_scene("cornell");
    const ClassicalOptions aligned = carried_raw(false);
    SolveOptions o{.method = Method::matrix, .mesh_size = 0.3, .residual = 1e-3};
    const Solution matrix = solve(scene, o, aligned);
    const std::vector<ProbePoint> places{
        {{0.45, 0.5, 0}, {0, 0, 1}}, {{0.04, 0.2, 0}, {0, 0, 1}}, {{0.5, 0.05, 0}, {0, 0, 1}}};
    const std::vector<Light> expected = RadiosityFunction(matrix).at(places);
    o.method = Method::substructuring, o.min_area = 1e-2;
    for (const ShootingReceivers receivers : {ShootingReceivers::middle, ShootingReceivers::vertex}) {
        ClassicalOptions c = aligned;
        c.receivers = receivers, c.refine_gradient = 5;
        const Solution shot = solve(scene, o, c);
        EXPECT_GT(shot.statistics.leaf_elements, 4 * matrix.statistics.leaf_elements - 1);
        const std::vector<Light> light = RadiosityFunction(shot).at(places);
        // Elements of 0.3 m and of 0.15 m differ by the variation of light across them.
        for (std::size_t i = 0; i < places.size(); ++i)
            EXPECT_NEAR(light[i].irradiance[1], expected[i].irradiance[1], 0.3 * expected[i].irradiance[1]) << i;
    }
}

TEST(Classical, IsBitwiseIndependentOfThreads) {
    const Scene scene = built_scene("tube", {{"rho", "0.7"}});
    SolveOptions o{.method = Method::wavelet, .oracle = LinkOracle::power, .threads = 1};
    const Solution one = solve(scene, o, by_power(0.1));
    o.threads = 2;
    EXPECT_TRUE(same_bits(one, solve(scene, o, by_power(0.1))));
}

TEST(Classical, RelaxationsDifferInTheirNumberOfSweeps) {
    const Scene scene = built_scene("tube", {{"rho", "0.9"}});
    SolveOptions o{.method = Method::matrix, .mesh_size = 0.5, .residual = 1e-6};
    const auto sweeps = [&](std::optional<Relaxation> relaxation, std::optional<ClassicalRelaxation> own) {
        o.relaxation = relaxation;
        ClassicalOptions c = raw;
        c.relaxation = own;
        const Solution s = solve(scene, o, c);
        EXPECT_LE(s.statistics.residual, 1e-6);
        return s.statistics.iterations;
    };
    const std::size_t jacobi = sweeps(Relaxation::jacobi, {}), seidel = sweeps(Relaxation::gauss_seidel, {}),
                      sor = sweeps({}, ClassicalRelaxation::sor), chebyshev = sweeps(Relaxation::chebyshev, {}),
                      cg = sweeps(Relaxation::cg, {}), gmres = sweeps(Relaxation::gmres, {});
    EXPECT_GT(jacobi, seidel);
    EXPECT_GT(seidel, sor);
    EXPECT_GT(sor, chebyshev);
    EXPECT_GT(chebyshev, cg);
    EXPECT_GE(cg, gmres);
    sweeps({}, ClassicalRelaxation::direct);
    EXPECT_LT(sweeps(Relaxation::southwell, {}), jacobi);
}

TEST(Classical, AMatrixThatExceedsMemoryIsRejected) {
    const Scene scene = built_scene("blocker", {{"h", "0.7"}});
    SolveOptions options{.method = Method::matrix, .mesh_size = 0.5};
    EXPECT_TRUE(try_to_solve(scene, options, raw));
    options.memory_limit_bytes = 1 << 20;  // less than any process uses
    const Result<Solution> none = try_to_solve(scene, options, raw);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::limit);
}

}  // namespace
}  // namespace exitance
