#include "exitance/visibility/shaft.hpp"

#include <gtest/gtest.h>

#include "exitance/direct/direct_light.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

using test::Face;

std::vector<Point> random_triangle(RandomStream& random, const Point& middle, double size) {
    return {middle + size * test::any_in_cube(random), middle + size * test::any_in_cube(random),
            middle + size * test::any_in_cube(random)};
}

Point inside(RandomStream& random, const std::vector<Point>& t) {
    const double u = std::sqrt(random.uniform()), v = random.uniform();
    return t[0] + u * (1 - v) * (t[1] - t[0]) + u * v * (t[2] - t[0]);
}

/// Pairs of walls with a common edge: the other walls touch the shaft between them but do not reach into it.
TEST(Shaft, NothingStandsBetweenTheFacesOfAClosedBox) {
    const Scene scene = test::make(test::closed_box({}, {1, 2, 3}));
    const Occluders occluders(scene);
    Shaft shaft;
    std::vector<PieceId> candidates;
    for (PieceId r : occluders.pieces().ids())
        for (PieceId s : occluders.pieces().ids()) {
            if (r == s) continue;
            const ConvexPiece &receiver = occluders.pieces()[r], &source = occluders.pieces()[s];
            shaft.set(occluders, {occluders.corners(r), receiver.plane.n, receiver.region},
                      {occluders.corners(s), source.plane.n, source.region});
            EXPECT_EQ(shaft.classify(candidates), View::open) << r.value << " " << s.value;
        }
}

TEST(Shaft, CertainClassesAreNeverContradictedByRays) {
    RandomStream random(21, Stream::visibility);
    int open = 0, blocked = 0, mixed = 0;
    for (int trial = 0; trial < 600; ++trial) {
        const double size = trial % 2 ? 3.0 : 0.5;
        const Scene scene = test::make(test::triangle_soup(1 + trial % 5, size, 300 + trial));
        const Occluders occluders(scene);
        const std::vector<Point> r = random_triangle(random, {0, 0, -0.8}, 0.6),
                                 s = random_triangle(random, {0, 0, 0.8}, 0.6);
        const Normal nr = normalized(area_vector(r)), ns = normalized(area_vector(s));
        Shaft shaft;
        std::vector<PieceId> candidates;
        shaft.set(occluders, {r, nr, {}}, {s, ns, {}});
        const View view = shaft.classify(candidates);
        (view == View::open ? open : view == View::none ? blocked : mixed)++;
        EXPECT_EQ(view == View::mixed, !candidates.empty());
        for (int ray = 0; ray < 100; ++ray) {
            const Point x = inside(random, r), y = inside(random, s);
            if (dot(nr, y - x) <= 0 || dot(ns, x - y) <= 0) continue;
            double distance;
            const SurfaceId first = test::first_on_ray(scene, x, y - x, distance);
            const bool clear = first.is_none() || distance > 1;
            EXPECT_FALSE(view == View::open && !clear);
            EXPECT_FALSE(view == View::none && clear);
            if (view != View::mixed || clear) continue;
            bool listed = false;
            for (PieceId p : candidates) listed |= occluders.pieces()[p].surface == first;
            EXPECT_TRUE(listed);
        }
    }
    EXPECT_GT(open, 50);
    EXPECT_GT(blocked, 20);
    EXPECT_GT(mixed, 50);
}

TEST(Shaft, IgnoresOccludersThatOnlyTouchIt) {
    const std::vector<Point> light = {{0, 0, 2}, {0, 1, 2}, {1, 1, 2}, {1, 0, 2}},
                             wall = {{1, 0, 0}, {1, 1, 0}, {1, 1, 2}, {1, 0, 2}};
    const std::vector<Point> floor = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const std::vector<Point> shelf = {{0.2, 0.2, 1}, {0.4, 0.2, 1}, {0.4, 0.4, 1}, {0.2, 0.4, 1}};
    std::vector<PieceId> candidates;
    Shaft shaft;
    for (bool with_shelf : {false, true}) {
        std::vector<Face> faces = {{light, 1}, {wall}, {floor}};
        if (with_shelf) faces.push_back({shelf});
        const Scene scene = test::make(faces);
        const Occluders occluders(scene);
        shaft.set(occluders, {floor, {0, 0, 1}, {}}, {light, {0, 0, -1}, {}});
        EXPECT_EQ(shaft.classify(candidates), with_shelf ? View::mixed : View::open);
        EXPECT_EQ(candidates.size(), with_shelf ? 1u : 0u);
        const std::vector<Point> patch = {{0.28, 0.28, 0.9}, {0.3, 0.28, 0.9}, {0.3, 0.3, 0.9}};
        const std::vector<Point> corner = {{0.3, 0.3, 2}, {0.3, 0.35, 2}, {0.35, 0.3, 2}};
        shaft.set(occluders, {patch, {0, 0, 1}, {}}, {corner, {0, 0, -1}, {}});
        EXPECT_EQ(shaft.classify(candidates), with_shelf ? View::none : View::open);
    }
}

TEST(Shaft, IsBlockedByAWallButNotByItsDoor) {
    const std::vector<Point> wall = {{0, -3, 0}, {0, -1, 0}, {0, -1, 2}, {0, 1, 2},
                                     {0, 1, 0},  {0, 3, 0},  {0, 3, 3},  {0, -3, 3}};
    const Scene scene = test::make({{wall}});
    const Occluders occluders(scene);
    Shaft shaft;
    std::vector<PieceId> candidates;
    const auto look = [&](double y, double width) {
        const std::vector<Point> r = {{-1, y, 1}, {-1, y, 1.5}, {-1, y + width, 1.5}, {-1, y + width, 1}};
        const std::vector<Point> s = {{1, y, 1}, {1, y + width, 1}, {1, y + width, 1.5}, {1, y, 1.5}};
        shaft.set(occluders, {r, {1, 0, 0}, {}}, {s, {-1, 0, 0}, {}});
        return shaft.classify(candidates);
    };
    EXPECT_EQ(look(-2.5, 1), View::none);
    EXPECT_EQ(look(-2, 1), View::none);  // the view ends exactly at the edge of the door
    EXPECT_EQ(look(-2, 1.01), View::mixed);
    EXPECT_EQ(look(-1, 2), View::open);
    EXPECT_EQ(look(-2, 4), View::mixed);  // the view contains the whole door
    EXPECT_EQ(look(1, 2), View::none);
}

TEST(DirectLight, IsTheSameForAPreparedPolygonAndItsPoints) {
    RandomStream random(5, Stream::direct);
    for (int trial = 0; trial < 20; ++trial) {
        std::vector<Face> faces = test::triangle_soup(20, 0.7, 900 + trial, {0, 0, 0.5});
        faces.push_back({{{-1, -1, 1.2}, {-1, 1, 1.2}, {1, 1, 1.2}, {1, -1, 1.2}}, 3});
        faces.push_back({{{-2, -1, 0.2}, {-2, 1, 0.2}, {-2, 1, 0.6}, {-2, -1, 0.6}}, 2});
        faces.push_back({{{-1, -1, -0.3}, {1, -1, -0.3}, {1, 1, -0.3}, {-1, 1, -0.3}}});
        const Scene scene = test::make(faces);
        const Occluders occluders(scene);
        const DirectLight light(scene, occluders);
        const RegionId own = scene.surfaces()[SurfaceId(faces.size() - 1)].region;
        VisibilityWorkspace scratch;
        ReceiverLight whole, part;
        const std::vector<Point> patch = {{-0.5, -0.5, -0.3}, {0.5, -0.5, -0.3}, {0.5, 0.5, -0.3}};
        const std::vector<Point> half = {{0, -0.5, -0.3}, {0.5, -0.5, -0.3}, {0.5, 0.5, -0.3}};
        light.prepare(patch, {0, 0, 1}, own, whole, scratch);
        light.prepare(half, whole, part, scratch);
        EXPECT_LE(part.candidates.size(), whole.candidates.size());
        for (int i = 0; i < 20; ++i) {
            const Point x = inside(random, half);
            const double exact = light.irradiance(x, {0, 0, 1}, own, scratch)[0];
            EXPECT_NEAR(light.irradiance(whole, x, scratch)[0], exact, 1e-13);
            EXPECT_NEAR(light.irradiance(part, x, scratch)[0], exact, 1e-13);
        }
    }
}

/// Two faces in the same plane up to 1e-9. The later one is on top and receives light although it is lower.
TEST(DirectLight, IsTheSameForAPreparedPolygonOnTopOfAnotherAndItsPoints) {
    const auto lower = [](double x, double y) { return Point{x, y, -1e-9}; };
    const Scene scene = test::make({{{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}},
                                    {{lower(-1, -1), lower(0.7, -1), lower(0.7, 1), lower(-1, 1)}},
                                    {{{-2, -2, -1}, {2, -2, -1}, {2, 2, -1}, {-2, 2, -1}}},
                                    {{{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}}, 3}});
    const Occluders occluders(scene);
    const DirectLight light(scene, occluders);
    const RegionId top = scene.surfaces()[SurfaceId(1)].region;
    ASSERT_GT(occluders.lift(top), 1e-9);
    const Normal& n = scene.regions()[top].plane.n;
    VisibilityWorkspace scratch;
    ReceiverLight whole, part;
    light.prepare(std::vector{lower(-1, -1), lower(0.7, -1), lower(0.7, 1), lower(-1, 1)}, n, top, whole, scratch);
    light.prepare(std::vector{lower(0.1, 0.2), lower(0.5, 0.3), lower(0.3, 0.7)}, whole, part, scratch);
    const Point x = lower(0.3, 0.4);
    const double exact = light.irradiance(x, n, top, scratch)[0];
    EXPECT_GT(exact, 0.1);
    EXPECT_NEAR(light.irradiance(part, x, scratch)[0], exact, 1e-13 * exact);  // rounding
    EXPECT_TRUE(part.is_unshadowed());
}

}  // namespace
}  // namespace exitance
