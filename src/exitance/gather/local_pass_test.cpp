#include "exitance/gather/local_pass.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "exitance/base/random.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "support/built_scene.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A box in which only one face sends light, with b = 1 W/m^2. The irradiance is then a form factor.
class OneBrightFace : public testing::Test {
  protected:
    Scene scene = test::make(test::closed_box({}, {2, 1.5, 1}));
    Stage stage{scene};
    RegionId bright = scene.surfaces()[SurfaceId(5)].region;
    PointwiseLight b{[this](RegionId region, const Point&) { return Spectrum(region == bright ? 1.0 : 0.0); }};
    LocalPass pass{stage, {.edge = 0.8, .grading_levels = 0}, 1};
    static constexpr LocalPassDemand coarse = {.rays = {.average = 32}, .noise = 0.002, .tolerance = 0.002},
                                     fine = {.rays = {.average = 64}, .noise = 0.0007, .tolerance = 0.0007};

    ElementFunction gather(const LocalPassDemand& demand, LocalPassReport& report, bool fresh = false) {
        Progress progress;
        const StopRequest stop;
        report = {};
        return pass.gather(b, fresh, demand, report, progress, stop);
    }

    /// RMS over all surfaces of rho (E - exact), with rho = 0.5.
    double error(const ElementFunction& E) const {
        double sum = 0;
        for (ElementId e : E.tree.leaves()) {
            RandomStream random(1, Stream::mesh, e.value);
            const RegionId region = E.tree.region(e);
            for (int k = 0; k < 16; ++k) {
                const double s = random.uniform(), t = random.uniform();
                const Vec2 uv = E.tree.uniform(e, s, t);
                const double exact = region == bright
                                         ? 0
                                         : point_to_polygon(E.tree.patch(e).at(uv), scene.regions()[region].plane.n,
                                                            scene.outline(SurfaceId(5)));
                sum += E.tree.area(e) / 16 * std::pow(0.5 * (E.at({e, uv})[0] - exact), 2);
            }
        }
        return std::sqrt(sum / stage.area);
    }
};

TEST_F(OneBrightFace, IsGatheredWithTheReportedError) {
    for (const LocalPassDemand& demand : {coarse, fine}) {
        LocalPassReport report;
        const double truth = error(gather(demand, report));
        const double told = std::hypot(report.whole.noise, report.whole.interpolation);
        // Noise is estimated from four quarters of the rays, interpolation from nine nodes: both to about a third.
        EXPECT_LT(truth, 1.5 * told);
        EXPECT_GT(truth, 0.6 * told);
        EXPECT_LT(truth, 1.5 * std::hypot(demand.noise, demand.tolerance));
    }
}

TEST_F(OneBrightFace, HasTheVarianceEstimatedFromQuartersAndHalves) {
    const Point x = {0.9, 0.6, 0.4};
    const Normal n = normalized(Vec3{0.3, 0.2, 0.1} - scene.regions()[bright].plane.n);
    constexpr unsigned gathers = 1000;
    GatherWorkspace workspace;
    double told = 0, by_chance = 0;  // logarithms of the estimated over the actual variance
    for (const unsigned rays : {32u, 64u, 128u, 256u}) {
        double sum = 0, square = 0, quarters = 0, halves = 0;
        for (unsigned k = 0; k < gathers; ++k) {
            const Gathered g = gather_reflected(stage, x, n, RegionId(), rays, k, b, workspace);
            sum += g.irradiance[0], square += g.irradiance[0] * g.irradiance[0];
            quarters += g.quarters[0], halves += g.halves[0];
        }
        const double variance = square - sum * sum / gathers;
        told += 0.25 * std::log(halves / quarters * halves / variance);
        by_chance += 0.25 * std::log(quarters / variance);
    }
    // Numbers of rays that are powers of 4 fill the square more evenly than twice these numbers. One power law
    // describes both to about a third.
    EXPECT_NEAR(std::exp(told), 1, 0.35);
    EXPECT_GT(std::exp(by_chance), 1.5);
}

TEST_F(OneBrightFace, IsNotGatheredAgainIfAccurateEnough) {
    LocalPassReport first, same, finer, anew;
    const ElementFunction once = gather(coarse, first);
    const ElementFunction twice = gather(coarse, same);
    EXPECT_EQ(same.rays, 0u);
    EXPECT_EQ(once.values, twice.values);
    const ElementFunction better = gather(fine, finer);
    EXPECT_LT(error(better), 0.7 * error(once));
    // Other light: everything is gathered again, on the present mesh, with the numbers of rays used before.
    gather(fine, anew, true);
    EXPECT_GT(anew.rays, finer.rays / 2);
    EXPECT_LT(anew.rays, 2 * (first.rays + finer.rays));
}

TEST_F(OneBrightFace, AChangeOfTheLightIsGatheredByFewRays) {
    LocalPassReport first, second;
    const ElementFunction dim = gather(fine, first);
    const PointwiseLight change{
        [this](RegionId region, const Point&) { return Spectrum(region == bright ? 0.05 : 0.0); }};
    LocalPassDemand demand = fine;
    demand.change = &change;
    ElementFunction brighter = gather(demand, second);
    EXPECT_LT(second.rays, first.rays / 4);
    // The error is as before, plus noise of the change that rays for the whole light would have too: within the
    // allowance.
    for (std::array<float, bands>& value : brighter.values)
        for (float& v : value) v /= 1.05F;
    EXPECT_LT(error(brighter), 1.2 * error(dim) + 0.2 * fine.noise);
    EXPECT_GT(second.whole.noise, 0.9 * first.whole.noise);
}

TEST_F(OneBrightFace, InheritsLargerElementsIfStoppedEarly) {
    LocalPassReport whole;
    const double least = error(gather(fine, whole));
    for (const double share : {0.7, 0.0}) {
        std::atomic<std::size_t> read = 0;
        StopRequest stop;
        const PointwiseLight until_stopped{[&](RegionId region, const Point&) {
            if (static_cast<double>(++read) > share * static_cast<double>(whole.rays)) stop.interrupt();
            return Spectrum(region == bright ? 1.0 : 0.0);
        }};
        LocalPass stopped(stage, {.edge = 0.8, .grading_levels = 0}, 1);
        Progress progress;
        LocalPassReport report;
        const ElementFunction E = stopped.gather(until_stopped, true, fine, report, progress, stop);
        // True if stopped before every element of the first mesh was gathered.
        EXPECT_EQ(report.interrupted, share == 0);
        if (report.interrupted) continue;
        EXPECT_LT(report.rays, whole.rays);
        EXPECT_LT(error(E), 3 * least);
        EXPECT_LT(error(E), 1.5 * std::hypot(report.whole.noise, report.whole.interpolation));
    }
}

TEST_F(OneBrightFace, MayBeNoisierWhereItIsMuchBrighter) {
    LocalPassReport usual, dim;
    LocalPassDemand demand = fine;
    demand.noise = 1e-4;
    gather(demand, usual);
    LocalPass other(stage, {.edge = 0.8, .grading_levels = 0}, 1);  // this pass has not gathered before
    Progress progress;
    demand.light = 0.002;  // of a room that is dark except for this face's light, which is up to 0.1 elsewhere
    const double truth = error(other.gather(b, true, demand, dim, progress, StopRequest()));
    EXPECT_LT(dim.rays, usual.rays / 2);
    EXPECT_LT(truth, 1.5 * std::hypot(dim.whole.noise, dim.whole.interpolation));
}

/// A table's leg that is open below stands on the floor of a room with b = 1 W/m^2. The floor inside of the leg is
/// dark, but nobody sees it. Next to the leg the floor's irradiance is 1 less the form factors of the leg's sides.
TEST(LocalPass, LightNextToAnOpenLegIsThatOfTheFloorAroundIt) {
    const Point lowest{0.93, 0.61, 0}, highest{1.05, 0.73, 0.4};
    std::vector<test::Face> faces = test::closed_box({}, {2, 1.5, 1});
    const std::size_t room_faces = faces.size();
    const auto side = [&](const Point& a, const Point& b) {
        faces.push_back({{a, b, {b.x, b.y, highest.z}, {a.x, a.y, highest.z}}});
    };
    const Point right{highest.x, lowest.y, 0}, back{highest.x, highest.y, 0}, left{lowest.x, highest.y, 0};
    side(lowest, right), side(right, back), side(back, left), side(left, lowest);
    const double z = highest.z;
    faces.push_back({{{lowest.x, lowest.y, z}, {right.x, right.y, z}, {back.x, back.y, z}, {left.x, left.y, z}}});
    const Scene scene = test::make(faces);
    const Stage stage(scene);
    std::vector<bool> is_leg(scene.regions().size(), false);
    for (std::size_t i = room_faces; i < faces.size(); ++i)
        is_leg[scene.surfaces()[SurfaceId(static_cast<std::uint32_t>(i))].region.value] = true;
    const PointwiseLight b{[&](RegionId region, const Point&) { return Spectrum(is_leg[region.value] ? 0.0 : 1.0); }};
    LocalPass pass(stage, {.edge = 0.4, .grading_levels = 0}, 1);
    Progress progress;
    const StopRequest stop;
    LocalPassReport report;
    const ElementFunction E =
        pass.gather(b, false, {.rays = {.average = 256}, .noise = 0.002, .tolerance = 0.002}, report, progress, stop);
    double squares = 0, count = 0;
    for (ElementId e : E.tree.leaves()) {
        RandomStream random(1, Stream::mesh, e.value);
        for (int k = 0; k < 16; ++k) {
            const double s = random.uniform(), t = random.uniform();
            const Vec2 uv = E.tree.uniform(e, s, t);
            const Point x = E.tree.patch(e).at(uv);
            const Normal& n = scene.regions()[E.tree.region(e)].plane.n;
            const bool is_inside = x.x > lowest.x && x.x < highest.x && x.y > lowest.y && x.y < highest.y;
            if (std::abs(x.z) > 1e-9 || n.z < 0.5 || is_inside) continue;
            double exact = 1;
            for (std::size_t i = room_faces; i + 1 < faces.size(); ++i) {
                const auto id = SurfaceId(static_cast<std::uint32_t>(i));
                if (dot(x - faces[i].corners[0], scene.regions()[scene.surfaces()[id].region].plane.n) > 0)
                    exact -= point_to_polygon(x, n, scene.outline(id));
            }
            squares += E.tree.area(e) * std::pow(0.5 * (E.at({e, uv})[0] - exact), 2), count += E.tree.area(e);
        }
    }
    // Noise and interpolation may each have 0.002, and steep light at the leg's foot is smoothed.
    EXPECT_LT(std::sqrt(squares / count), 0.005);
    EXPECT_LT(report.whole.interpolation, 0.003);
}

TEST(LocalPass, GathersConstantLightExactly) {
    const Scene scene = box_scene(2, 1, 1.5, 0.5, 0);
    const Stage stage(scene);
    LocalPass pass(stage, {.edge = 0.7, .grading_levels = 1}, 1);
    Progress progress;
    const StopRequest stop;
    LocalPassReport report;
    const ElementFunction E =
        pass.gather(PointwiseLight([](RegionId, const Point&) { return Spectrum(2.0); }), true,
                    {.rays = {.average = 16}, .noise = 1e-3, .tolerance = 1e-3}, report, progress, stop);
    for (const auto& value : E.values) EXPECT_NEAR(value[0], 2, 1e-6);  // single precision
    EXPECT_EQ(report.whole.noise, 0);
    EXPECT_NEAR(report.whole.interpolation, 0, 1e-12);
}

}  // namespace
}  // namespace exitance
