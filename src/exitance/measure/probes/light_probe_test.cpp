#include "exitance/measure/probes/light_probe.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "exitance/base/parallel.hpp"
#include "exitance/base/quadrature.hpp"
#include "support/built_scene.hpp"
#include "support/sample_solution.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

std::vector<LightProbe> probes_of(const Solution& s, const std::vector<Point>& points, unsigned rays = 1024) {
    Progress progress;
    const StopRequest stop;
    return light_probes(RadiosityFunction(s), points, rays, progress, stop);
}

SolveOptions demand(double error) {
    SolveOptions options;
    options.error = error;
    return options;
}

/// Calls visit(w, weight) for a rule that is exact up to degree 31 on the sphere.
template <class Visit>
void integrate_over_sphere(const Visit& visit) {
    constexpr int rows = 16;
    const LineRule heights = gauss_legendre(rows);
    for (std::size_t i = 0; i < heights.size(); ++i)
        for (int k = 0; k < 2 * rows; ++k) {
            const double z = 2 * heights.nodes[i] - 1, r = std::sqrt(1 - z * z), angle = pi * k / rows;
            visit(Vec3{r * std::cos(angle), r * std::sin(angle), z}, 2 * pi * heights.weights[i] / rows);
        }
}

std::vector<Normal> some_directions(int count) {
    std::mt19937 random(11);
    std::normal_distribution<double> number;
    std::vector<Normal> out;
    for (int i = 0; i < count; ++i) out.push_back(normalized(Vec3{number(random), number(random), number(random)}));
    return out;
}

/// A solution with uniform irradiance in its elements; emitters also emit.
Solution even_light(Scene scene, double irradiance) {
    Solution s = even_solution(std::move(scene), irradiance, 20);
    s.bounces = -1;
    return s;
}

TEST(Harmonics, AreOrthonormalAndInTheDocumentedOrder) {
    Harmonics<Harmonics<double>> product{};
    integrate_over_sphere([&](const Vec3& w, double weight) {
        const Harmonics<double> Y = harmonics_at(w);
        for (std::size_t i = 0; i < harmonic_count; ++i)
            for (std::size_t j = 0; j < harmonic_count; ++j) product[i][j] += weight * Y[i] * Y[j];
    });
    for (std::size_t i = 0; i < harmonic_count; ++i)
        for (std::size_t j = 0; j < harmonic_count; ++j) EXPECT_NEAR(product[i][j], i == j ? 1 : 0, 1e-12);
    EXPECT_GT(harmonics_at({0, 1, 0})[1], 0.48);
    EXPECT_GT(harmonics_at({0, 0, 1})[2], 0.48);
    EXPECT_GT(harmonics_at({1, 0, 0})[3], 0.48);
    EXPECT_GT(harmonics_at({0, 0, 1})[6], 0.6);
    EXPECT_GT(harmonics_at({1, 0, 0})[8], 0.5);
}

TEST(Harmonics, IrradianceIsThatOfTheRadiance) {
    // Radiance of degree 2: E is known by integration over the sphere with a rule for the cosine's jump, or in closed
    // form: A_l times each degree.
    const auto radiance = [](const Vec3& w) {
        return 3 + 1.5 * w.x - 0.5 * w.z + w.x * w.y + 0.25 * (3 * w.z * w.z - 1);
    };
    Harmonics<Spectrum> L{};
    integrate_over_sphere([&](const Vec3& w, double weight) {
        for (std::size_t i = 0; i < harmonic_count; ++i) L[i] += Spectrum(weight * radiance(w) * harmonics_at(w)[i]);
    });
    for (const Normal& n : some_directions(20)) {
        const double expected =
            3 * pi + 2 * pi / 3 * (1.5 * n.x - 0.5 * n.z) + pi / 4 * (n.x * n.y + 0.25 * (3 * n.z * n.z - 1));
        EXPECT_NEAR(irradiance_of(L, n)[0], expected, 1e-12);
    }
}

TEST(LightProbe, AUniformSurroundingHasOnlyDegreeZero) {
    for (const double size : {0.01, 1.0, 300.0}) {
        // B = 1 + 0.5 * 2 on all faces.
        const Solution s = even_light(box_scene(size, 2 * size, 1.1 * size, 0.5, 1, 1), 2);
        const std::vector<Point> points{{0.3 * size, 0.4 * size, 0.2 * size}, {0.5 * size, size, 0.9 * size}};
        for (const LightProbe& probe : probes_of(s, points)) {
            EXPECT_NEAR(probe.radiance[0][0], 2 / pi * std::sqrt(4 * pi), 1e-6);
            for (std::size_t i = 1; i < harmonic_count; ++i) EXPECT_NEAR(probe.radiance[i][0], 0, 1e-6);
            for (std::size_t i = 0; i < harmonic_count; ++i) EXPECT_LT(probe.standard_error[i][0], 1e-6);
            EXPECT_EQ(probe.back_share, 0);
        }
    }
}

TEST(LightProbe, ALightWithoutExtentHasNoNoise) {
    // Parallel light comes through the open top.
    SceneDescription d;
    d.file = "ground.obj", d.groups = {"ground"};
    d.materials = {{"grey", Spectrum(0.5), Spectrum()}};
    d.points = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}};
    PunctualLight lamp, sun;
    lamp.position = {1, 2, 2.5}, lamp.intensity = Spectrum(5);
    sun.kind = PunctualLight::Kind::directional, sun.direction = normalized(Vec3{0.2, 0.5, -1});
    sun.intensity = Spectrum(3);
    for (const PunctualLight& light : {lamp, sun}) {
        d.lights = {light};
        CheckedScene checked = make_scene(d);
        ASSERT_TRUE(checked.scene);
        Solution s = even_light(std::move(*checked.scene), 0);
        s.bounces = 0;
        const Point x{2.2, 0.7, 1.1};
        const Vec3 to_lamp = lamp.position - x;
        const double E = light.is_directional() ? 3 : 5 / squared_norm(to_lamp);
        const LightProbe probe = probes_of(s, {x})[0];
        const Harmonics<double> Y = harmonics_at(light.is_directional() ? -sun.direction : normalized(to_lamp));
        for (std::size_t i = 0; i < harmonic_count; ++i) {
            // Degree 1 is exact. The rule for the others is exact up to degree 23, and light of a point has up to
            // sqrt(2 l + 1) E Y_0 of degree l, of which irradiance has A_22 / A_2 = 0.0027 times as much as of
            // degree 2.
            const double tolerance = degree_of(i) == 1 ? 1e-12 * E : 0.0027 * std::sqrt(45) * E * Y[0];
            EXPECT_NEAR(probe.radiance[i][0], E * Y[i], tolerance) << i;
            EXPECT_EQ(probe.standard_error[i][0], 0);
        }
    }
}

TEST(LightProbe, IrradianceIsThatOfMeasuringPoints) {
    const Solution s = solved(box_scene(2, 3, 2, 0.7, 2, 1), demand(0.01));
    const RadiosityFunction light(s);
    const std::vector<Point> points{{1, 1.5, 1}, {0.4, 0.5, 0.7}, {1.5, 2.2, 0.5}};
    const std::vector<LightProbe> probes = probes_of(s, points);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (const Normal& n : some_directions(12)) {
            const ProbePoint at{points[i], n};
            const double expected = mean(light.at(std::span(&at, 1))[0].irradiance);
            EXPECT_NEAR(mean(irradiance_of(probes[i].radiance, n)), expected, 0.01 * expected);
        }
}

TEST(LightProbe, StandardErrorsCoverTheNoise) {
    const Solution s = sample_solution();
    std::vector<Point> points;
    for (int i = 0; i < 24; ++i) points.push_back({0.2 + 0.07 * i, 0.2, 0.6});
    const std::vector<LightProbe> few = probes_of(s, points, 256), many = probes_of(s, points, 1 << 16);
    double square = 0, expected = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = 0; k < harmonic_count; ++k) {
            square += std::pow(few[i].radiance[k][0] - many[i].radiance[k][0], 2);
            expected += std::pow(few[i].standard_error[k][0], 2);
        }
    // Quarters overestimate the variance of stratified rays by up to 4^(1/2), and a sum of 216 squares varies by 10%.
    EXPECT_LT(square, 1.2 * expected);
    EXPECT_GT(square, 0.1 * expected);
}

TEST(LightProbe, InsideOfABodyOnlyBacksAreSeen) {
    SceneDescription d;
    d.file = "body.obj", d.groups = {"body"};
    d.materials = {{"lamp", Spectrum(0.5), Spectrum(1)}};
    for (const double z : {0.0, 1.0}) d.points.insert(d.points.end(), {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}});
    d.faces = {{{3, 2, 1, 0}, 0, 0, 1}, {{4, 5, 6, 7}, 0, 0, 2}};
    for (std::uint32_t i = 0; i < 4; ++i) d.faces.push_back({{i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4}, 0, 0, 3});
    CheckedScene checked = make_scene(std::move(d));
    ASSERT_TRUE(checked.scene);
    const Solution s = even_light(std::move(*checked.scene), 1);
    const std::vector<LightProbe> probes = probes_of(s, {{0.3, 0.4, 0.5}, {0.3, 0.4, 3}});
    EXPECT_EQ(probes[0].back_share, 1);
    EXPECT_EQ(probes[0].radiance[0][0], 0);
    EXPECT_EQ(probes[1].back_share, 0);
}

TEST(LightProbe, HasTheSameBitsOnAnyNumberOfThreadsAndInAnyOrder) {
    const Solution s = sample_solution();
    const std::vector<Point> points{{0.5, 0.5, 0.5}, {1.5, 0.5, 0.4}, {1.1, 0.2, 0.7}};
    set_threads(1);
    const std::vector<LightProbe> one = probes_of(s, points);
    set_threads(0);
    const std::vector<LightProbe> all = probes_of(s, {points[2], points[1], points[0]});
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(one[i].radiance[5][0], all[2 - i].radiance[5][0]);
}

}  // namespace
}  // namespace exitance
