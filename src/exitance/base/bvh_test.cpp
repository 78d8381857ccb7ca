#include "exitance/base/bvh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"

namespace exitance {
namespace {

std::vector<Box> random_boxes(std::size_t count, double size, std::uint64_t seed = 1) {
    RandomStream random(seed, Stream::mesh);
    const auto random_point = [&] { return Vec3{random.uniform(), random.uniform(), random.uniform()}; };
    std::vector<Box> boxes(count);
    for (Box& box : boxes) {
        const Point p = random_point();
        box.add(p);
        box.add(p + size * random_point());
    }
    return boxes;
}

TEST(Bvh, FindsEveryBoxThatReachesIntoAConvexRegion) {
    const std::vector<Box> boxes = random_boxes(500, 0.1);
    const Bvh bvh(boxes);
    RandomStream random(2, Stream::mesh);
    for (int trial = 0; trial < 50; ++trial) {
        ConvexRegion region;
        std::vector<Plane> planes;
        for (int k = 0; k < 1 + trial % 9; ++k) {
            const Normal n = normalized({random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5});
            planes.push_back({n, dot(n, {0.5, 0.5, 0.5}) + 0.3 * (random.uniform() - 0.7)});
            region.add(planes.back());
        }
        std::set<std::uint32_t> expected, found;
        for (std::uint32_t i = 0; i < boxes.size(); ++i) {
            const auto outside = [&](const Plane& p) {
                bool all = true;
                for (int c = 0; c < 8; ++c)
                    all &=
                        p.signed_distance({c & 1 ? boxes[i].lo.x : boxes[i].hi.x, c & 2 ? boxes[i].lo.y : boxes[i].hi.y,
                                           c & 4 ? boxes[i].lo.z : boxes[i].hi.z}) < 0;
                return all;
            };
            if (std::none_of(planes.begin(), planes.end(), outside)) expected.insert(i);
        }
        bvh.visit_region(region, [&](std::uint32_t i) { EXPECT_TRUE(found.insert(i).second); });
        EXPECT_EQ(found, expected);
    }
}

TEST(Bvh, FindsEveryBoxThatASegmentMeets) {
    const std::vector<Box> boxes = random_boxes(500, 0.1);
    const Bvh bvh(boxes);
    RandomStream random(3, Stream::mesh);
    for (int trial = 0; trial < 100; ++trial) {
        const Point o{random.uniform(), random.uniform(), random.uniform()};
        Vec3 d{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
        if (trial % 4 == 0) d.z = 0;
        std::set<std::uint32_t> found;
        bvh.visit_segment(o, d, 1.0, [&](std::uint32_t i) { return found.insert(i), 1.0; });
        for (std::uint32_t i = 0; i < boxes.size(); ++i) {
            bool inside = false;
            for (int k = 0; k <= 200; ++k) {
                const Point p = o + (k / 200.0) * d;
                inside |= p == min(max(p, boxes[i].lo), boxes[i].hi);
            }
            EXPECT_TRUE(!inside || found.contains(i));
        }
    }
}

TEST(Bvh, HoldsAnyNumberOfEqualBoxes) {
    const std::vector<Box> boxes(1000, random_boxes(1, 0.5)[0]);
    const Bvh bvh(boxes);
    std::size_t count = 0;
    bvh.visit_box(boxes[0], [&](std::uint32_t) { ++count; });
    EXPECT_EQ(count, boxes.size());
    Bvh(std::span<const Box>()).visit_box(boxes[0], [&](std::uint32_t) { ++count; });
    EXPECT_EQ(count, boxes.size());
}

/// Sizes around that of the largest subtree that one thread builds.
TEST(Bvh, IsTheSameOnAnyNumberOfThreads) {
    for (const std::size_t size : {4096u, 4097u, 50000u}) {
        const std::vector<Box> boxes = random_boxes(size, 0.02);
        Box query;
        query.add(Point{0.2, 0.3, 0.1}), query.add(Point{0.7, 0.6, 0.9});
        const auto visits = [&](int count) {
            set_threads(count);
            const Bvh bvh(boxes);
            std::vector<std::uint32_t> out;
            bvh.visit_box(query, [&](std::uint32_t i) { out.push_back(i); });
            return out;
        };
        const std::vector<std::uint32_t> alone = visits(1);
        EXPECT_EQ(alone, visits(3));
        set_threads(0);
        const auto meets = [&](const Box& b) {
            return b.lo.x <= query.hi.x && query.lo.x <= b.hi.x && b.lo.y <= query.hi.y && query.lo.y <= b.hi.y &&
                   b.lo.z <= query.hi.z && query.lo.z <= b.hi.z;
        };
        EXPECT_EQ(static_cast<std::ptrdiff_t>(alone.size()), std::count_if(boxes.begin(), boxes.end(), meets));
    }
}

}  // namespace
}  // namespace exitance
