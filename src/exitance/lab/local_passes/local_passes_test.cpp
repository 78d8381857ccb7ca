#include "exitance/lab/local_passes/local_passes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/reference/path_reference.hpp"
#include "support/built_scene.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A floor, a table above it, and a lamp: a penumbra on the floor.
Scene table_and_lamp() {
    const auto square = [](double half, double z, bool up) {
        std::vector<Point> out{{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
        if (!up) std::swap(out[1], out[3]);
        return out;
    };
    return test::make(
        {{square(2, 0, true)}, {square(0.5, 0.8, true)}, {square(0.5, 0.8, false)}, {square(0.4, 2, false), 10}});
}

LineHierarchyOptions coarse() {
    LineHierarchyOptions out;
    out.threshold = 2e-3, out.min_area = 1e-3;
    return out;
}

std::vector<std::array<float, bands>> values_of(const Scene& scene, LocalPassRule rule) {
    const Stage stage(scene);
    LineHierarchy hierarchy(stage, coarse());
    Progress progress;
    EXPECT_TRUE(hierarchy.solve(progress, StopRequest()));
    LocalPassWork work;
    return run_local_pass(hierarchy, rule, work, StopRequest()).values;
}

TEST(LineHierarchy, AFurnaceIsUniform) {
    const double rho = 0.5;
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {2, 1, 1});
    for (test::Face& face : faces) face.exitance = 1;
    const Scene scene = test::make(faces);
    const Stage stage(scene);
    LineHierarchy hierarchy(stage, coarse());
    Progress progress;
    ASSERT_TRUE(hierarchy.solve(progress, StopRequest()));
    for (const LocalPassRule rule :
         {LocalPassRule::a, LocalPassRule::b, LocalPassRule::c, LocalPassRule::d, LocalPassRule::e}) {
        LocalPassWork work;
        const SixNodeMesh mesh = run_local_pass(hierarchy, rule, work, StopRequest());
        double area = 0, sum = 0;
        for (std::uint32_t t = 0; t < mesh.size(); ++t)
            area += mesh.area(t), sum += mesh.area(t) * mesh.at(t, {1.0 / 3, 1.0 / 3})[0];
        EXPECT_NEAR(area, 10, 1e-6);
        EXPECT_NEAR(sum / area, 1 / (1 - rho), 0.05 / (1 - rho)) << static_cast<int>(rule);
    }
}

TEST(LocalPasses, RecomputedFormFactorsAreMoreAccurate) {
    const Scene scene = table_and_lamp();
    const Stage stage(scene);
    LineHierarchy hierarchy(stage, coarse());
    Progress progress;
    ASSERT_TRUE(hierarchy.solve(progress, StopRequest()));
    std::vector<ProbePoint> points;
    for (int i = 0; i < 81; ++i) points.push_back({{-1.9 + 0.47 * (i % 9), -1.87 + 0.46 * (i / 9), 0}, {0, 0, 1}});
    const auto truth = reference_light(scene, points, 256, 1, progress, StopRequest());
    const auto error = [&](LocalPassRule rule) {
        LocalPassWork work;
        const SixNodeMesh mesh = run_local_pass(hierarchy, rule, work, StopRequest());
        EXPECT_EQ(work.exact > 0, rule == LocalPassRule::e);
        EXPECT_EQ(work.form_factors > 0, rule != LocalPassRule::a);
        EXPECT_EQ(work.rays > 0, rule == LocalPassRule::c || rule == LocalPassRule::d);
        const SixNodeLocator locator(mesh, scene);
        double sum = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            sum += squared(locator.at(RegionId(0), points[i].x) - truth[i].irradiance);
        return std::sqrt(sum);
    };
    const double a = error(LocalPassRule::a), c = error(LocalPassRule::c), d = error(LocalPassRule::d),
                 e = error(LocalPassRule::e);
    EXPECT_LT(c, 0.6 * a);
    EXPECT_LT(std::abs(d - c), 0.25 * c);  // d is about as accurate as c, as published
    EXPECT_LT(e, c);
}

TEST(LocalPasses, LayersOmitLinksOfDarkNodes) {
    const Scene scene = table_and_lamp();
    const Stage stage(scene);
    Progress progress;
    std::size_t before = 0;
    for (const double dark : {0.0, 0.5}) {
        LineHierarchyOptions options = coarse();
        options.layers = true, options.dark = dark;
        LineHierarchy hierarchy(stage, options);
        ASSERT_TRUE(hierarchy.solve(progress, StopRequest()));
        for (const LineHierarchy::Link& l : hierarchy.links())
            EXPECT_FALSE(hierarchy.is_primary(l.source) && max(hierarchy.reflected(l.source)) == 0);
        EXPECT_TRUE(dark == 0 || hierarchy.links().size() < before);
        before = hierarchy.links().size();
    }
}

TEST(LocalPasses, AreBitwiseIndependentOfThreads) {
    const Scene scene = table_and_lamp();
    set_threads(1);
    const auto one = values_of(scene, LocalPassRule::d);
    set_threads(3);
    const auto three = values_of(scene, LocalPassRule::d);
    set_threads(0);
    EXPECT_FALSE(one.empty());
    EXPECT_EQ(one, three);
}

TEST(LocalPasses, DeliverTheExportedFunction) {
    const Scene scene = table_and_lamp();
    Progress progress;
    SolveOptions options{.method = Method::discontinuity, .error = 0.2};
    options.local_pass = LocalPassRule::d;
    const Result<Solution> solved = solve_scene(scene, options, progress, StopRequest());
    ASSERT_TRUE(solved);
    ASSERT_TRUE(solved->statistics.relative_error_estimate);
    EXPECT_TRUE(solved->statistics.converged);
    EXPECT_EQ(solved->statistics.relative_error_estimate, solved->statistics.relative_error_estimate_interpolant);
    EXPECT_TRUE(solved->direct_in_elements);
    EXPECT_EQ(solved->indirect.values, solved->interpolant.values);
    StopRequest stop;
    stop.interrupt();
    const Result<Solution> cut_short = solve_scene(scene, options, progress, stop);
    ASSERT_TRUE(cut_short);
    EXPECT_EQ(cut_short->statistics.stopped_by, StopReason::interrupt);
}

}  // namespace
}  // namespace exitance
