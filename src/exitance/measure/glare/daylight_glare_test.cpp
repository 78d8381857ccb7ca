#include "exitance/measure/glare/daylight_glare.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/measure/glare/view_triangle.hpp"
#include "support/built_scene.hpp"
#include "support/checked_scene.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

const LightUnit lux(UnitChoice::lux, true);

/// A rigid motion and a scale: turned about the vertical, then scaled and moved.
struct Motion {
    double angle = 0, scale = 1;
    Vec3 shift{};

    Vec3 turned(const Vec3& d) const {
        const double c = std::cos(angle), s = std::sin(angle);
        return {c * d.x - s * d.y, s * d.x + c * d.y, d.z};
    }
    Point operator()(const Point& p) const { return scale * turned(p) + shift; }
};

/// A room of 4 x 6 x 3 m whose surfaces reflect `reflectance` and receive `irradiance`, with a luminous window of
/// `window` cd/m^2 in the wall y = 6, x from 1 to 3, z from 1 to 2.5, 1 mm before it.
Solution window_room(double window, double reflectance, double irradiance, const Motion& motion = {}) {
    SceneDescription d;
    d.photometric = true;
    d.materials = {{"wall", Spectrum(reflectance), Spectrum()},
                   {"window", Spectrum(), exitance_of_radiance(Spectrum(window))}};
    for (const double z : {0.0, 3.0}) d.points.insert(d.points.end(), {{0, 0, z}, {4, 0, z}, {4, 6, z}, {0, 6, z}});
    for (const Point& p : {Point{1, 5.999, 1}, {3, 5.999, 1}, {3, 5.999, 2.5}, {1, 5.999, 2.5}}) d.points.push_back(p);
    for (Point& p : d.points) p = motion(p);
    d.groups = {"room", "window"};
    for (const std::vector<std::uint32_t>& f : box_faces) d.faces.push_back({f, 0, 0, 0});
    d.faces.push_back({{8, 9, 10, 11}, 1, 1, 0});
    Solution s = even_solution(checked_scene(std::move(d)), irradiance);
    s.direct_share = Spectrum(1);
    return s;
}

DaylightGlare glare_of(const Solution& s, const Point& eye, const Normal& view, const GlareThreshold& limit = {}) {
    const RadiosityFunction light(s);
    return find_daylight_glare(light, {"", eye, view}, lux, limit);
}

/// E_v, solid angle and light-weighted centre of the window, by a raster of 1000 x 1000 points on it.
struct RasterWindow {
    double illuminance = 0, solid_angle = 0;
    Vec3 centre;

    RasterWindow(double luminance, const Point& eye, const Normal& view) {
        constexpr int n = 1000;
        const double area = 2 * 1.5 / (n * n);
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < n; ++k) {
                const Vec3 d = Point{1 + 2 * (i + 0.5) / n, 5.999, 1 + 1.5 * (k + 0.5) / n} - eye;
                const double angle = area * d.y / std::pow(norm(d), 3), cosine = dot(normalized(d), view);
                if (cosine <= 0) continue;
                solid_angle += angle, illuminance += luminance * angle * cosine, centre += angle * normalized(d);
            }
    }
};

TEST(DaylightGlare, OfAWindowInABlackRoomAgreesWithARaster) {
    const Solution s = window_room(6000, 0, 0);
    struct Case {
        Point eye;
        Normal view;
    };
    for (const auto& [eye, view] : {Case{{2, 1, 1.2}, {0, 1, 0}},
                                    {{2, 4.5, 1.2}, {0, 1, 0}},
                                    {{1, 4, 1.2}, normalized({1, 1, -0.3})},
                                    {{3.5, 5, 1.7}, normalized({-1, 0.2, 0})}}) {
        const RasterWindow raster(6000, eye, view);
        const DaylightGlare glare = glare_of(s, eye, view);
        ASSERT_EQ(glare.sources.size(), 1u);
        EXPECT_EQ(glare.names[0], "window");
        // The raster's error is below 1e-5, that of its edge along the horizon of the last eye 1e-3.
        EXPECT_NEAR(glare.sources[0].solid_angle / raster.solid_angle, 1, 2e-3);
        EXPECT_NEAR(glare.vertical_illuminance / raster.illuminance, 1, 2e-3);
        EXPECT_NEAR(glare.mean_luminance / (6000 * raster.solid_angle / (2 * pi)), 1, 2e-3);
        const double term = 6000.0 * 6000 * raster.solid_angle / std::pow(daylight_position(view, raster.centre), 2);
        EXPECT_NEAR(glare.probability(), daylight_glare_probability(raster.illuminance, term), 1e-3);
    }
}

TEST(DaylightGlare, IsInvariantToTurningMovingAndScaling) {
    const auto rated = [](const Motion& motion) {
        return glare_of(window_room(6000, 0.5, 900, motion), motion({1.2, 3.3, 1.2}),
                        normalized(motion.turned({0.3, 1, 0.1})));
    };
    const DaylightGlare still = rated({});
    for (const Motion& motion : {Motion{1.1}, Motion{-2.5, 1, {1000, -300, 20}}, Motion{0.4, 25}, Motion{3, 0.04}}) {
        const DaylightGlare moved = rated(motion);
        EXPECT_NEAR(moved.sources.at(0).solid_angle / still.sources.at(0).solid_angle, 1, 1e-6);
        EXPECT_NEAR(moved.vertical_illuminance / still.vertical_illuminance, 1, 1e-4);
        EXPECT_NEAR(moved.probability(), still.probability(), 1e-4);
    }
}

TEST(DaylightGlare, InUniformSurroundingsIsThatOfOneSource) {
    // Every surface sends 9000 x 0.5 / pi = 1432 cd/m^2; the window too.
    const double luminance = 9000 * 0.5 / pi;
    const Solution s = window_room(luminance, 0.5, 9000);
    const DaylightGlare below = glare_of(s, {2, 1, 1.2}, {0, 1, 0});
    EXPECT_EQ(below.sources.size(), 0u) << "2000 cd/m^2 are not reached";
    EXPECT_NEAR(below.mean_luminance / luminance, 1, 1e-4);
    // Each part counts by its middle, with an error of the square of its extent, 0.05 rad.
    EXPECT_NEAR(below.vertical_illuminance / (pi * luminance), 1, 2e-3);
    const DaylightGlare above = glare_of(s, {2, 1, 1.2}, {0, 1, 0}, {0.9, true});
    ASSERT_EQ(above.sources.size(), 1u);
    EXPECT_NEAR(above.sources[0].solid_angle / (2 * pi), 1, 1e-6);
    // The centre of all parts is on the line of sight, where P = 1, within the size of parts.
    EXPECT_NEAR(above.sources[0].position, 1, 0.02);
}

TEST(DaylightGlare, SurfacesAreSourcesAboveTheThreshold) {
    const Solution s = window_room(100, 0.8, 9000);
    EXPECT_EQ(glare_of(s, {2, 1, 1.2}, {0, 1, 0}, {9000 * 0.8 / pi + 1, false}).sources.size(), 0u);
    EXPECT_EQ(glare_of(s, {2, 1, 1.2}, {0, 1, 0}, {9000 * 0.8 / pi - 1, false}).sources.size(), 1u);
}

/// Nothing but a sun of `normal` lx perpendicular to it.
Solution sun_alone(double normal, const Normal& towards) {
    SceneDescription d;
    d.photometric = true;
    d.materials = {{"ground", Spectrum(), Spectrum()}};
    d.points = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    d.groups = {"ground"};
    d.faces.push_back({{0, 1, 2, 3}, 0, 0, 0});
    d.distant.discs = {{towards, 0.533 / 2 * pi / 180, Spectrum(normal)}};
    Solution s = even_solution(checked_scene(std::move(d)), 0);
    s.direct_share = Spectrum(1);
    return s;
}

TEST(DaylightGlare, OfTheSunAloneAgreesWithTheClosedForm) {
    const Normal towards = normalized({0.2, 1, 0.5}), view{0, 1, 0};
    for (const double normal : {500.0, 80'000.0}) {
        const Solution s = sun_alone(normal, towards);
        const DaylightGlare glare = glare_of(s, {0, 0, 1.2}, view);
        ASSERT_EQ(glare.sources.size(), 1u);
        EXPECT_EQ(glare.names[0], "sun");
        const double half = 0.533 / 2 * pi / 180, omega = 2 * pi * (1 - std::cos(half));
        EXPECT_NEAR(glare.sources[0].solid_angle / omega, 1, 1e-3);
        EXPECT_NEAR(glare.sources[0].luminance / (normal / omega), 1, 1e-3);
        const double E_v = normal * dot(towards, view), P = daylight_position(view, towards);
        EXPECT_NEAR(glare.vertical_illuminance / E_v, 1, 1e-3);
        EXPECT_NEAR(glare.probability(), daylight_glare_probability(E_v, normal * normal / omega / (P * P)), 1e-3);
    }
    const Solution behind = sun_alone(80'000, normalized({0.2, -1, 0.5}));
    EXPECT_DOUBLE_EQ(glare_of(behind, {0, 0, 1.2}, view).probability(), 0);
}

TEST(DaylightGlare, IsTheSameOnAnyNumberOfThreads) {
    const Solution s = window_room(6000, 0.5, 900);
    set_threads(1);
    const double one = glare_of(s, {1.2, 3.3, 1.2}, {0, 1, 0}).probability();
    set_threads(3);
    EXPECT_EQ(glare_of(s, {1.2, 3.3, 1.2}, {0, 1, 0}).probability(), one);
    set_threads(0);
}

TEST(ViewTriangles, CoverAPolygonWithoutGaps) {
    const std::vector<Vec3> square{{-3, -3, 1}, {3, -3, 1}, {3, 3, 1}, {-3, 3, 1}};
    const double exact = solid_angle(square[0], square[1], square[2]) + solid_angle(square[0], square[2], square[3]);
    std::vector<ViewTriangle> parts;
    add_view_triangles(square, 0.05, parts);
    double sum = 0, quarters = 0;
    for (const ViewTriangle& t : parts) {
        EXPECT_LE(t.extent(), 0.05);
        sum += t.solid_angle();
        for (const ViewTriangle& q : t.quarters()) quarters += q.solid_angle();
    }
    EXPECT_NEAR(sum, exact, 1e-9);
    EXPECT_NEAR(quarters, exact, 1e-9);
}

}  // namespace
}  // namespace exitance
