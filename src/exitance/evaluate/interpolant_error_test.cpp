#include "exitance/evaluate/interpolant_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/calibration/numbers.hpp"
#include "exitance/error/area_samples.hpp"
#include "exitance/evaluate/interpolant.hpp"
#include "exitance/scene/add_polygon.hpp"
#include "exitance/scene/locator.hpp"
#include "exitance/transport/light_rooms.hpp"
#include "support/built_scene.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

/// RMS of B - B_exact of the exported mesh at points uniform in area, relative to the mean of B_exact - M; of E if
/// nothing reflects. Direct light alone: the full function is exact.
double error_of_export(const Solution& solution) {
    const std::vector<ProbePoint> points = points_uniform_in_area(solution.scene, 20'000, 7);
    const RadiosityFunction function(solution);
    const std::vector<Light> exact = function.at(points), exported = function.interpolant_at(points);
    const Locator locator(solution.scene);
    double square = 0, square_of_E = 0, reflected = 0, arriving = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Spectrum off = exported[i].irradiance - exact[i].irradiance;
        const Spectrum rho = solution.scene.material(locator.find(points[i].x, points[i].n)).reflectance;
        square += squared(rho * off) / bands, square_of_E += squared(off) / bands;
        reflected += mean(rho * exact[i].irradiance), arriving += mean(exact[i].irradiance);
    }
    const auto n = static_cast<double>(points.size());
    return reflected > 0 ? std::sqrt(square / n) / (reflected / n) : std::sqrt(square_of_E / n) / (arriving / n);
}

struct Case {
    const char* family;
    std::map<std::string, std::string> parameters;
    double error;
};

class InterpolantErrorOf : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Scenes, InterpolantErrorOf,
                         testing::Values(Case{"cornell", {}, 0.05}, Case{"cornell", {{"rot", "31.7,0.3,0.5,1"}}, 0.02},
                                         Case{"boxes", {{"scale", "0.001"}}, 0.02},
                                         Case{"tube", {{"rho", "0.1"}}, 0.03},
                                         Case{"blocker", {{"h", "0.7"}, {"shift", "1000,370,-210"}}, 0.02}));

TEST_P(InterpolantErrorOf, DirectLightIsReportedAsItIs) {
    const Scene scene = built_scene(GetParam().family, GetParam().parameters);
    const Solution solution = solved(scene, {.method = Method::matrix, .bounces = 0, .error = GetParam().error});
    const double error = error_of_export(solution);
    // Both errors are measured at points that have most of the error; each mean square is accurate to a fifth.
    ASSERT_TRUE(solution.statistics.relative_error_estimate_interpolant);
    EXPECT_NEAR(*solution.statistics.relative_error_estimate_interpolant, error, 0.2 * error);
}

TEST(InterpolantError, IsReportedWhereSharpSunlightNeedsTooManyElements) {
    // Elements that follow the borders of the columns' shadows to this error would be hundreds of thousands.
    const Scene scene = built_scene("colonnade", {{"columns", "2"}, {"rot", "31.7,0.3,0.5,1"}});
    constexpr int runs = 4;
    double told = 0, found = 0;  // mean squares
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        const Solution solution = solved(
            scene, {.method = Method::matrix, .bounces = 0, .error = 0.05, .error_interpolant = 1e-4, .seed = seed});
        EXPECT_LT(solution.interpolant.tree.leaves().size(),
                  40'000u);  // 20,000 elements, most of them as fans of triangles
        told += std::pow(*solution.statistics.relative_error_estimate_interpolant, 2) / runs;
        found += std::pow(error_of_export(solution), 2) / runs;
    }
    EXPECT_GT(std::sqrt(found), 1e-3);
    // Most of the error is on a hundredth of the area: its square is known to a third by each run.
    EXPECT_NEAR(std::sqrt(told), std::sqrt(found), 0.3 * std::sqrt(found));
}

TEST(InterpolantError, FindsLightThatAFitAtItsPlacesDoesNotSee) {
    // Half of a square of 1 m^2 is off by 1 W/m^2, and the fit reports no error.
    const Scene scene = box_scene(1, 1, 1, 0.5, 1);
    const Stage stage(scene);
    ElementFunction exact, interpolant;
    std::vector<InterpolatedLeaf> leaves;
    for (const Piece& piece : stage.pieces) leaves.push_back({exact.tree.add_root(piece.region, piece.patch)});
    exact.tree.split(leaves[0].element, Cut::u);
    for (ElementFunction* f : {&exact, &interpolant}) {
        f->tree = exact.tree;
        f->first_value.resize(f->tree.size(), 0);
        for (ElementId e : f->tree.leaves()) {
            f->first_value[e] = static_cast<std::uint32_t>(f->values.size());
            const bool is_off = f == &interpolant && e == *f->tree.children(leaves[0].element).begin();
            for (int k = 0; k < 4; ++k) f->add_value(Spectrum(is_off ? 3 : 2));
        }
    }
    const double error = interpolant_error(stage, interpolant, leaves, {exact, Spectrum()}, 1);
    const double right = 0.5 * std::sqrt(0.5 / 6);  // the error is rho 1 W/m^2 on half of one of the six faces
    EXPECT_NEAR(error, right, 0.1 * right);         // 1024 stratified places, a sixth of them on that face
}

/// A room with a small window below an overcast sky, and a closed room beside it, whose faces have x > 10.
Scene lit_and_closed_room() {
    SceneDescription d;
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.groups = {"all"};
    const auto face = [&](const std::vector<Point>& corners) { add_polygon(d, corners); };
    for (const double x : {0.0, 12.0}) {
        const double end = x + 4;
        face({{x, 0, 0}, {end, 0, 0}, {end, 4, 0}, {x, 4, 0}});
        face({{x, 0, 3}, {x, 4, 3}, {end, 4, 3}, {end, 0, 3}});
        face({{x, 4, 0}, {end, 4, 0}, {end, 4, 3}, {x, 4, 3}});
        face({{x, 0, 0}, {x, 4, 0}, {x, 4, 3}, {x, 0, 3}});
        face({{end, 0, 0}, {end, 0, 3}, {end, 4, 3}, {end, 4, 0}});
        const double left = x + 1.8, right = x + 2.2;
        face({{x, 0, 0}, {x, 0, 3}, {left, 0, 3}, {left, 0, 0}});
        face({{right, 0, 0}, {right, 0, 3}, {end, 0, 3}, {end, 0, 0}});
        face({{left, 0, 0}, {left, 0, 1.5}, {right, 0, 1.5}, {right, 0, 0}});
        face({{left, 0, 2}, {left, 0, 3}, {right, 0, 3}, {right, 0, 2}});
        if (x > 0) face({{left, 0, 1.5}, {left, 0, 2}, {right, 0, 2}, {right, 0, 1.5}});
    }
    SkyModel sky = overcast_sky();
    EXPECT_TRUE(sky.normalize());
    d.distant.domes = {{sky, Spectrum(100.0)}};
    return std::move(*make_scene(std::move(d)).scene);
}

TEST(Interpolant, DoesNotEvaluateLightAgainWhereRaysFoundNone) {
    const Scene scene = lit_and_closed_room();
    Stage stage(scene);
    stage.rooms = find_light_rooms(stage, 1, StopRequest());
    ASSERT_EQ(stage.rooms.count(), 2u);
    DirectProjection direct =
        project_direct_light(stage, {.mesh = {.edge = 2, .grading_levels = 0}, .tolerance = 0.3}, StopRequest());
    ElementFunction none;
    none.tree = direct.tree, none.first_value.resize(direct.tree.size(), 0);
    const auto is_closed = [](const ElementTree& tree, ElementId e) { return tree.patch(e).corner(0).x > 10; };
    std::vector<double> light_in(2, 1);
    // Elements of the closed room have noise, and values that no evaluation would give.
    for (ElementId e : direct.tree.leaves()) {
        none.first_value[e] = static_cast<std::uint32_t>(none.values.size());
        for (int i = 0; i < direct.tree.patch(e).corner_count(); ++i) none.add_value(Spectrum());
        if (!is_closed(direct.tree, e)) continue;
        ASSERT_EQ(max(direct.fit[e].mean), 0);
        light_in[stage.rooms.of(direct.tree, e)] = calibrated::dark_room;
        direct.fit[e].misfit_squared = direct.fit[e].noise_squared = 1;
        direct.fit[e].corners.fill(Spectrum(7));
    }
    InterpolantReport report;
    const InterpolantOptions options{.tolerance = 0.1, .light_in = light_in};
    const ElementFunction found = make_interpolant(stage, direct, none, Spectrum(), options, report, StopRequest());
    for (ElementId e : found.tree.leaves()) {
        if (!is_closed(found.tree, e)) continue;
        EXPECT_NEAR(found.at({e, found.tree.centre(e)})[0], 7, 1e-3);
    }
}

TEST(Interpolant, EvaluatesNoisyLightAgainInsteadOfSplitting) {
    const Scene scene = lit_and_closed_room();
    const Stage stage(scene);
    DirectProjection direct =
        project_direct_light(stage, {.mesh = {.edge = 2, .grading_levels = 0}, .tolerance = 0.3}, StopRequest());
    ElementFunction none;
    none.tree = direct.tree, none.first_value.resize(direct.tree.size(), 0);
    const auto closed_leaves = [](const ElementTree& tree) {
        std::vector<ElementId> out;
        for (ElementId e : tree.leaves())
            if (tree.patch(e).corner(0).x > 10) out.push_back(e);
        return out;
    };
    for (ElementId e : direct.tree.leaves()) {
        none.first_value[e] = static_cast<std::uint32_t>(none.values.size());
        for (int i = 0; i < direct.tree.patch(e).corner_count(); ++i) none.add_value(Spectrum());
    }
    // Rays seem to have found light in the closed room, which is all noise.
    const std::vector<ElementId> noisy = closed_leaves(direct.tree);
    for (ElementId e : noisy) {
        direct.fit[e].misfit_squared = direct.fit[e].noise_squared = 100;
        direct.fit[e].corners.fill(Spectrum(7)), direct.fit[e].mean = Spectrum(7);
    }
    InterpolantReport report;
    const ElementFunction found =
        make_interpolant(stage, direct, none, Spectrum(), {.tolerance = 1}, report, StopRequest());
    EXPECT_EQ(closed_leaves(found.tree).size(), noisy.size());
    for (ElementId e : closed_leaves(found.tree)) EXPECT_NEAR(found.at({e, found.tree.centre(e)})[0], 0, 1e-3);
}

}  // namespace
}  // namespace exitance
