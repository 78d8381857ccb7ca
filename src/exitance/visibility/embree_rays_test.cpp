#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "exitance/base/parallel.hpp"
#include "exitance/visibility/rays.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

TEST(RayTracer, AgreesWithDoublePrecision) {
    const Scene scene = test::make(test::triangle_soup(200, 0.4, 5));
    const RayTracer tracer(scene);
    RandomStream random(1, Stream::rows);
    int differing = 0, met = 0;
    for (int trial = 0; trial < 100; ++trial) {
        const Point origin = test::any_in_cube(random);
        std::vector<Vec3> directions(37);
        for (Vec3& d : directions) d = 3.0 * test::any_in_cube(random);
        std::vector<RayHit> hits(directions.size());
        EXPECT_EQ(tracer.nearest(directions, origin, {}, hits), directions.size());
        for (std::size_t i = 0; i < hits.size(); ++i) {
            double distance;
            const SurfaceId s = test::first_on_ray(scene, origin, directions[i], distance);
            differing += s != hits[i].surface;
            if (s.is_none() || s != hits[i].surface) continue;
            ++met;
            EXPECT_NEAR(distance, hits[i].distance, 1e-9 * distance);
            EXPECT_EQ(hits[i].front, dot(scene.surfaces()[s].normal, directions[i]) < 0);
        }
    }
    EXPECT_GT(met, 1000);
    EXPECT_LE(differing, 1);  // single precision, within 1e-7 of an edge
}

TEST(RayTracer, NeverMeetsTheRegionThatARayStartsOnNorLeavesAClosedBox) {
    for (const Point& lo : {Point{0, 0, 0}, Point{1e6, -1e6, 3e5}, Point{-0.3, 0.7, 0.1}})
        for (double size : {1e-4, 1.0, 3e3}) {
            if (size < 1 && lo.x > 1) continue;  // coordinates of so small a scene have no significant digits here
            const Scene scene = test::make(test::closed_box(lo, {size, 2 * size, 0.7 * size}));
            const RayTracer tracer(scene);
            RandomStream random(2, Stream::rows);
            for (SurfaceId s : scene.surfaces().ids()) {
                const auto outline = scene.outline(s);
                const Frame frame(scene.surfaces()[s].normal);
                const RegionId own = scene.surfaces()[s].region;
                for (int trial = 0; trial < 50; ++trial) {
                    const double u = 0.001 + 0.998 * random.uniform(), v = 0.001 + 0.998 * random.uniform();
                    const Point origin = outline[0] + u * (outline[1] - outline[0]) + v * (outline[3] - outline[0]);
                    std::vector<Vec3> directions(16);
                    for (Vec3& d : directions) {
                        const double phi = 2 * pi * random.uniform(), z = std::max(1e-4, random.uniform());
                        d = frame.to_world(std::cos(phi), std::sin(phi), z);
                    }
                    std::vector<RayHit> hits(16);
                    tracer.nearest(directions, origin, own, hits);
                    for (std::size_t i = 0; i < hits.size(); ++i) {
                        ASSERT_FALSE(hits[i].surface.is_none());
                        EXPECT_NE(scene.surfaces()[hits[i].surface].region, own);
                        EXPECT_TRUE(hits[i].front);
                        const Point at = origin + hits[i].distance * directions[i];
                        EXPECT_LT(std::abs(dot(scene.surfaces()[hits[i].surface].normal,
                                               at - scene.outline(hits[i].surface)[0])),
                                  1e-9 * (size + norm(lo)));
                    }
                }
            }
        }
}

/// A floor at z = 0, a ceiling at z = 2, and between them a plate over x > 0.
Scene half_a_plate_between() {
    const std::vector<Point> floor = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    const std::vector<Point> ceiling = {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}};
    const std::vector<Point> plate = {{0, -1, 1}, {1, -1, 1}, {1, 1, 1}, {0, 1, 1}};
    return test::make({{floor}, {ceiling}, {plate}});
}

TEST(RayTracer, HitsNothingFromBeyondEmbreesRange) {
    const Scene scene = test::make(test::triangle_soup(20, 0.4, 5));
    const RayTracer tracer(scene);
    for (const double far : {1e20, 1e200, 1e308}) {
        const std::vector<Vec3> directions{{1, 0, 0}, {0, 0, -1}, {far, 1, 0}};
        std::vector<RayHit> hits(directions.size());
        tracer.nearest(directions, {far, far, 0}, {}, hits);
        for (const RayHit& hit : hits) EXPECT_TRUE(hit.surface.is_none());
        const Point from{far, far, 0}, to{0, 0, 0};
        bool blocked = false;
        tracer.occluded(std::span(&from, 1), std::span(&to, 1), {}, {}, std::span(&blocked, 1));
    }
}

TEST(RayTracer, OnlyBlockersBetweenItsEndsOccludeASegment) {
    const Scene scene = half_a_plate_between();
    const RayTracer tracer(scene);
    RandomStream random(4, Stream::visibility);
    std::vector<Point> from, to;
    for (int i = 0; i < 1000; ++i) {
        from.push_back({2 * random.uniform() - 1, 2 * random.uniform() - 1, 0});
        to.push_back({2 * random.uniform() - 1, 2 * random.uniform() - 1, 2});
    }
    const auto blocked = std::make_unique<bool[]>(from.size());
    const RegionId receiver = scene.surfaces()[SurfaceId(0)].region, source = scene.surfaces()[SurfaceId(1)].region;
    EXPECT_EQ(tracer.occluded(from, to, receiver, source, {blocked.get(), from.size()}), from.size());
    for (std::size_t i = 0; i < from.size(); ++i)
        EXPECT_TRUE(std::abs(from[i].x + to[i].x) < 1e-5 || blocked[i] == (from[i].x + to[i].x > 0));
}

TEST(RayTracer, PreparedEndsGiveTheSameOcclusionAsPoints) {
    const Scene scene = half_a_plate_between();
    const RayTracer tracer(scene);
    const RegionId receiver = scene.surfaces()[SurfaceId(0)].region, source = scene.surfaces()[SurfaceId(1)].region;
    RandomStream random(5, Stream::visibility);
    for (int packet = 0; packet < 50; ++packet) {
        std::array<Point, RayEnds::size> from, to;
        std::array<bool, RayEnds::size> blocked;
        for (Point& p : from) p = {2 * random.uniform() - 1, 2 * random.uniform() - 1, 0};
        for (Point& p : to) p = {2 * random.uniform() - 1, 2 * random.uniform() - 1, 2};
        tracer.occluded(from, to, receiver, source, blocked);
        const std::uint32_t bits = tracer.occluded(tracer.ray_ends(from, receiver), tracer.ray_ends(to, source));
        for (std::size_t k = 0; k < RayEnds::size; ++k)  // within 1e-5 of the plate's edge rounding decides
            EXPECT_TRUE(std::abs(from[k].x + to[k].x) < 1e-5 || blocked[k] == (bits >> k & 1)) << k;
    }
}

TEST(RayTracer, GivesTheSameHitsOnAnyNumberOfThreads) {
    const Scene scene = test::make(test::closed_box({0, 0, 0}, {1, 1, 1}));
    std::vector<Vec3> to_the_edges;  // two faces are equally near there
    for (int i = 1; i < 100; ++i) to_the_edges.push_back({0.5, 0.01 * i - 0.5, 0.5});
    std::vector<SurfaceId> first;
    for (int threads : {1, 2, 5}) {
        set_threads(threads);
        const RayTracer tracer(scene);
        std::vector<RayHit> hits(to_the_edges.size());
        tracer.nearest(to_the_edges, {0.5, 0.5, 0.5}, {}, hits);
        std::vector<SurfaceId> met;
        for (const RayHit& hit : hits) met.push_back(hit.surface);
        if (threads == 1) first = met;
        EXPECT_EQ(met, first);
    }
    set_threads(0);
}

TEST(RayTracer, MeetsTheSideOfASheetThatFacesTheRay) {
    // A sheet with two sides whose equal outlines start at different corners.
    const Scene scene = test::make(
        {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.2}, {0, 1, 0.2}}}, {{{1, 1, 0.2}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0.2}}}});
    const RayTracer tracer(scene);
    EXPECT_EQ(tracer.triangle_count(), 2u) << "once for both sides";
    RandomStream random(1, Stream::visibility);
    for (int i = 0; i < 200; ++i) {
        const Point target{0.05 + 0.9 * random.uniform(), 0.05 + 0.9 * random.uniform(), 0.1};
        for (const double z : {2.0, -2.0}) {
            const Point eye{random.uniform(), random.uniform(), z};
            const Vec3 d = target - eye;
            RayHit hit;
            tracer.nearest(std::span(&d, 1), eye, RegionId(), std::span(&hit, 1));
            ASSERT_FALSE(hit.surface.is_none());
            EXPECT_TRUE(hit.front);
            EXPECT_EQ(scene.surfaces()[hit.surface].normal.z > 0, z > 0);
        }
    }
}

/// A sheet with one parallelogram as its upper side and two triangles as its lower side, rotated about a skew axis,
/// scaled and moved.
Scene sheet_of_unlike_sides(double scale, const Vec3& shift) {
    const Vec3 u = normalized(Vec3{2, 1, -0.5}), v = normalized(cross(Vec3{0.3, -0.2, 1}, u));
    const auto at = [&](double a, double b) { return scale * (a * u + b * v) + shift; };
    return test::make({{{at(0, 0), at(1, 0), at(1, 1), at(0, 1)}},
                       {{at(0, 0), at(0, 1), at(1, 0)}},
                       {{at(1, 0), at(0, 1), at(1, 1)}}});
}

TEST(RayTracer, MeetsTheSideThatFacesTheRayWhereTheSidesHaveDifferentOutlines) {
    for (const auto& [scale, shift] : {std::pair{1.0, Vec3{}}, {1e-3, Vec3{}}, {1e3, Vec3{640, -720, 270}}}) {
        const Scene scene = sheet_of_unlike_sides(scale, shift);
        const RayTracer tracer(scene);
        const Normal above = scene.surfaces()[SurfaceId(0)].normal;
        const Vec3 u = scene.outline(SurfaceId(0))[1] - shift, v = scene.outline(SurfaceId(0))[3] - shift;
        RandomStream random(1, Stream::visibility);
        for (int i = 0; i < 200; ++i) {
            const Point target = shift + random.uniform() * u + random.uniform() * v;
            for (const double side : {2.0, -2.0}) {
                const Vec3 d = -side * scale * above + (random.uniform() - 0.5) * u;
                RayHit hit;
                tracer.nearest(std::span(&d, 1), target - d, RegionId(), std::span(&hit, 1));
                ASSERT_FALSE(hit.surface.is_none()) << scale;
                EXPECT_TRUE(hit.front) << scale << ' ' << side;
                EXPECT_EQ(dot(scene.surfaces()[hit.surface].normal, above) > 0, side > 0);
            }
        }
    }
}

/// Rays are traced sixteen at a time, which Embree tests together. The answer must not depend on the company, in
/// particular not on rays that run parallel, or nearly so, to a plane of the coordinates.
TEST(RayTracer, RaysDoNotDependOnOthersOfTheirPacket) {
    for (const double ground : {0.0, 10.0, 1000.0}) {
        std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {4, 5, 3});
        for (const test::Face& face : test::triangle_soup(50, 0.3, 5, {2, 2, 1})) faces.push_back(face);
        if (ground > 0)
            faces.push_back(
                {{{-ground, -ground, -1}, {ground, -ground, -1}, {ground, ground, -1}, {-ground, ground, -1}}});
        const Scene scene = test::make(faces);
        const RayTracer tracer(scene);
        RandomStream random(3, Stream::rows);
        for (const double small :
             {0.0, 1e-300, 1e-19, 1e-18, 1e-17, 1e-16, 1e-15, 1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4}) {
            int differing = 0, hidden_differing = 0;
            for (int trial = 0; trial < 300; ++trial) {
                const Point origin = Vec3{2, 2.5, 1.5} + 2 * test::any_in_cube(random);
                const auto axis = static_cast<int>(3 * random.uniform());
                const Vec3 around = test::any_in_cube(random);
                std::vector<Vec3> directions;
                for (int i = 0; i < 16; ++i) {
                    Vec3 d = around + 0.5 * test::any_in_cube(random);
                    if (i % 5 == 3) (axis == 0 ? d.x : axis == 1 ? d.y : d.z) = trial % 2 == 0 ? small : -small;
                    directions.push_back(d);
                }
                std::vector<RayHit> together(16), alone(1);
                tracer.nearest(directions, origin, RegionId(), together);
                std::vector<Point> from(16, origin), to;
                for (const Vec3& d : directions) to.push_back(origin + 2 * d);
                const auto hidden = std::make_unique<bool[]>(16);
                bool single = false;
                tracer.occluded(from, to, RegionId(), RegionId(), std::span(hidden.get(), 16));
                for (std::size_t i = 0; i < 16; ++i) {
                    tracer.nearest(std::span(&directions[i], 1), origin, RegionId(), alone);
                    differing += alone[0].surface != together[i].surface;
                    tracer.occluded(std::span(&origin, 1), std::span(&to[i], 1), RegionId(), RegionId(),
                                    std::span(&single, 1));
                    hidden_differing += single != hidden[i];
                }
            }
            EXPECT_EQ(differing, 0) << ground << ", " << small;
            EXPECT_EQ(hidden_differing, 0) << ground << ", " << small;
        }
    }
}

}  // namespace
}  // namespace exitance
