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
    demand.light = 0.002;  // light of a room that is dark except for this face, whose light is up to 0.1
    const double truth = error(other.gather(b, true, demand, dim, progress, StopRequest()));
    EXPECT_LT(dim.rays, usual.rays / 2);
    EXPECT_LT(truth, 1.5 * std::hypot(dim.whole.noise, dim.whole.interpolation));
}

/// A room with b = 1 W/m^2 and many plates, each with a leg that is open where it stands on the plate. Below the leg a
/// plate is dark, but nobody sees it; around it, its irradiance is 1 less the form factors of the leg's sides.
TEST(LocalPass, LightAroundOpenLegsDoesNotFollowTheDarknessBelowThem) {
    constexpr int a_row = 32;
    constexpr double plate = 0.5, half_leg = 0.03, top = 0.2, spacing = 2;
    std::vector<test::Face> faces = test::closed_box({-2, -2, -1}, {a_row * spacing + 4, a_row * spacing + 4, 5});
    const std::size_t room_faces = faces.size();
    const auto square = [&](const Point& middle, double half) {
        faces.push_back({{middle + Vec3{-half, -half, 0}, middle + Vec3{half, -half, 0}, middle + Vec3{half, half, 0},
                          middle + Vec3{-half, half, 0}}});
        return faces.back().corners;
    };
    for (int k = 0; k < a_row * a_row; ++k) {
        const Point middle{spacing * (k % a_row), spacing * (k / a_row), 0};
        square(middle, plate / 2);
        const std::vector<Point> lid = square(middle + Vec3{0, 0, top}, half_leg);
        const Vec3 down{0, 0, -top};
        for (std::size_t i = 0; i < 4; ++i)
            faces.push_back({{lid[i] + down, lid[(i + 1) % 4] + down, lid[(i + 1) % 4], lid[i]}});
    }
    const Scene scene = test::make(faces);
    const Stage stage(scene);
    const auto is_of_room = [&](RegionId region) {
        return scene.regions()[region].surfaces[0].value < static_cast<std::uint32_t>(room_faces);
    };
    const PointwiseLight b{[&](RegionId region, const Point&) { return Spectrum(is_of_room(region) ? 1.0 : 0.0); }};
    LocalPass pass(stage, {.edge = 100, .grading_levels = 0}, 1);
    Progress progress;
    const StopRequest stop;
    LocalPassReport report;
    const ElementFunction E =
        pass.gather(b, false, {.rays = {.average = 256}, .noise = 0.01, .tolerance = 0.02}, report, progress, stop);
    double squares = 0, count = 0;
    std::size_t leaves = 0;
    for (ElementId e : E.tree.leaves()) {
        const RegionId region = E.tree.region(e);
        const Normal& n = scene.regions()[region].plane.n;
        if (is_of_room(region) || n.z < 0.5 || E.tree.patch(e).centre().z > 0.5 * top) continue;  // not on a plate
        ++leaves;
        const std::uint32_t first = scene.regions()[region].surfaces[0].value;
        RandomStream random(1, Stream::mesh, e.value);
        for (int k = 0; k < 8; ++k) {
            const double s = random.uniform(), t = random.uniform();
            const Vec2 uv = E.tree.uniform(e, s, t);
            const Point x = E.tree.patch(e).at(uv);
            const Point middle{spacing * std::round(x.x / spacing), spacing * std::round(x.y / spacing), 0};
            if (std::max(std::abs(x.x - middle.x), std::abs(x.y - middle.y)) < half_leg) continue;
            double exact = 1;
            for (std::uint32_t side = first + 2; side < first + 6; ++side) {
                const SurfaceId id(side);
                if (dot(x - faces[side].corners[0], scene.regions()[scene.surfaces()[id].region].plane.n) > 0)
                    exact -= point_to_polygon(x, n, scene.outline(id));
            }
            squares += E.tree.area(e) * std::pow(0.5 * (E.at({e, uv})[0] - exact), 2), count += E.tree.area(e);
        }
    }
    EXPECT_EQ(leaves, a_row * a_row) << "plates need no cuts";
    // One linear element of a plate leaves the spread of the light around its leg, 0.04.
    EXPECT_LT(std::sqrt(squares / count), 0.05);
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
