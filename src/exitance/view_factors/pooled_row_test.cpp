#include "exitance/view_factors/pooled_row.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

TEST(PooledRow, WeighsEntriesBySamplesAndTakesIntegratedOnesAsTheyAre) {
    RawRow a, b;
    a.face = b.face = 3;
    a.cast_rays = 300, a.cast_density = 3, a.sky = 0.2, a.sky_variance = 1e-4;
    b.cast_rays = 100, b.cast_density = 1, b.sky = 0.4, b.sky_variance = 3e-4;
    a.entries = {{0.1, 0, 1e-4F, 3}, {0.25, 2, 0, integrated}, {0.2, 5, 1e-4F, 3}};
    b.entries = {{0.3, 0, 3e-4F, 1}, {0.5, 2, 1e-3F, 1}, {0.1, 4, 1e-4F, 1}};
    const RawRow row = pooled(a, b);
    EXPECT_EQ(row.face, 3U);
    EXPECT_EQ(row.cast_rays, 400U);
    EXPECT_NEAR(row.sky, 0.25, 1e-15);
    EXPECT_NEAR(row.sky_variance, 0.75 * 0.75 * 1e-4 + 0.25 * 0.25 * 3e-4, 1e-15);
    ASSERT_EQ(row.entries.size(), 4U);
    EXPECT_NEAR(row.entries[0].F, 0.15, 1e-15);
    EXPECT_NEAR(row.entries[0].variance, 0.75 * 0.75 * 1e-4 + 0.25 * 0.25 * 3e-4, 1e-9);
    EXPECT_EQ(row.entries[1].F, 0.25);  // integrated
    EXPECT_EQ(row.entries[1].variance, 0);
    EXPECT_EQ(row.entries[2].column, 4U);
    EXPECT_NEAR(row.entries[2].F, 0.025, 1e-15);  // no ray of the first row hit this face
    EXPECT_NEAR(row.entries[3].F, 0.15, 1e-15);
    EXPECT_EQ(row.entries[3].density, 4);
}

}  // namespace
}  // namespace exitance
