#include "exitance/evaluate/mirrored_light.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/solved.hpp"

namespace exitance {
namespace {

/// A rotation about the vertical and a scale.
struct Placement {
    double turn = 0, scale = 1;

    Vec3 vector(const Vec3& v) const {
        const double c = std::cos(turn), s = std::sin(turn);
        return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
    }
    Point point(const Point& p) const { return scale * vector(p); }
};

/// A pane of given width and height in the plane y = 6, standing on the ground.
Pane front(double width, double height, double index, const Placement& placed = {}) {
    Pane pane;
    for (const Point& p : {Point{-width, 6, 0}, {width, 6, 0}, {width, 6, height}, {-width, 6, height}})
        pane.corners.push_back(placed.point(p));
    pane.n = placed.vector({0, -1, 0});
    pane.transmissivity = Spectrum(0.9), pane.index = index;
    return pane;
}

/// A black ground in front of a pane, and a black wall behind it.
SceneDescription court(const Pane& pane, const Placement& placed = {}, double reflectance = 0) {
    SceneDescription d;
    d.file = "court";
    d.groups = {"all"};
    d.materials = {{"ground", Spectrum(reflectance), Spectrum()}};
    for (const Point& p : {Point{-20, -20, 0},
                           {20, -20, 0},
                           {20, 20, 0},
                           {-20, 20, 0},
                           {-20, 6.01, 0},
                           {20, 6.01, 0},
                           {20, 6.01, 20},
                           {-20, 6.01, 20}})
        d.points.push_back(placed.point(p));
    d.faces.push_back({{0, 1, 2, 3}, 0, 0, 1});
    d.faces.push_back({{4, 5, 6, 7}, 0, 0, 2});
    d.panes = {pane};
    return d;
}

Scene made(SceneDescription d) {
    CheckedScene checked = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

DistantLight sky_of(double irradiance) {
    SkyModel model = uniform_sky();
    model.normalize();
    DistantLight out;
    out.domes.push_back({model, Spectrum(irradiance)});
    return out;
}

double mirrored_at(const Scene& scene, const Point& x, const Normal& n, std::uint32_t rays = 1 << 14) {
    const RayTracer tracer(scene);
    const auto [a, b] = MirroredLight(scene, tracer).at({x, n, RegionId()}, rays, 7);
    return 0.5 * (a + b);
}

/// Mean reflection of a pane over its half space, weighted by the cosine.
double mean_reflection(const Pane& pane) {
    constexpr int steps = 2000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += mean(pane.reflection(std::sqrt((i + 0.5) / steps))) / steps;
    return sum;
}

}  // namespace

TEST(MirroredLight, IsHalfTheSkyTimesTheMeanReflectionBeforeAnInfinitePane) {
    for (const Placement& placed : {Placement{}, Placement{0.7, 1}, Placement{0.3, 50}}) {
        const Pane pane = front(200, 200, 1.52, placed);
        SceneDescription d = court(pane, placed);
        d.distant = sky_of(100);
        // About 6% of 2^15 rays are mirrored towards the sky: a standard error of 2%.
        EXPECT_NEAR(mirrored_at(made(std::move(d)), placed.point({0, 5, 1}), placed.vector({0, 1, 0})),
                    50 * mean_reflection(pane), 0.06 * 50 * mean_reflection(pane));
    }
}

TEST(MirroredLight, AMirroredSunHasTheCosinesOfItsImage) {
    const Pane pane = front(10, 20, 1.52);
    const Normal towards = normalized(Vec3{0.3, -1, 0.8});
    const auto scene = [&](bool shaded) {
        SceneDescription d = court(pane);
        d.distant.discs.push_back({towards, 0.2665 * pi / 180, Spectrum(500)});
        if (!shaded) return made(std::move(d));
        // A screen between the pane and the sun.
        for (const Point& p : {Point{-9, 2, 1.2}, {9, 2, 1.2}, {9, 2, 9}, {-9, 2, 9}}) d.points.push_back(p);
        d.faces.push_back({{8, 9, 10, 11}, 0, 0, 3}), d.faces.push_back({{11, 10, 9, 8}, 0, 0, 4});
        return made(std::move(d));
    };
    const Point x{0, 5, 0.5};
    const double right = 500 * towards.z * mean(pane.reflection(-towards.y));
    EXPECT_NEAR(mirrored_at(scene(false), x, {0, 0, 1}), right, 1e-9 * right);
    EXPECT_EQ(mirrored_at(scene(true), x, {0, 0, 1}), 0);
    EXPECT_EQ(mirrored_at(scene(false), {0, -19, 0.5}, {0, 0, 1}), 0) << "the image lies above the pane";
    EXPECT_EQ(mirrored_at(scene(false), x, {0, -1, 0}), 0) << "it looks away";
}

TEST(MirroredLight, AMirroredLampIsAsFarAsItsImage) {
    SceneDescription d = court(front(10, 20, 1.52));
    PunctualLight lamp;
    lamp.position = {1, 3, 2}, lamp.intensity = Spectrum(100);
    d.lights.push_back(lamp);
    PunctualLight parallel;
    parallel.kind = PunctualLight::Kind::directional, parallel.direction = normalized(Vec3{0, 1, -1});
    parallel.intensity = Spectrum(40);
    SceneDescription only_parallel = court(front(10, 20, 1.52));
    only_parallel.lights.push_back(parallel);
    const Point x{-1, 4, 1}, image{1, 9, 2};
    const Vec3 way = image - x;
    const Pane pane = front(10, 20, 1.52);
    const double right = 100 * mean(pane.reflection(way.y / norm(way))) * (way.y / norm(way)) / squared_norm(way);
    EXPECT_NEAR(mirrored_at(made(std::move(d)), x, {0, 1, 0}), right, 1e-9 * right);
    const double half = std::sqrt(0.5);
    EXPECT_NEAR(mirrored_at(made(std::move(only_parallel)), {0, 5, 0.5}, {0, 0, 1}),
                40 * half * mean(pane.reflection(half)), 1e-6);
}

TEST(MirroredLight, AMirroredEmitterIsSeenAtItsImage) {
    SceneDescription d = court(front(10, 20, 1.52));
    d.materials.push_back({"lamp", Spectrum(), Spectrum(1000)});
    for (const Point& p : {Point{0.9, 3, 1.9}, Point{1.1, 3, 1.9}, Point{1.1, 3, 2.1}, Point{0.9, 3, 2.1}})
        d.points.push_back(p);
    d.faces.push_back({{11, 10, 9, 8}, 1, 0, 3});  // faces the pane
    const Point x{-1, 4, 1}, image{1, 9, 2};
    const Vec3 way = image - x;
    const double cosine = way.y / norm(way);
    const double right =
        1000 * mean(front(10, 20, 1.52).reflection(cosine)) * 0.04 * cosine * cosine / (pi * squared_norm(way));
    const Scene scene = made(std::move(d));
    const RayTracer tracer(scene);
    const MirroredLight light(scene, tracer);
    double sum = 0;
    constexpr int repeats = 100;
    for (std::uint64_t key = 0; key < repeats; ++key) {
        const auto [a, b] = light.at({x, {0, 1, 0}, RegionId()}, 1, key);
        sum += 0.5 * (a + b) / repeats;
    }
    EXPECT_NEAR(sum, right, 0.01 * right);  // over the 0.2 m of the lamp the kernel changes by a few percent
}

TEST(MirroredLight, ASolveWithoutMuchOfItHasNotConverged) {
    for (const Placement& placed : {Placement{}, Placement{0.7, 0.01}}) {
        SceneDescription d = court(front(10, 20, 4, placed), placed);  // an index of 4 mirrors as much as silicon
        d.distant = sky_of(100);
        const Solution solution = solved(made(std::move(d)), {.error = 0.05});
        EXPECT_FALSE(solution.statistics.converged);
        ASSERT_FALSE(solution.statistics.warnings.empty());
        EXPECT_NE(solution.statistics.warnings.back().find("panes mirror light"), std::string::npos);
        EXPECT_GT(solution.statistics.figures.at("mirrored_light_share"), 0.05);
    }
}

TEST(MirroredLight, ScenesWithoutMirroringPanesConverge) {
    SceneDescription air = court(front(10, 20, 1));
    air.distant = sky_of(100);
    const Scene scene = made(std::move(air));
    EXPECT_FALSE(panes_may_mirror_light(scene));
    EXPECT_FALSE(panes_may_mirror_light(made(court(front(10, 20, 1.52))))) << "there is no light";
    const Solution solution = solved(scene, {.error = 0.05});
    EXPECT_TRUE(solution.statistics.converged);
    EXPECT_TRUE(solution.statistics.warnings.empty());
}

TEST(MirroredLight, ItsShareIsRelativeToTheLightThatArrives) {
    // A court whose ground has 100 W/m^2 everywhere.
    const auto share_of = [](const Pane& pane) {
        SceneDescription d = court(pane);
        d.distant = sky_of(100);
        const Scene scene = made(std::move(d));
        const Stage stage(scene);
        Solution solution{.scene = scene};
        ElementFunction& E = solution.interpolant;
        for (const Piece& piece : stage.pieces) E.tree.add_root(piece.region, piece.patch);
        E.first_value.resize(E.tree.size());
        for (const ElementId e : E.tree.ids()) {
            E.first_value[e] = static_cast<std::uint32_t>(E.values.size());
            for (int i = 0; i < E.tree.patch(e).corner_count(); ++i) E.add_value(Spectrum(100.0));
        }
        return mirrored_share(solution, stage, 1);
    };
    const MirroredShare large = share_of(front(10, 20, 1.52)), small = share_of(front(0.5, 1, 1.52));
    // A path tracer finds 11.8 W/m^2 by mirrors on the ground 1 m in front of the pane, and nothing behind it.
    EXPECT_GT(large.share, 0.015);
    EXPECT_LT(large.share, 0.118);
    EXPECT_LE(large.certainly, large.share);
    EXPECT_GT(large.certainly, 0.5 * large.share);
    EXPECT_LT(small.share, 0.005);
}

TEST(MirroredLight, PointsWithMuchOfItAreCounted) {
    SceneDescription d = court(front(10, 20, 1.52));
    d.distant = sky_of(100);
    const Scene scene = made(std::move(d));
    const std::vector<ProbePoint> points{{{0, 5, 1}, {0, 1, 0}}, {{0, 5, 1}, {0, -1, 0}}, {{0, 3, 5}, {0, 1, 0}}};
    const std::vector<Spectrum> light{Spectrum(0.277), Spectrum(50.0), Spectrum(2.58)};
    const MirroredAtPoints found = mirrored_at_points(scene, points, light, 0.02, 1);
    EXPECT_EQ(found.points, 3u);
    EXPECT_EQ(found.above, 2u);
    EXPECT_NEAR(found.largest, 1 - 0.277 / 7.05, 0.01);  // from a path tracer's 7.05
}

}  // namespace exitance
