#pragma once

#include "exitance/base/vec.hpp"

namespace exitance {

/// A time in the Gregorian calendar, in local standard time.
struct LocalTime {
    int year = 2021, month = 1, day = 1;
    double hour = 12;  ///< Hour of the day, 0 to 24, including the fraction.
    double zone = 0;   ///< Time zone, hours ahead of universal time.
};
/// The year of dates without one, if there is a 29 February among them; derived from the calendar: any leap year does.
inline constexpr int leap_year = 2020;
bool is_date(int year, int month, int day);
int day_of_year(int year, int month, int day);  ///< Returns the day of the year: 1 for 1 January.
/// Returns the days since noon of 1 January 4713 BC, universal time.
double julian_day(const LocalTime& time);

/// Position of an observer. Degrees, north and east positive.
struct Place {
    double latitude = 0, longitude = 0;
    double elevation = 0;     ///< Metres above sea level.
    double pressure = 1013;   ///< Annual mean in mbar, for refraction.
    double temperature = 12;  ///< Annual mean in degrees C, for refraction.
};

/// Position of the sun in the sky, degrees.
struct SunPosition {
    double altitude = 0;  ///< Angle above the horizon, including refraction.
    double azimuth = 0;   ///< Angle from north towards east, 0 to 360.
};

/// Returns the apparent position of the sun's centre: heliocentric longitude, latitude and distance of the Earth by the
/// largest terms of VSOP87, nutation, aberration, parallax and refraction. Error at most 0.003 degrees from 1950 to
/// 2050. Source: [Reda04], [Meeus98].
SunPosition sun_position(const LocalTime& time, const Place& place);

/// Returns the unit vector to a position in the sky, in a scene whose y axis points `north` degrees west of north:
/// rotating y by `north` clockwise, seen from above, gives north. x is to the right of y.
Normal sky_direction(double altitude, double azimuth, double north = 0);

/// Half of the sun's angular diameter, radians (0.533 degrees across).
constexpr double sun_half_angle = 0.2665 * pi / 180;

}  // namespace exitance
