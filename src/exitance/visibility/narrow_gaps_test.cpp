#include "exitance/visibility/narrow_gaps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/rays.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

struct Wedge {
    Scene scene;
    Frame frame;
    Point apex;
    double scale;
};

/// A square of 1/10 and a rectangle of 10 x 6, times `scale`, which touch along an edge of the square at an angle.
/// Their fronts face each other.
Wedge make_wedge(double angle, const Normal& up, const Point& apex, double scale) {
    const Frame frame(up);
    const auto at = [&](double x, double y, double z) { return apex + scale * frame.to_world(x, y, z); };
    const double c = std::cos(angle), s = std::sin(angle);
    return {test::make({{{at(0, 0, 0), at(0.1, 0, 0), at(0.1, 0.1, 0), at(0, 0.1, 0)}},
                        {{at(-5, 5.8 * c, 5.8 * s), at(5, 5.8 * c, 5.8 * s), at(5, -0.2 * c, -0.2 * s),
                          at(-5, -0.2 * c, -0.2 * s)}}}),
            frame, apex, scale};
}

/// Gaps of a scene none of whose faces is raised.
NarrowGaps gaps_up_to(double height, const Scene& scene) {
    const std::size_t regions = scene.regions().size();
    return {scene, Field<RegionId, double>(regions, height), Field<RegionId, double>(regions, 0)};
}

TEST(NarrowGaps, RaysFromPointsNearAnEdgeMeetTheOtherSideOfTheWedge) {
    struct Place {
        Point apex;
        double scale;
    };
    int gaps = 0;
    for (const double degrees : {0.3, 2.0, 7.6, 20.0})
        for (const Normal& up : {Normal{0, 0, 1}, normalized(Vec3{0.3, -0.5, 0.7})})
            for (const auto& [apex, scale] : {Place{{0, 0, 0}, 1}, Place{{1000, -700, 300}, 1},
                                              Place{{0.1, 0.2, 0.3}, 1e-3}, Place{{5, 6, 7}, 1e3}}) {
                const double angle = degrees * pi / 180;
                const Wedge wedge = make_wedge(angle, up, apex, scale);
                const RayTracer tracer(wedge.scene);
                const Occluders occluders(wedge.scene);
                const RegionId own = wedge.scene.surfaces()[SurfaceId(0)].region;
                RandomStream random(1, Stream::rows);
                for (int trial = 0; trial < 200; ++trial) {
                    const double y = 0.1 * std::pow(1e-7, random.uniform());
                    const Point x = apex + scale * wedge.frame.to_world(0.1 * random.uniform(), y, 0);
                    EXPECT_FALSE(occluders.is_covered(x, wedge.frame.to_world(0, 0, 1), own));
                    const Vec3 d = scale * cosine_direction(wedge.frame, random.uniform(), random.uniform());
                    double distance;
                    const SurfaceId expected = test::first_on_ray(wedge.scene, x, d, distance, own);
                    RayHit hit;
                    tracer.nearest({&d, 1}, x, own, {&hit, 1});
                    gaps += y * std::tan(angle) < 1e-5;
                    EXPECT_EQ(hit.surface, expected) << degrees << ' ' << y << ' ' << scale;
                    if (expected.is_none() || hit.surface.is_none()) continue;
                    EXPECT_TRUE(hit.front);
                    if (y * std::tan(angle) < 8e-6) {  // below the lift: found in double precision
                        EXPECT_NEAR(hit.distance, distance, 1e-3 * distance + 1e-11);  // rounding at 1 km
                    }
                    const Point target = x + distance * d;
                    // The large face has so few points below the square that its rays start at the usual height.
                    if (dot(target - apex, wedge.frame.to_world(0, 0, 1)) < 1e-4 * scale) continue;
                    bool blocked = true;
                    tracer.occluded({&x, 1}, {&target, 1}, own, hit.region, {&blocked, 1});
                    EXPECT_FALSE(blocked) << degrees << ' ' << y << ' ' << scale;
                    tracer.occluded({&target, 1}, {&x, 1}, hit.region, own, {&blocked, 1});
                    EXPECT_FALSE(blocked) << degrees << ' ' << y << ' ' << scale;
                }
            }
    EXPECT_GT(gaps, 1000);
}

TEST(NarrowGaps, RoomsOfRightAnglesHaveNone) {
    const Scene scene = test::make(test::closed_box({0.1, 0.2, 0.3}, {3, 4, 2.5}));
    const NarrowGaps gaps = gaps_up_to(1e-5, scene);
    for (RegionId r : scene.regions().ids()) EXPECT_FALSE(gaps.has(r));
}

// The plane of a long, tilted sheet crosses the walls, far from the sheet, but within its box if the room is rotated.
TEST(NarrowGaps, SheetsInRoomsHaveNoneHoweverTheRoomIsRotated) {
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {12, 6, 5});
    for (int sheet = 0; sheet < 20; ++sheet) {
        const Point a{0.1, 0.5 + 0.25 * sheet, 1.5}, b = a + Vec3{0, 0.1, 0.04};
        const Vec3 along{11.8, 0, 0};
        faces.push_back({{a, b, b + along, a + along}});
        faces.push_back({{a, a + along, b + along, b}});
    }
    for (const Normal& up : {Normal{0, 0, 1}, normalized(Vec3{0.3, -0.5, 0.7})}) {
        std::vector<test::Face> rotated = faces;
        const Frame frame(up);
        for (test::Face& face : rotated)
            for (Point& p : face.corners) p = Point{61, -53, 59} + frame.to_world(p.x, p.y, p.z);
        const Scene scene = test::make(rotated);
        const NarrowGaps gaps = gaps_up_to(2.5e-5, scene);
        for (RegionId r : scene.regions().ids()) EXPECT_FALSE(gaps.has(r));
    }
}

TEST(NarrowGaps, HeightIsThatOfTheFaceAbove) {
    const Wedge wedge = make_wedge(0.1, {0, 0, 1}, {}, 1);
    const NarrowGaps gaps = gaps_up_to(1e-4, wedge.scene);
    const RegionId own = wedge.scene.surfaces()[SurfaceId(0)].region;
    const Vec3 across = wedge.frame.to_world(0, 1, 0), along = wedge.frame.to_world(0.05, 0, 0);
    EXPECT_NEAR(gaps.height(along + 5e-4 * across, own), 5e-4 * std::tan(0.1), 1e-12);
    EXPECT_EQ(gaps.height(along + 0.05 * across, own), HUGE_VAL);
}

/// A floor of 4 x 3, with rugs of 2 x 2 and 1 x 1 on it, each `step` above the one before; the larger one is moved
/// by `aside`, times `scale`.
Scene floor_with_rugs(double step, double aside, const Frame& frame, const Point& origin, double scale) {
    const auto rectangle = [&](double x, double y, double width, double depth, double z) {
        const auto at = [&](double u, double v) { return origin + scale * frame.to_world(u, v, z); };
        return test::Face{{at(x, y), at(x + width, y), at(x + width, y + depth), at(x, y + depth)}};
    };
    return test::make(
        {rectangle(0, 0, 4, 3, 0), rectangle(1 + aside, 0.5, 2, 2, step), rectangle(1.5, 1, 1, 1, 2 * step)});
}

// Heights: in one plane, and in the plane up to rounding; nearer and farther than the usual start of rays.
TEST(NarrowGaps, NoRayLeavesOrReachesPlacesBelowAFaceThatIsStackedOnThem) {
    for (const double step : {0.0, 1e-9, 1e-7, 2e-6, 2e-5})
        for (const Normal& up : {Normal{0, 0, 1}, normalized(Vec3{0.3, -0.5, 0.7})})
            for (const double scale : {1e-3, 1.0, 1e3}) {
                const Frame frame(up);
                const Point origin = Point{} + scale * Vec3{7, -5, 3};
                const Scene scene = floor_with_rugs(step, 0.25, frame, origin, scale);
                const RayTracer tracer(scene);
                const auto region = [&](std::size_t face) { return scene.surfaces()[SurfaceId(face)].region; };
                const auto is_shut = [&](double x, double y, RegionId own) {
                    const double height = static_cast<double>(own.value) * step;
                    const Point at = origin + scale * frame.to_world(x, y, height), far = at + scale * up;
                    const Vec3 away = scale * frame.to_world(0.2, -0.1, 1);
                    RayHit hit;
                    tracer.nearest({&away, 1}, at, own, {&hit, 1});
                    bool from = false, to = false;
                    tracer.occluded({&at, 1}, {&far, 1}, own, RegionId(), {&from, 1});
                    tracer.occluded({&far, 1}, {&at, 1}, RegionId(), own, {&to, 1});
                    const std::vector<Point> low(RayEnds::size, at), high(RayEnds::size, far);
                    const bool prepared =
                        tracer.occluded(tracer.ray_ends(low, own), tracer.ray_ends(high, RegionId())) != 0;
                    EXPECT_EQ(from, !hit.surface.is_none()) << step << " " << x;
                    EXPECT_EQ(to, from) << step << " " << x;
                    EXPECT_EQ(prepared, from) << step << " " << x;
                    EXPECT_FALSE(hit.front);
                    return from;
                };
                EXPECT_FALSE(is_shut(0.7, 0.7, region(0))) << step;
                EXPECT_FALSE(is_shut(1.2, 1.5, region(0))) << step << ": beside the rug";
                EXPECT_TRUE(is_shut(2.9, 0.8, region(0))) << step;
                EXPECT_TRUE(is_shut(1.6, 1.5, region(0))) << step << ": below both rugs";
                EXPECT_FALSE(is_shut(2.9, 0.8, region(1))) << step;
                EXPECT_TRUE(is_shut(1.6, 1.5, region(1))) << step;
                EXPECT_FALSE(is_shut(1.6, 1.5, region(2))) << step;
            }
}

}  // namespace
}  // namespace exitance
