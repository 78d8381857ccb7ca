#include "exitance/form_factors/point_to_polygon_batch.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {
namespace {

std::array<Point, 4> random_quad(RandomStream& random, double distance) {
    const auto spread = [&] { return 2 * random.uniform() - 1; };
    const Normal towards = normalized({spread(), spread(), spread()});
    const Point o = distance * towards;
    const Vec3 a = {spread(), spread(), spread()}, b = {spread(), spread(), spread()};
    const double t = 0.5 + random.uniform();
    std::array<Point, 4> quad = {o, o + a, o + a + t * b, o + b};
    if (dot(cross(a, b), o) > 0) std::swap(quad[1], quad[3]);
    return quad;
}

TEST(PointToQuads, AgreesWithTheScalarSumAtEveryDistance) {
    RandomStream random(1, Stream::mesh);
    for (double distance : {0.7, 2.0, 5.0, 15.0, 30.0, 100.0, 300.0, 1e4}) {
        QuadBatch batch;
        std::vector<std::array<Point, 4>> quads;
        for (int k = 0; k < 203; ++k) quads.push_back(random_quad(random, distance)), batch.add(quads.back());
        const Point x = {0.01, 0.02, 0.03};
        const Normal n = normalized({0.2, -0.3, 0.9});
        std::vector<double> F(batch.size());
        point_to_quads(x, n, batch, F);
        for (std::size_t k = 0; k < quads.size(); ++k) {
            // At grazing angles F has fewer digits in both sums: the error is compared with the form factor at normal
            // incidence.
            const double solid = 1 / (distance * distance);
            EXPECT_NEAR(F[k], point_to_polygon(x, n, quads[k]), 2e-12 * std::min(1.0, solid))
                << distance << " quad " << k;
        }
    }
}

TEST(PointToQuads, AreBitIdenticalOnAnyProcessor) {
    RandomStream random(2, Stream::mesh);
    for (std::size_t size : {3, 8, 1001}) {
        QuadBatch batch;
        for (std::size_t k = 0; k < size; ++k) batch.add(random_quad(random, std::exp(6 * random.uniform())));
        std::vector<double> fastest(size), plain(size);
        const Normal n = normalized({0.2, -0.3, 0.9});
        point_to_quads({0.01, 0.02, 0.03}, n, batch, fastest);
        for (const Processor processor : {Processor::any, Processor::avx2}) {
            point_to_quads({0.01, 0.02, 0.03}, n, batch, plain, processor);
            EXPECT_EQ(fastest, plain);
        }
    }
}

TEST(PointToQuads, DependNeitherOnPositionNorOnNeighbours) {
    RandomStream random(4, Stream::mesh);
    const Point x = {0.01, 0.02, 0.03};
    const Normal n = normalized({0.2, -0.3, 0.9});
    std::vector<std::array<Point, 4>> quads;  // small and large, cut by the horizon and below it, in mixed order
    for (int k = 0; k < 101; ++k) quads.push_back(random_quad(random, 0.3 * std::exp(8 * random.uniform())));
    for (std::size_t first : {0, 1, 5, 50}) {
        QuadBatch batch;
        for (std::size_t k = first; k < quads.size(); ++k) batch.add(quads[k]);
        std::vector<double> F(batch.size()), alone(1);
        for (Processor processor : {Processor::fastest, Processor::avx2, Processor::any}) {
            point_to_quads(x, n, batch, F, processor);
            for (std::size_t k = first; k < quads.size(); ++k) {
                QuadBatch one;
                one.add(quads[k]);
                point_to_quads(x, n, one, alone, processor);
                EXPECT_EQ(F[k - first], alone[0]) << k << " of those from " << first;
            }
        }
    }
}

TEST(PointsToQuad, AgreesWithSingleReceiversOnAnyProcessor) {
    RandomStream random(3, Stream::mesh);
    for (double distance : {0.7, 5.0, 30.0, 300.0})
        for (std::size_t size : {1, 7, 8, 43}) {
            const std::array<Point, 4> quad = random_quad(random, distance);
            ReceiverBatch receivers;
            std::vector<Point> x;
            std::vector<Normal> n;
            for (std::size_t k = 0; k < size; ++k) {
                x.push_back({0.2 * random.uniform(), 0.2 * random.uniform(), 0.2 * random.uniform()});
                n.push_back(normalized({random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5}));
                receivers.add(x[k], n[k]);
            }
            std::vector<double> F(size), plain(size);
            points_to_quad(receivers, quad, F);
            for (const Processor processor : {Processor::any, Processor::avx2}) {
                points_to_quad(receivers, quad, plain, processor);
                EXPECT_EQ(F, plain);
            }
            // the result of a quad does not depend on its neighbours in the batch
            for (std::size_t k = 0; k < size; ++k) {
                ReceiverBatch one;
                one.add(x[k], n[k]);
                points_to_quad(one, quad, std::span(plain).first(1));
                EXPECT_EQ(F[k], plain[0]);
            }
            const double solid = 1 / (distance * distance);  // tolerance as in AgreesWithTheScalarSumAtEveryDistance
            for (std::size_t k = 0; k < size; ++k)
                EXPECT_NEAR(F[k], point_to_polygon(x[k], n[k], quad), 2e-12 * std::min(1.0, solid)) << distance;
        }
}

TEST(PointToQuads, WallsAndCeilingOfAClosedRoomSumToOne) {
    QuadBatch room;
    room.add({{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}});
    room.add({{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}});
    room.add({{{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}}});
    room.add({{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}});
    room.add({{{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}}});
    std::vector<double> F(room.size());
    for (double s : {0.5, 0.1, 1e-3}) {
        point_to_quads({s, 0.3, 0}, {0, 0, 1}, room, F);
        double sum = 0;
        for (double f : F) sum += f;
        EXPECT_NEAR(sum, 1, 1e-14) << s;  // rounding errors of five terms
    }
}

TEST(PointToQuads, SmallBatchesTrianglesAndQuadsBehindAreExact) {
    for (std::size_t size = 1; size < 6; ++size) {
        QuadBatch batch;
        for (std::size_t k = 0; k < size; ++k) {
            const double z = k % 2 ? 1 : -1;
            batch.add({{{0, 0, z}, {0, 1, z}, {1, 1, z}, {1, 1, z}}});
        }
        std::vector<double> F(size);
        point_to_quads({0.2, 0.1, 0}, {0, 0, 1}, batch, F);
        const std::array<Point, 3> triangle = {{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}}};
        const double exact = point_to_polygon({0.2, 0.1, 0}, {0, 0, 1}, triangle);
        for (std::size_t k = 0; k < size; ++k) EXPECT_NEAR(F[k], k % 2 ? exact : 0, 1e-15);
    }
}

}  // namespace
}  // namespace exitance
