#include "exitance/lab/bsp/merged_volumes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "exitance/base/random.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

constexpr double thickness = 1e-9;
using Place = ShadowVolume::Place;

Plane plane_of(std::span<const Point> corners) {
    const Normal n = normalized(area_vector(corners));
    return {n, dot(n, corners[0])};
}

/// A lamp at z = 2 and random triangles below it, which may intersect.
std::vector<ShadowVolume> some_volumes(std::uint64_t seed, int count) {
    RandomStream random(seed, Stream::mesh);
    const std::vector<Point> lamp{{-0.1, 0.1, 2}, {0.1, 0.1, 2}, {0.1, -0.1, 2}, {-0.1, -0.1, 2}};
    std::vector<ShadowVolume> out;
    for (int i = 0; i < count; ++i) {
        const Point middle = Point{0, 0, 1} + test::any_in_cube(random);
        std::vector<Point> triangle;
        for (int k = 0; k < 3; ++k) triangle.push_back(middle + 0.8 * test::any_in_cube(random));
        out.emplace_back(lamp, plane_of(lamp), triangle, plane_of(triangle), thickness);
    }
    return out;
}

MergedVolumes merged(std::span<const ShadowVolume> volumes, std::size_t most = MergedVolumes::max_nodes) {
    MergedVolumes out({{-2, -2, 0}, {2, 2, 2}}, thickness, most);
    for (const ShadowVolume& v : volumes) out.add(v);
    return out;
}

Point any_place(RandomStream& random) {
    return {4 * random.uniform() - 2, 4 * random.uniform() - 2, 2 * random.uniform()};
}

}  // namespace

TEST(MergedVolumes, ClassifyPointsLikeSeparateVolumes) {
    std::size_t in_umbra = 0, in_penumbra = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed)
        for (const std::size_t most :
             {MergedVolumes::max_nodes, std::size_t(200)}) {  // the second limit leaves some unmerged
            const std::vector<ShadowVolume> volumes = some_volumes(seed, 8);
            const MergedVolumes tree = merged(volumes, most);
            EXPECT_EQ(tree.unmerged() > 0, most == 200);
            RandomStream random(seed, Stream::mesh, 1);
            MergedVolumes::Classes classes;
            std::size_t tests = 0, tests_apart = 0;
            for (int k = 0; k < 500; ++k) {
                const Point x = any_place(random);
                std::vector<std::uint32_t> reached;
                bool is_hidden = false;
                for (std::uint32_t v = 0; v < volumes.size(); ++v) {
                    if (volumes[v].in_penumbra(std::span(&x, 1), tests_apart) != Place::outside) reached.push_back(v);
                    is_hidden |= volumes[v].in_umbra(std::span(&x, 1), tests_apart) == Place::inside;
                }
                tree.classify(std::span(&x, 1), classes, tests);
                EXPECT_EQ(classes.reached, reached) << seed;
                EXPECT_EQ(classes.is_hidden, is_hidden) << seed;
                in_umbra += is_hidden, in_penumbra += reached.size();
            }
            if (most != 200) {
                EXPECT_LT(tests, tests_apart);
            }
        }
    EXPECT_GT(in_umbra, 30u);
    EXPECT_GT(in_penumbra, 1000u);
}

TEST(MergedVolumes, ClassifyPolygonsBetweenTheirPointsAndSeparateVolumes) {
    std::size_t hidden = 0, hidden_apart = 0, reached = 0, reached_apart = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const std::vector<ShadowVolume> volumes = some_volumes(seed, 8);
        const MergedVolumes tree = merged(volumes);
        RandomStream random(seed, Stream::mesh, 2);
        MergedVolumes::Classes of_all, of_point;
        std::size_t tests = 0;
        for (int k = 0; k < 100; ++k) {
            const Point at = Point{0, 0, 1} + 0.7 * (any_place(random) - Point{0, 0, 1});
            const double size = k % 2 == 0 ? 0.05 : 0.5;
            std::vector<Point> face;
            for (int c = 0; c < 3; ++c) face.push_back(at + size * test::any_in_cube(random));
            tree.classify(face, of_all, tests);
            for (int i = 0; i < 40; ++i) {
                const double a = random.uniform(), b = random.uniform() * (1 - a);
                const Point x = face[0] + a * (face[1] - face[0]) + b * (face[2] - face[0]);
                tree.classify(std::span(&x, 1), of_point, tests);
                EXPECT_TRUE(std::includes(of_all.reached.begin(), of_all.reached.end(), of_point.reached.begin(),
                                          of_point.reached.end()));
                EXPECT_TRUE(of_point.is_hidden || !of_all.is_hidden);
            }
            bool one_hides = false;
            for (std::uint32_t v = 0; v < volumes.size(); ++v) {
                const bool reaches = volumes[v].in_penumbra(face, tests) != Place::outside;
                reached_apart += reaches;
                EXPECT_TRUE(reaches || !std::binary_search(of_all.reached.begin(), of_all.reached.end(), v));
                one_hides |= volumes[v].in_umbra(face, tests) == Place::inside;
            }
            EXPECT_TRUE(of_all.is_hidden || !one_hides);
            hidden += of_all.is_hidden, hidden_apart += one_hides, reached += of_all.reached.size();
        }
    }
    EXPECT_GE(hidden, hidden_apart);
    EXPECT_GT(hidden_apart, 5u);
    EXPECT_LT(reached, reached_apart);
}

TEST(MergedVolumes, TwoUmbraeTogetherHideAPolygon) {
    const std::vector<Point> lamp{{-0.1, 0.1, 2}, {0.1, 0.1, 2}, {0.1, -0.1, 2}, {-0.1, -0.1, 2}};
    const auto half = [&](double x0, double x1) {
        const std::vector<Point> board{{x0, -1, 1}, {x1, -1, 1}, {x1, 1, 1}, {x0, 1, 1}};
        return ShadowVolume(lamp, plane_of(lamp), board, plane_of(board), thickness);
    };
    const std::vector<ShadowVolume> volumes{half(-1, 0.5), half(-0.5, 1)};
    const std::vector<Point> face{{-1, -0.2, 0}, {1, -0.2, 0}, {1, 0.2, 0}, {-1, 0.2, 0}};
    std::size_t tests = 0;
    for (const ShadowVolume& v : volumes) EXPECT_EQ(v.in_umbra(face, tests), Place::partly);
    MergedVolumes::Classes classes;
    merged(volumes).classify(face, classes, tests);
    EXPECT_TRUE(classes.is_hidden);
    EXPECT_EQ(classes.reached, (std::vector<std::uint32_t>{0, 1}));
}

}  // namespace exitance
