#include "exitance/lab/bsp/shadow_volume.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

struct Sheet {
    std::vector<Point> corners;
    Plane plane;
};

Sheet square(const Point& middle, const Vec3& u, const Vec3& v) {
    Sheet out;
    out.corners = {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
    const Normal n = normalized(cross(u, v));
    out.plane = {n, dot(n, middle)};
    return out;
}

bool is_blocked(const Point& x, const Point& s, const Sheet& by) {
    const double a = by.plane.signed_distance(x), b = by.plane.signed_distance(s);
    if ((a > 0) == (b > 0)) return false;
    return contains(by.corners, by.plane.n, x + a / (a - b) * (s - x));
}

}  // namespace

TEST(ShadowVolume, OfParallelSquaresHasTheAnalyticEdges) {
    // A source of half width 1 at z = 2 shining down, an occluder of half width 0.5 at z = 1: on z = 0 the penumbra
    // reaches to 0.5 + 1.5 = 2, the umbra vanishes there; on z = 0.5 its half width is 0.25.
    const Sheet source = square({0, 0, 2}, {1, 0, 0}, {0, -1, 0});
    const Sheet occluder = square({0, 0, 1}, {0.5, 0, 0}, {0, 0.5, 0});
    const ShadowVolume volume(source.corners, source.plane, occluder.corners, occluder.plane, 1e-9);
    std::size_t tests = 0;
    const auto penumbra = [&](const Point& p) { return volume.in_penumbra(std::span(&p, 1), tests); };
    const auto umbra = [&](const Point& p) { return volume.in_umbra(std::span(&p, 1), tests); };
    using Place = ShadowVolume::Place;
    EXPECT_EQ(penumbra({1.99, 0, 0}), Place::inside);
    EXPECT_EQ(penumbra({2.01, 0, 0}), Place::outside);
    EXPECT_EQ(penumbra({0, 0, 1.5}), Place::outside) << "before the occluder";
    EXPECT_EQ(umbra({0.24, 0, 0.5}), Place::inside);
    EXPECT_EQ(umbra({0.26, 0, 0.5}), Place::outside);
    EXPECT_EQ(umbra({0.01, 0, 0}), Place::outside);
    EXPECT_GT(tests, 0u);
    EXPECT_EQ(volume.umbra().size(), 5u);
}

TEST(ShadowVolume, NothingOutsideIsHiddenAndEverythingInUmbraIs) {
    std::size_t umbra = 0, penumbra = 0, outside = 0, hidden_in_penumbra = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        RandomStream random(seed, Stream::mesh);
        const auto vector = [&] {
            return Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
        };
        const Sheet source = square({0, 0, 2}, 0.4 * vector() + Vec3{0.4, 0, 0}, 0.4 * vector() - Vec3{0, 0.4, 0});
        const Sheet occluder =
            square(Point{0, 0, 1} + 0.5 * vector(), 0.8 * vector() + Vec3{0.4, 0, 0}, 0.8 * vector() + Vec3{0, 0.4, 0});
        const ShadowVolume volume(source.corners, source.plane, occluder.corners, occluder.plane, 1e-9);
        for (int k = 0; k < 60; ++k) {
            const Point x = Vec3{0, 0, 0.3} + 2.0 * vector();
            if (source.plane.signed_distance(x) <= 1e-6) continue;  // behind the source: unlit
            std::size_t tests = 0;
            const bool in_penumbra = volume.in_penumbra(std::span(&x, 1), tests) != ShadowVolume::Place::outside;
            const bool in_umbra = volume.in_umbra(std::span(&x, 1), tests) != ShadowVolume::Place::outside;
            std::size_t blocked = 0;
            constexpr std::size_t places = 81;
            for (std::size_t i = 0; i < places; ++i) {
                const double s = static_cast<double>(i % 9) / 8, t = static_cast<double>(i / 9) / 8;
                const auto& c = source.corners;
                blocked += is_blocked(x, c[0] + s * (c[1] - c[0]) + t * (c[3] - c[0]), occluder);
            }
            if (in_umbra) {
                EXPECT_EQ(blocked, places) << seed;
            }
            if (!in_penumbra) {
                EXPECT_EQ(blocked, 0u) << seed;
            }
            umbra += in_umbra, penumbra += in_penumbra && !in_umbra, outside += !in_penumbra;
            hidden_in_penumbra += in_penumbra && blocked > 0;
        }
    }
    EXPECT_GT(umbra, 10u);
    EXPECT_GT(outside, 500u);
    EXPECT_GT(penumbra, 100u);
    EXPECT_GT(hidden_in_penumbra, (umbra + penumbra) * 8 / 10);
}

TEST(ShadowVolume, AnOccluderBehindTheSourceHidesNothing) {
    const Sheet source = square({0, 0, 2}, {1, 0, 0}, {0, -1, 0});
    const Sheet above = square({0, 0, 3}, {0.5, 0, 0}, {0, 0.5, 0});
    EXPECT_TRUE(ShadowVolume(source.corners, source.plane, above.corners, above.plane, 1e-9).is_empty());
    const Sheet across = square({0, 0, 1.5}, {0.5, 0, 0}, {0, 0, 0.4});  // its plane crosses the source
    const ShadowVolume volume(source.corners, source.plane, across.corners, across.plane, 1e-9);
    EXPECT_FALSE(volume.is_empty());
    EXPECT_FALSE(volume.has_umbra());
}

}  // namespace exitance
