#include "exitance/scene/sky/sun_position.hpp"

#include <gtest/gtest.h>

namespace exitance {

TEST(SunPosition, IsThatOfThePublishedCase) {
    // [Reda04], table A5.1.
    const LocalTime time{2003, 10, 17, 12 + 30.0 / 60 + 30.0 / 3600, -7};
    const SunPosition sun = sun_position(time, {39.742476, -105.1786, 1830.14, 820, 11});
    EXPECT_NEAR(90 - sun.altitude, 50.11162, 0.001);
    EXPECT_NEAR(sun.azimuth, 194.34024, 0.001);
}

TEST(SunPosition, IsAboveTheTropicAtTheSolstice) {
    // June solstice 2020: 20 June, 21:44 universal time; declination 23.4365 degrees. At latitude 0, on the meridian of
    // the sun.
    double highest = -90;
    for (int i = 0; i < 4000; ++i) {
        const LocalTime time{2020, 6, 20, 21.4 + i * 2e-4, 0};
        highest = std::max(highest, sun_position(time, {23.4365, -146, 0, 0, 10}).altitude);
    }
    EXPECT_GT(highest, 89.99);
}

TEST(SunPosition, JulianDaysAndDates) {
    EXPECT_EQ(julian_day({2000, 1, 1, 12, 0}), 2451545);
    EXPECT_NEAR(julian_day({1987, 6, 19, 12, 0}), 2446966, 1e-9);
    EXPECT_EQ(day_of_year(2024, 12, 31), 366);
    EXPECT_EQ(day_of_year(2023, 3, 1), 60);
    EXPECT_TRUE(is_date(2024, 2, 29));
    EXPECT_FALSE(is_date(2023, 2, 29));
    EXPECT_FALSE(is_date(2023, 13, 1));
}

TEST(SunPosition, NorthRotatesWithTheScene) {
    const Normal south = sky_direction(0, 180), turned = sky_direction(0, 180, 90);
    EXPECT_NEAR(south.y, -1, 1e-12);
    EXPECT_NEAR(turned.x, -1, 1e-12);  // north is towards +x, south towards -x
}

}  // namespace exitance
