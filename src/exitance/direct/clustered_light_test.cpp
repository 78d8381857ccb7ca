#include "exitance/direct/clustered_light.hpp"

#include <gtest/gtest.h>

#include "exitance/base/parallel.hpp"
#include "exitance/error/area_samples.hpp"
#include "exitance/scene/locator.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// Two furnished rooms, one below a panel of 200 emitting triangles.
struct Panel {
    Panel() : scene(built_scene("carpet", {{"u", "20"}, {"v", "10"}, {"cuts", "1"}, {"books", "0"}})), stage(scene) {}
    Scene scene;
    Stage stage;
    ClusteredLight::Workspace workspace;
};

TEST(ClusteredLight, DiffersFromExactLightByAtMostTheAllowedError) {
    Panel panel;
    const Locator locator(panel.scene);
    for (const double asked : {0.1, 0.01}) {
        double miss = 0, allowed = 0, told = 0, all = 0, rays = 0;
        int count = 0;
        for (const ProbePoint& p : points_uniform_in_area(panel.scene, 150, 3)) {
            const SurfaceId surface = locator.find(p.x, p.n);
            if (surface.is_none()) continue;
            const RegionId region = panel.scene.surfaces()[surface].region;
            const double exact = mean(panel.stage.direct.irradiance(p.x, p.n, region, panel.workspace.exact));
            const double absolute = 0.1 * asked;  // W/m^2; the irradiance is between 0 and 8
            const ClusteredLight::Estimate found =
                panel.stage.clustered.by_clusters(p.x, p.n, region, {asked, absolute}, panel.workspace);
            miss += std::pow(mean(found.irradiance) - exact, 2), told += found.variance;
            allowed += std::pow(asked * exact + absolute, 2);
            all += exact, rays += static_cast<double>(found.rays), ++count;
        }
        EXPECT_GT(all / count, 0.2);
        EXPECT_LT(miss, allowed);
        EXPECT_LT(miss, 1.5 * told);  // compared with the reported error
        EXPECT_LT(told, 2 * allowed);
        EXPECT_LT(rays / count, 25 / asked);  // the number of rays grows at most in proportion to the accuracy
    }
}

TEST(ClusteredLight, IsReproducibleAtOnePoint) {
    Panel panel;
    const Point x{2, 2, 0.4};
    const Normal up{0, 0, 1};
    const auto look = [&](ClusteredLight::Workspace& workspace) {
        return panel.stage.clustered.by_clusters(x, up, RegionId(), {0.01, 0}, workspace).irradiance;
    };
    const Spectrum first = look(panel.workspace);
    panel.stage.clustered.by_clusters({5, 2, 1}, up, RegionId(), {0.01, 0}, panel.workspace);
    ClusteredLight::Workspace other;
    EXPECT_EQ(look(panel.workspace), first);
    EXPECT_EQ(look(other), first);
    EXPECT_GT(max(first), 0);
}

TEST(ClusteredLight, IsBitIdenticalToExactLightWithFewEmitters) {
    const Scene scene = built_scene("office", {{"nx", "2"}, {"ny", "1"}, {"nfurn", "1"}});
    const Stage stage(scene);
    ClusteredLight::Workspace workspace;
    const Point x{2, 2, 0};
    const ClusteredLight::Estimate found = stage.clustered.at(x, {0, 0, 1}, RegionId(), {0.5, 0}, workspace);
    EXPECT_FALSE(stage.clustered.is_possible());
    EXPECT_EQ(found.irradiance, stage.direct.irradiance(x, {0, 0, 1}, RegionId(), workspace.exact));
    EXPECT_EQ(found.variance, 0);
}

TEST(EmitterTree, ReportsTheErrorOfItsClusters) {
    Panel panel;
    const EmitterTree& tree = panel.stage.clustered.tree();
    ASSERT_GT(tree.sources().size(), 100u);  // some neighbours are coplanar and merged
    double miss = 0, told = 0;
    for (const ProbePoint& p : points_uniform_in_area(panel.scene, 200, 4)) {
        EmitterTree::Cut all, some;
        tree.cut({p.x, p.n, RegionId()}, 1e-9, 0, all), tree.cut({p.x, p.n, RegionId()}, 0.1, 0, some);
        if (all.light == 0) continue;
        EXPECT_LE(some.terms.size(), 200u);
        EXPECT_LE(some.error, 0.1 * some.light + 1e-12);
        miss += std::pow(some.light / all.light - 1, 2), told += std::pow(some.error / all.light, 2);
    }
    EXPECT_GT(told, 0);
    EXPECT_LT(miss, told);
}

TEST(EmitterTree, ContainsEverySourceOnce) {
    Panel panel;
    const EmitterTree& tree = panel.stage.clustered.tree();
    std::vector<int> seen(tree.sources().size());
    double power = 0;
    for (const EmitterTree::Node& node : tree.nodes()) {
        if (!node.is_leaf()) continue;
        EXPECT_EQ(node.last, node.first + 1);
        ++seen[node.first], power += node.power;
    }
    EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
    EXPECT_NEAR(power, tree.nodes().front().power, 1e-9 * power);
}

TEST(ClusteredLight, ProjectionIsBitIdenticalOnAnyNumberOfThreads) {
    Panel panel;
    const StopRequest stop;
    std::vector<Spectrum> first;
    for (const int count : {1, 2, 3}) {
        set_threads(count);
        const DirectProjection light =
            project_direct_light(panel.stage, {.mesh = {1, 0}, .tolerance = 0.3, .max_depth = 1}, stop);
        std::vector<Spectrum> means;
        for (ElementId e : light.tree.leaves()) means.push_back(light.fit[e].mean);
        if (first.empty()) first = means;
        EXPECT_EQ(means, first) << count;
    }
    set_threads(0);
}

TEST(ClusteredLight, IsNotEvaluatedAfterAStop) {
    Panel panel;
    StopRequest stop;
    stop.interrupt();
    const DirectProjectionOptions options{.mesh = {1, 0}, .tolerance = 1e-3};
    const DirectProjection light = project_direct_light(panel.stage, options, stop);
    EXPECT_EQ(light.tree.size(), panel.stage.make_elements(options.mesh, &stop).size());  // nothing is split
}

}  // namespace
}  // namespace exitance
