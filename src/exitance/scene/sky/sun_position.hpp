#pragma once

#include "exitance/base/vec.hpp"

namespace exitance {

/// A moment in the Gregorian calendar, in local standard time.
struct LocalTime {
    int year = 2021, month = 1, day = 1;
    double hour = 12;  ///< 0 to 24, with its fraction.
    double zone = 0;   ///< Hours by which it is ahead of universal time.
};
bool is_date(int year, int month, int day);
int day_of_year(int year, int month, int day);  ///< From 1.
/// Days from noon of 1 January 4713 BC, universal time.
double julian_day(const LocalTime& time);

/// Where an observer stands. Degrees, north and east positive.
struct Place {
    double latitude = 0, longitude = 0;
    double elevation = 0;     ///< m above the sea.
    double pressure = 1013;   ///< mbar, of the year's mean: for refraction;
    double temperature = 12;  ///< degrees C.
};

/// Where the sun stands in the sky, degrees.
struct SunPosition {
    double altitude = 0;  ///< Above the horizon, as refraction shows it;
    double azimuth = 0;   ///< from north towards east, 0 to 360.
};

/// Apparent place of the sun's centre: the Earth's heliocentric longitude, latitude and distance by the largest terms
/// of VSOP87, nutation, aberration, parallax and refraction. Within 0.003 degrees from 1950 to 2050. Source:
/// [Reda04], [Meeus98].
SunPosition sun_position(const LocalTime& time, const Place& place);

/// The unit vector towards a place in the sky, in a scene whose y axis points `north` degrees west of north: turning y
/// by `north` clockwise, seen from above, gives north. x is to the right of y.
Normal sky_direction(double altitude, double azimuth, double north = 0);

/// Half the angle under which the sun is seen, radians (0.533 degrees across).
constexpr double sun_half_angle = 0.2665 * pi / 180;

}  // namespace exitance
