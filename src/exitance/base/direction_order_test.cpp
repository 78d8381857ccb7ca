#include "exitance/base/direction_order.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

TEST(DirectionOrder, NeighboursAreSimilarAndNoneIsLost) {
    RandomStream random(1, Stream::gather);
    std::vector<Vec3> directions;
    for (int i = 0; i < 20000; ++i)
        directions.push_back({random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5});
    DirectionOrder order;
    const std::span<const std::uint32_t> sorted = order.sort(directions);
    std::vector<std::uint8_t> seen(directions.size(), 0);
    double turns = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        ++seen[sorted[i]];
        if (i > 0) turns += std::acos(dot(normalized(directions[sorted[i]]), normalized(directions[sorted[i - 1]])));
    }
    for (const std::uint8_t count : seen) EXPECT_EQ(count, 1);
    EXPECT_LT(turns / static_cast<double>(sorted.size()), 0.12);  // radians; 1.57 in random order
}

TEST(DirectionOrder, AcceptsZeroVectors) {
    const std::vector<Vec3> directions(3);
    DirectionOrder order;
    EXPECT_EQ(order.sort(directions).size(), 3u);
}

}  // namespace
}  // namespace exitance
