#include "exitance/discontinuity/discontinuity_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "exitance/base/parallel.hpp"
#include "exitance/error/area_samples.hpp"
#include "exitance/methods/light/mesh_of_layers.hpp"
#include "exitance/solution/layers/light_layers.hpp"
#include "support/built_scene.hpp"
#include "support/solved.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A source 1.5 m wide at a height of 2 m, a blocker of 1 m at 0.7 m, a floor of 4 m. `turn`: rotation of the blocker,
/// radians.
Scene blocker(double turn) {
    const auto at = [&](double x, double y) {
        return Point{x * std::cos(turn) - y * std::sin(turn), x * std::sin(turn) + y * std::cos(turn), 0.7};
    };
    return test::make({{{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, 0},
                       {{at(-0.5, -0.5), at(0.5, -0.5), at(0.5, 0.5), at(-0.5, 0.5)}, 0},
                       {{{-0.75, 0.75, 2}, {0.75, 0.75, 2}, {0.75, -0.75, 2}, {-0.75, -0.75, 2}}, 100}});
}

Solution meshed(const Scene& scene, double error) {
    return solved(scene, {.method = Method::discontinuity, .bounces = 0, .error_interpolant = error});
}

TEST(DiscontinuityMesh, TheBlockersCurvesAgreeWithTheClosedForm) {
    // Source edge at +-0.75 m, blocker edge at +-0.5 m: x = (2 (+-0.5) - 0.7 (+-0.75)) / 1.3.
    const Solution s = meshed(blocker(0), 0.01);
    std::set<long> found;  // micrometres
    for (const DiscontinuityCurve& c : s.discontinuity.curves) {
        if (std::abs(c.a.z) > 1e-9 || std::abs(c.a.x - c.b.x) > 1e-9) continue;
        if ((c.a.y - 0.1) * (c.b.y - 0.1) > 0) continue;
        EXPECT_EQ(c.order, CurveOrder::d1);
        found.insert(std::lround(1e6 * c.a.x));
    }
    EXPECT_EQ(found, (std::set<long>{-1173077, -365385, 365385, 1173077}));
}

TEST(DiscontinuityMesh, ShadowClassesAgreeWithTheClosedForm) {
    const auto class_at = [](const Scene& scene, const Point& p) {
        const Solution s = meshed(scene, 0.02);
        const auto place = SixNodeLocator(s.discontinuity, s.scene).find(RegionId(0), p);
        return s.discontinuity.shadow[place.triangle];
    };
    // The umbra ends at 0.3654 m, the penumbra at 1.1731 m.
    EXPECT_EQ(class_at(blocker(0), {0, 0.05, 0}), ShadowClass::umbra);
    EXPECT_EQ(class_at(blocker(0), {0.7, 0.05, 0}), ShadowClass::penumbra);
    EXPECT_EQ(class_at(blocker(0), {1.5, 0.05, 0}), ShadowClass::lit);
    // The point below the blocker sees all of a second source and nothing of the first: that is penumbra.
    const Scene two = test::make({{{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, 0},
                                  {{{-0.5, -0.5, 0.7}, {0.5, -0.5, 0.7}, {0.5, 0.5, 0.7}, {-0.5, 0.5, 0.7}}, 0},
                                  {{{-0.75, 0.75, 2}, {0.75, 0.75, 2}, {0.75, -0.75, 2}, {-0.75, -0.75, 2}}, 100},
                                  {{{1.6, 0.1, 1}, {1.9, 0.1, 1}, {1.9, -0.1, 1}, {1.6, -0.1, 1}}, 100}});
    EXPECT_EQ(class_at(two, {0, 0.05, 0}), ShadowClass::penumbra);
}

/// A mesh along chosen lines, otherwise like `meshed`.
Solution meshed_along(const Scene& scene, const ShadowLines& lines) {
    SolveOptions options{.method = Method::discontinuity, .bounces = 0, .error_interpolant = 0.01};
    options.discontinuity.lines = lines;
    return solved(scene, options);
}

std::size_t curves_that_are_no_contacts(const Solution& s) {
    return static_cast<std::size_t>(
        std::count_if(s.discontinuity.curves.begin(), s.discontinuity.curves.end(),
                      [](const DiscontinuityCurve& c) { return c.cause != CurveCause::contact; }));
}

TEST(DiscontinuityMesh, FollowsTheLinesThatAreChosenAndIsAsAccurateWithout) {
    using Kind = ShadowLines::Kind;
    const Scene scene = built_scene("complex", {{"m", "6"}});
    const Solution usual = meshed_along(scene, {}), all = meshed_along(scene, {.kind = Kind::all}),
                   none = meshed_along(scene, {.kind = Kind::strongest}),
                   few = meshed_along(scene, {.kind = Kind::strongest, .count = 100});
    EXPECT_GT(curves_that_are_no_contacts(all), curves_that_are_no_contacts(usual));
    EXPECT_EQ(curves_that_are_no_contacts(none), 0u);
    EXPECT_EQ(curves_that_are_no_contacts(few), 100u);
    for (const Solution* s : {&usual, &all, &none, &few})
        EXPECT_LE(*s->statistics.relative_error_estimate_interpolant, 0.01);
    // The shorter and weaker lines are the ones that are left out.
    const auto longest = [](const Solution& s) {
        double out = 0;
        for (const DiscontinuityCurve& c : s.discontinuity.curves)
            if (c.cause != CurveCause::contact) out = std::max(out, norm(c.b - c.a));
        return out;
    };
    EXPECT_GE(longest(few), 0.5 * longest(usual));
}

TEST(DiscontinuityMesh, FollowsLinesOnNamedSurfacesOnly) {
    const Scene scene = built_scene("complex", {{"m", "6"}});
    const std::string name = scene.groups()[scene.surfaces()[SurfaceId(0)].group];
    ASSERT_FALSE(name.empty());
    const Solution s = meshed_along(scene, {.kind = ShadowLines::Kind::on_surfaces, .names = {name}});
    EXPECT_GT(curves_that_are_no_contacts(s), 0u);
    for (const DiscontinuityCurve& c : s.discontinuity.curves) {
        if (c.cause == CurveCause::contact) continue;
        const auto& faces = scene.regions()[c.region].surfaces;
        EXPECT_TRUE(std::any_of(faces.begin(), faces.end(),
                                [&](SurfaceId f) { return scene.groups()[scene.surfaces()[f].group] == name; }));
    }
    SolveOptions options{.method = Method::discontinuity};
    options.discontinuity.lines = {.kind = ShadowLines::Kind::on_surfaces, .names = {"no such thing"}};
    Progress progress;
    const StopRequest stop;
    const Result<Solution> wrong = solve_scene(scene, options, progress, stop);
    ASSERT_FALSE(wrong);
    EXPECT_NE(wrong.error().message.find("no such thing"), std::string::npos);
}

TEST(DiscontinuityMesh, KeepsTheLargestErrorThatIsRequested) {
    // Triangles at the borders of shadows determine the largest error, but hardly the mean one.
    const Scene scene = blocker(0.3);
    SolveOptions options{.method = Method::discontinuity, .bounces = 0, .error_interpolant = 0.05};
    options.discontinuity.lines = {.kind = ShadowLines::Kind::strongest};
    const Solution usual = solved(scene, options);
    options.discontinuity.largest_error = 0.005;
    const Solution fine = solved(scene, options);
    EXPECT_GT(fine.discontinuity.size(), 2 * usual.discontinuity.size());
}

TEST(DiscontinuityMesh, ATurnedBlockersCurvesAreThoseOfAllPairsOfCornersAndEdges) {
    const double turn = pi / 6;
    const Solution s = meshed(blocker(turn), 0.01);
    const double k = 2 / 1.3;
    std::size_t on_floor = 0;
    for (const DiscontinuityCurve& c : s.discontinuity.curves) {
        if (std::abs(c.a.z) > 1e-9) continue;
        ++on_floor;
        EXPECT_EQ(c.order, CurveOrder::d2);
        // The shadow of a point p from a point q of the source is q + k (p - q). Both ends of a curve must be on one of
        // two lines: the shadow of a blocker's edge from one corner of the source, or the shadow of a blocker's corner
        // from one edge of the source.
        double least = 1;
        const auto shadow = [&](double x, double y, double sx, double sy) {
            const Vec2 p = {x * std::cos(turn) - y * std::sin(turn), x * std::sin(turn) + y * std::cos(turn)};
            return Vec2{sx + k * (p.x - sx), sy + k * (p.y - sy)};
        };
        const auto look = [&](Vec2 a, Vec2 b) {
            const Vec2 d = b - a, p = {c.a.x, c.a.y}, q = {c.b.x, c.b.y};
            const double l = std::sqrt(dot(d, d));
            least = std::min(least, std::max(std::abs(cross(d, p - a)), std::abs(cross(d, q - a))) / l);
        };
        const double corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                const auto &e = corner[i], &f = corner[(i + 1) % 4], &q = corner[j], &r = corner[(j + 1) % 4];
                look(shadow(0.5 * e[0], 0.5 * e[1], 0.75 * q[0], 0.75 * q[1]),
                     shadow(0.5 * f[0], 0.5 * f[1], 0.75 * q[0], 0.75 * q[1]));
                look(shadow(0.5 * e[0], 0.5 * e[1], 0.75 * q[0], 0.75 * q[1]),
                     shadow(0.5 * e[0], 0.5 * e[1], 0.75 * r[0], 0.75 * r[1]));
            }
        EXPECT_LT(least, 1e-6);
    }
    EXPECT_GE(on_floor, 32u);
    EXPECT_EQ(s.statistics.discontinuity->d1, 0u);
}

TEST(DiscontinuityMesh, MeetsTheRequestedErrorAndKeepsTheArea) {
    const Scene scene = built_scene("table");
    const Solution s = meshed(scene, 0.003);
    double area = 0, all = 0;
    for (const Region& region : scene.regions()) all += region.area;
    for (std::uint32_t t = 0; t < s.discontinuity.size(); ++t) area += s.discontinuity.area(t);
    EXPECT_NEAR(area, all, 1e-9 * all);
    EXPECT_LE(*s.statistics.relative_error_estimate_interpolant, 0.003);
    const RadiosityFunction light(s);
    const std::vector<ProbePoint> points = points_uniform_in_area(scene, 2000, 7);
    const std::vector<Light> exact = light.at(points), held = light.interpolant_at(points);
    double sum = 0, square = 0, largest = 0, brightest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double e = exact[i].irradiance[0], d = held[i].irradiance[0] - e;
        sum += e, square += d * d;
        largest = std::max(largest, std::abs(d)), brightest = std::max(brightest, e);
    }
    const auto n = static_cast<double>(points.size());
    EXPECT_LE(std::sqrt(square / n) / (sum / n), 0.003);
    EXPECT_LE(largest / brightest, 0.005);
}

TEST(DiscontinuityMesh, IsBitwiseIndependentOfThreads) {
    const Scene scene = built_scene("chair");
    set_threads(1);
    const Solution one = meshed(scene, 0.02);
    set_threads(3);
    const Solution three = meshed(scene, 0.02);
    set_threads(0);
    EXPECT_EQ(one.discontinuity.values, three.discontinuity.values);
    EXPECT_EQ(one.discontinuity.nodes, three.discontinuity.nodes);
    EXPECT_EQ(one.interpolant.values, three.interpolant.values);
}

TEST(DiscontinuityMesh, IncludesReflectedLight) {
    const Scene scene = box_scene(1, 1, 1, 0.5, 1, 1);  // a furnace: E = 2 everywhere
    const Solution s = solved(scene, {.method = Method::discontinuity, .error = 0.02});
    ASSERT_FALSE(s.discontinuity.empty());
    for (const auto& value : s.discontinuity.values) EXPECT_NEAR(value[0], 2, 0.1);
}

TEST(DiscontinuityMesh, TheThesissTriangulationsMeetTheErrorAndKeepTheArea) {
    const Scene scene = built_scene("table");
    double all = 0;
    for (const Region& region : scene.regions()) all += region.area;
    for (const TriangulationScheme scheme :
         {TriangulationScheme::longest, TriangulationScheme::shortest, TriangulationScheme::heuristic}) {
        SolveOptions options{.method = Method::discontinuity, .bounces = 0, .error_interpolant = 0.02};
        options.discontinuity.triangulation = scheme;
        options.discontinuity.premesh = Premesh::coarse;
        const Solution s = solved(scene, options);
        double area = 0;
        for (std::uint32_t t = 0; t < s.discontinuity.size(); ++t) area += s.discontinuity.area(t);
        EXPECT_NEAR(area, all, 1e-9 * all);
        EXPECT_LE(*s.statistics.relative_error_estimate_interpolant, 0.02);
        EXPECT_GT(s.statistics.figures.at("winged_edge_bytes"), 0);
        EXPECT_GT(s.statistics.figures.at("dm_tree_bytes"), 0);
    }
}

TEST(DiscontinuityMesh, RefinedTrianglesHaveABetterShapeAndMeetTheError) {
    const Scene scene = built_scene("table");
    double all = 0;
    for (const Region& region : scene.regions()) all += region.area;
    SolveOptions options{.method = Method::discontinuity, .bounces = 0, .error_interpolant = 0.01};
    const Solution plain = solved(scene, options);
    options.discontinuity.quality = MeshQuality::delaunay;
    const Solution refined = solved(scene, options);
    double area = 0;
    for (std::uint32_t t = 0; t < refined.discontinuity.size(); ++t) area += refined.discontinuity.area(t);
    EXPECT_NEAR(area, all, 1e-9 * all);
    EXPECT_LE(*refined.statistics.relative_error_estimate_interpolant, 0.01);
    constexpr double rounder = 1.2;
    EXPECT_GT(refined.discontinuity.mean_radius_ratio(), rounder * plain.discontinuity.mean_radius_ratio());
}

/// Errors of E at uniformly distributed points: RMS relative to the mean, largest relative to the largest value.
struct MeshError {
    double rms = 0, largest = 0;
};
MeshError error_of(const Solution& s) {
    const RadiosityFunction light(s);
    const std::vector<ProbePoint> points = points_uniform_in_area(s.scene, 2000, 7);
    const std::vector<Light> exact = light.at(points), held = light.interpolant_at(points);
    double sum = 0, square = 0, largest = 0, brightest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double e = exact[i].irradiance[0], d = held[i].irradiance[0] - e;
        sum += e, square += d * d;
        largest = std::max(largest, std::abs(d)), brightest = std::max(brightest, e);
    }
    const auto n = static_cast<double>(points.size());
    return {std::sqrt(square / n) / (sum / n), largest / brightest};
}

TEST(DiscontinuityMesh, CloughTocherElementsMeetTheRequestedError) {
    for (const char* name : {"boxes", "table"}) {
        SolveOptions options{.method = Method::discontinuity, .bounces = 0, .error_interpolant = 0.003};
        options.discontinuity.element = MeshElement::clough_tocher;
        const Solution s = solved(built_scene(name), options);
        EXPECT_TRUE(s.discontinuity.is_clough_tocher());
        EXPECT_EQ(s.statistics.basis, "clough-tocher");
        EXPECT_LE(*s.statistics.relative_error_estimate_interpolant, 0.003);
        const MeshError error = error_of(s);
        EXPECT_LE(error.rms, 0.003);
        EXPECT_LE(error.largest, 0.006);
        // The scene is open, and few rays estimate the escaping flux, so absorbed flux is compared with that of
        // quadratic elements.
        options.discontinuity.element = MeshElement::quadratic;
        const double quadratic = solved(built_scene(name), options).statistics.energy.absorbed;
        EXPECT_NEAR(s.statistics.energy.absorbed, quadratic, 0.003 * quadratic);
    }
}

TEST(DiscontinuityMesh, WarnsIfFewerThanHalfOfTheLinesAreFollowedUnlessTheUserChoseThem) {
    const auto is_warned = [](const std::optional<ShadowLines>& lines) {
        SolveOptions options{.method = Method::discontinuity, .bounces = 0, .error_interpolant = 0.05};
        options.discontinuity.lines = lines;
        const Solution s = solved(built_scene("boxes", {{"lights", "3"}}), options);
        const auto& warnings = s.statistics.warnings;
        return std::any_of(warnings.begin(), warnings.end(),
                           [](const std::string& w) { return w.find("shadow lines") != std::string::npos; });
    };
    EXPECT_TRUE(is_warned({}));
    EXPECT_TRUE(is_warned(ShadowLines())) << "as with --dm-lines auto";
    EXPECT_FALSE(is_warned(ShadowLines{.kind = ShadowLines::Kind::strongest, .count = 3}));
    EXPECT_FALSE(is_warned(ShadowLines{.kind = ShadowLines::Kind::all}));
}

TEST(DiscontinuityMesh, SourceLayersMeetTheRequestedErrorAlsoWithReflections) {
    for (const int bounces : {0, -1}) {
        SolveOptions options{.method = Method::discontinuity, .bounces = bounces, .error_interpolant = 0.02};
        options.discontinuity.layers = true;
        const Solution s = solved(built_scene("boxes", {{"lights", "2"}}), options);
        ASSERT_EQ(layers_of(s).sources.size(), 2u);
        EXPECT_TRUE(s.discontinuity.empty());
        EXPECT_LE(*s.statistics.relative_error_estimate_interpolant, 0.02);
        EXPECT_LE(error_of(s).rms, 0.02);
        EXPECT_GT(s.statistics.figures.at("layer_bytes"), 0);
        EXPECT_LT(2 * s.statistics.figures.at("layer_bytes"), s.statistics.figures.at("winged_edge_bytes"));
        // The single mesh is that of --layers off.
        Solution merged = s;
        ASSERT_TRUE(make_requested_mesh(merged));
        merged.layers = {};
        EXPECT_LE(error_of(merged).rms, 0.02);
        options.discontinuity.layers = false;
        EXPECT_EQ(merged.discontinuity.values,
                  solved(built_scene("boxes", {{"lights", "2"}}), options).discontinuity.values);
        // Both measure the absorbed light, of meshes with 2% error.
        EXPECT_NEAR(s.statistics.energy.absorbed,
                    solved(built_scene("boxes", {{"lights", "2"}}), options).statistics.energy.absorbed,
                    0.02 * s.statistics.energy.absorbed);
    }
}

TEST(DiscontinuityMesh, WeakSourcesHaveD2CurvesOnlyAlongNarrowPenumbras) {
    // The second lamp's light is 1 to 5 times the largest error. Its edges are not parallel to those of the blocker.
    const auto curves_of_second = [](double side) {
        const double c = std::cos(0.5), d = std::sin(0.5), h = 0.5 * side, exitance = 16 / (side * side);
        const auto at = [&](double x, double y) { return Point{x * c - y * d, x * d + y * c, 0.7}; };
        const Scene scene =
            test::make({{{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, 0},
                        {{at(-0.5, -0.5), at(0.5, -0.5), at(0.5, 0.5), at(-0.5, 0.5)}, 0},
                        {{{-0.75, 0.75, 2}, {0.75, 0.75, 2}, {0.75, -0.75, 2}, {-0.75, -0.75, 2}}, 100},
                        {{{1.2 - h, h, 1.8}, {1.2 + h, h, 1.8}, {1.2 + h, -h, 1.8}, {1.2 - h, -h, 1.8}}, exitance}});
        const auto& curves = meshed(scene, 0.02).discontinuity.curves;
        return std::count_if(curves.begin(), curves.end(), [](const DiscontinuityCurve& curve) {
            return curve.source == RegionId(3) && curve.region == RegionId(0) && curve.order == CurveOrder::d2;
        });
    };
    EXPECT_GE(curves_of_second(0.02), 8);  // each of the lamp's corners makes curves with at least two edges
    EXPECT_EQ(curves_of_second(0.4), 0);   // elements of this size resolve the wide penumbras, so no curves are needed
}

TEST(DiscontinuityMesh, CutsAlongShadowsOfReflectedLightIfRequested) {
    // A wall next to the blocker reflects light onto the floor, past the blocker.
    const Scene scene = test::make({{{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, 0},
                                    {{{-0.5, -0.5, 0.7}, {0.5, -0.5, 0.7}, {0.5, 0.5, 0.7}, {-0.5, 0.5, 0.7}}, 0},
                                    {{{-2, 2, 0.5}, {2, 2, 0.5}, {2, 2, 3}, {-2, 2, 3}}, 0},
                                    {{{-0.75, 0.75, 2}, {0.75, 0.75, 2}, {0.75, -0.75, 2}, {-0.75, -0.75, 2}}, 100}});
    SolveOptions options{.method = Method::discontinuity, .error = 0.1, .error_interpolant = 0.05};
    options.discontinuity.sources = SecondarySources{.count = 2};
    const Solution s = solved(scene, options);
    EXPECT_EQ(s.statistics.figures.at("secondary_sources"), 2);
    EXPECT_GT(s.statistics.figures.at("secondary_curves"), 0);
    const auto of_wall = [](const DiscontinuityCurve& c) { return c.source == RegionId(2); };
    EXPECT_TRUE(std::any_of(s.discontinuity.curves.begin(), s.discontinuity.curves.end(), of_wall));
}

}  // namespace
}  // namespace exitance
