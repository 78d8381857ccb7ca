#include <gtest/gtest.h>

#include <cmath>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/reference/path_reference.hpp"
#include "support/solved.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A room with a lamp under its ceiling and a board below the lamp: hard shadows and reflections.
Scene room_with_board() {
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {2, 2, 2});
    const auto square = [](double lo, double hi, double z, bool up) {
        std::vector<Point> out{{lo, lo, z}, {hi, lo, z}, {hi, hi, z}, {lo, hi, z}};
        if (!up) std::swap(out[1], out[3]);
        return out;
    };
    faces.push_back({square(0.7, 1.3, 1.8, false), 10});
    faces.push_back({square(0.8, 1.2, 1, true)});
    faces.push_back({square(0.8, 1.2, 1, false)});
    return test::make(faces);
}

std::vector<ProbePoint> on_the_floor() {
    std::vector<ProbePoint> out;
    for (int i = 0; i < 64; ++i) out.push_back({{0.13 + 0.25 * (i % 8), 0.11 + 0.25 * (i / 8), 0}, {0, 0, 1}});
    return out;
}

TEST(DiscontinuityMethod, UsesADiscontinuityMeshAndAHierarchy) {
    const Scene scene = room_with_board();
    const Solution solution =
        solved(scene, {.method = Method::discontinuity, .error = 0.02, .error_interpolant = 0.03});
    EXPECT_FALSE(solution.statistics.elements_by_level.empty());
    EXPECT_EQ(solution.statistics.basis, "quadratic");
    EXPECT_FALSE(solution.discontinuity.empty());
    const std::vector<ProbePoint> points = on_the_floor();
    Progress progress;
    const auto truth = reference_light(scene, points, 1024, 1, progress, StopRequest());
    const RadiosityFunction light(solution);
    const auto error = [&](const std::vector<Light>& found) {
        double sum = 0, mean_light = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            sum += squared(found[i].irradiance - truth[i].irradiance) / static_cast<double>(bands);
            mean_light += mean(truth[i].irradiance) / static_cast<double>(points.size());
        }
        return std::sqrt(sum / static_cast<double>(points.size())) / mean_light;
    };
    EXPECT_LT(error(light.at(points)), 0.03);  // includes the noise of the path tracer
    EXPECT_LT(error(light.interpolant_at(points)), 0.045);
}

TEST(DiscontinuityMethod, UnlitRegionsHaveContactCurves) {
    std::vector<test::Face> faces{{{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}},
                                  {{{0.5, 0.5, 1}, {1.5, 0.5, 1}, {1.5, 1.5, 1}, {0.5, 1.5, 1}}},
                                  {{{0.5, 0.5, 1}, {0.5, 1.5, 1}, {1.5, 1.5, 1}, {1.5, 0.5, 1}}},
                                  {{{0.7, 0.7, 2}, {0.7, 1.3, 2}, {1.3, 1.3, 2}, {1.3, 0.7, 2}}, 10}};
    // A leg that touches the board's dark side.
    const std::vector<Vec2> leg{{0.9, 0.9}, {1.1, 0.9}, {1.1, 1.1}, {0.9, 1.1}};
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2 a = leg[i], b = leg[(i + 1) % 4];
        faces.push_back({{{a.x, a.y, 0}, {b.x, b.y, 0}, {b.x, b.y, 1}, {a.x, a.y, 1}}});
    }
    const Scene scene = test::make(faces);
    const Solution solution =
        solved(scene, {.method = Method::discontinuity, .error = 0.05, .error_interpolant = 0.05});
    int contacts = 0;
    for (const DiscontinuityCurve& c : solution.discontinuity.curves)
        contacts += c.cause == CurveCause::contact && scene.regions()[c.region].plane.n.z < -0.5 && c.a.z > 0.5;
    EXPECT_GE(contacts, 4);
    EXPECT_LT(solution.discontinuity.size(), 3000u);
}

TEST(DiscontinuityMethod, NumberOfBouncesIsSupported) {
    const Scene scene = room_with_board();
    const Solution once = solved(scene, {.method = Method::discontinuity, .bounces = 1, .error = 0.05});
    const Solution as_matrix = solved(scene, {.method = Method::matrix, .bounces = 1, .error = 0.05});
    const std::vector<ProbePoint> points = on_the_floor();
    const std::vector<Light> a = RadiosityFunction(once).at(points), b = RadiosityFunction(as_matrix).at(points);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(a[i].irradiance[0], b[i].irradiance[0], 1e-9);
}

}  // namespace
}  // namespace exitance
