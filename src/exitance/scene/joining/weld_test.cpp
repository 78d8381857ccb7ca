#include "exitance/scene/joining/weld.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// Reference implementation that compares all pairs.
std::vector<std::uint32_t> weld_slowly(const std::vector<Point>& points, double tolerance) {
    std::vector<std::uint32_t> out(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        out[i] = i;
        for (std::uint32_t j = 0; j < i && out[i] == i; ++j)
            if (out[j] == j && norm(points[j] - points[i]) <= tolerance) out[i] = j;
    }
    return out;
}

}  // namespace

TEST(Weld, FindsTheFirstPointNearby) {
    RandomStream random(1, Stream::mesh);
    for (const double size : {1.0, 1e-4, 1e6}) {
        std::vector<Point> points;
        for (int i = 0; i < 600; ++i) {
            const auto coordinate = [&] { return size * (std::floor(20 * random.uniform()) / 4 - 2); };
            const Point p = {coordinate(), coordinate(), 0};
            const auto moved = [&](double x) { return x + 3e-9 * size * (random.uniform() - 0.5); };
            points.push_back({moved(p.x), moved(p.y), moved(p.z)});
        }
        for (const double far : {1e28, HUGE_VAL, 1e308, 1e28, 1e308}) points.push_back({0, far, 0});
        for (const double tolerance : {0.0, 1e-9 * size})
            EXPECT_EQ(weld(points, tolerance), weld_slowly(points, tolerance));
    }
}

}  // namespace exitance
