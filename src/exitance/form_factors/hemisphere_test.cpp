#include "exitance/form_factors/hemisphere.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace exitance {
namespace {

TEST(CosineDirections, AgreeWithSingleCallsOnAnyProcessorAndHaveUnitLength) {
    const Frame frame(normalized(Vec3{1, 2, -0.5}));
    std::vector<double> a = {0.5, 0, 0.5, 1 - 0x1p-32}, b = {0.5, 0, 0.2, 0.3};  // centre, corner, diagonal, edge
    const ScrambledSobol points(1);
    for (std::uint32_t k = 0; k < 31; ++k) a.push_back(points(k, 0)), b.push_back(points(k, 1));
    for (const Processor processor : {Processor::fastest, Processor::avx2, Processor::any}) {
        std::vector<Vec3> many(a.size());
        cosine_directions(frame, a, b, many, processor);
        for (std::size_t i = 0; i < a.size(); ++i) {
            EXPECT_EQ(many[i], cosine_direction(frame, a[i], b[i]));
            EXPECT_NEAR(norm(many[i]), 1, 1e-12);
            EXPECT_GT(dot(many[i], frame.n), 0);
        }
    }
}

TEST(CosineDirections, HaveTheMomentsOfTheirDensity) {
    // For density cos / pi, the mean of cos is 2/3, of cos^2 1/2, and of the square of each tangential component 1/4.
    const Frame frame({0, 0, 1});
    const ScrambledSobol points(2);
    constexpr std::uint32_t count = 4096;
    double cosine = 0, square = 0, sideways = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
        const Vec3 d = cosine_direction(frame, points(k, 0), points(k, 1));
        cosine += d.z / count, square += d.z * d.z / count, sideways += d.x * d.x / count;
    }
    EXPECT_NEAR(cosine, 2.0 / 3, 1e-4);  // for smooth functions, the error of the points is about count^-3/2
    EXPECT_NEAR(square, 0.5, 1e-4);
    EXPECT_NEAR(sideways, 0.25, 1e-4);
}

}  // namespace
}  // namespace exitance
