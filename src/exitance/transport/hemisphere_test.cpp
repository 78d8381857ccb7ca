#include "exitance/transport/hemisphere.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace exitance {
namespace {

TEST(CosineDirections, AreThoseOfOneByOneAndHaveUnitLength) {
    const Frame frame(normalized(Vec3{1, 2, -0.5}));
    std::vector<Vec2> pairs = {{0.5, 0.5}, {0, 0}, {0.5, 0.2}, {1 - 0x1p-32, 0.3}};  // middle, corner, diagonal, edge
    const ScrambledSobol points(1);
    for (std::uint32_t k = 0; k < 31; ++k) pairs.push_back({points(k, 0), points(k, 1)});
    std::vector<Vec3> many(pairs.size());
    cosine_directions(frame, pairs, many);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        EXPECT_EQ(many[i], cosine_direction(frame, pairs[i].x, pairs[i].y));
        EXPECT_NEAR(norm(many[i]), 1, 1e-12);
        EXPECT_GT(dot(many[i], frame.n), 0);
    }
}

TEST(CosineDirections, HaveTheMomentsOfTheirDensity) {
    // Of density cos / pi: the mean of cos is 2/3, of cos^2 and of each sideways component's square 1/2 and 1/4.
    const Frame frame({0, 0, 1});
    const ScrambledSobol points(2);
    constexpr std::uint32_t count = 4096;
    double cosine = 0, square = 0, sideways = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
        const Vec3 d = cosine_direction(frame, points(k, 0), points(k, 1));
        cosine += d.z / count, square += d.z * d.z / count, sideways += d.x * d.x / count;
    }
    EXPECT_NEAR(cosine, 2.0 / 3, 1e-4);  // points leave count^-3/2 or so of smooth functions
    EXPECT_NEAR(square, 0.5, 1e-4);
    EXPECT_NEAR(sideways, 0.25, 1e-4);
}

}  // namespace
}  // namespace exitance
