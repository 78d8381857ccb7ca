#include "exitance/io/scenes/radiance/rad_sky_sun.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// Declination, radians, and solar time, hours.
struct SolarDay {
    double declination = 0, time = 12;
};

/// Declination on a day of the year, from 1. `older` uses the period before November 2019, which was three days too
/// long.
double declination_of(int day, bool older) {
    const double period = older ? 368 : 365;
    return 0.4093 * std::sin(2 * pi / period * (day - 81));
}

double within(double value, double period) {
    return value - period * std::floor(value / period);
}

/// Declination and solar time at a time of a given year [Michalsky88].
SolarDay almanac_day(const RadSkyWords& in) {
    // Days since 2000-01-01 12:00 UT.
    const double days = julian_day({*in.year, in.month, in.day, in.hour, -in.meridian / 15}) - 2451545;
    const double mean_longitude = 280.460 + 0.9856474 * days, anomaly = (357.528 + 0.9856003 * days) * degree;
    const double longitude = (mean_longitude + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * degree;
    const double obliquity = (23.439 - 4e-7 * days) * degree;
    const double ascension = std::atan2(std::sin(longitude) * std::cos(obliquity), std::cos(longitude)) / degree;
    const double universal = 24 * (days - std::floor(days)) + 12;
    const double sidereal = 6.697375 + 0.0657098242 * days + universal - in.longitude / 15;  // hours, local
    return {std::asin(std::sin(obliquity) * std::sin(longitude)), within(sidereal - ascension / 15 + 12, 24)};
}

/// Declination and solar time on a `day` of the year.
SolarDay solar_day(const RadSkyWords& in, int day) {
    SolarDay out{declination_of(day, in.older), in.hour};
    if (in.year) {
        const SolarDay almanac = almanac_day(in);
        return in.is_solar_time ? SolarDay{almanac.declination, in.hour} : almanac;
    }
    if (!in.is_solar_time)
        out.time += 0.170 * std::sin(4 * pi / 373 * (day - 80)) - 0.129 * std::sin(2 * pi / 355 * (day - 8)) +
                    (in.meridian - in.longitude) / 15;
    return out;
}

/// Moves `time` to the middle of the interval's daylight if the interval contains sunrise or sunset. Returns true if
/// the interval is dark. As in gendaylit, nothing changes if the sun does not rise or set on that day.
bool is_dark_interval(const RadSkyWords& in, int day, double& time) {
    const double cosine = -std::tan(in.latitude) * std::tan(declination_of(day, in.older));
    if (!(std::abs(cosine) <= 1)) return false;
    const double half_day = std::acos(cosine) * 12 / pi, rise = 12 - half_day, set = 12 + half_day;
    const double half = in.interval / 120;  // hours
    if (half > 0 && std::abs(rise - time) <= half) time = 0.5 * (time + half + rise);
    if (half > 0 && std::abs(set - time) < half) time = 0.5 * (time - half + set);
    return time < rise - half || time > set + half;
}

}  // namespace

void place_rad_sun(RadSkyWords& in) {
    if (in.has_angles) return;
    const int day = day_of_year(2021, in.month, in.day);
    SolarDay at = solar_day(in, day);
    if (in.program == "gendaylit") in.is_night = is_dark_interval(in, day, at.time);
    const double turn = at.time * pi / 12, s = std::sin(in.latitude), c = std::cos(in.latitude);
    const double cd = std::cos(at.declination), sd = std::sin(at.declination);
    in.altitude = std::asin(std::clamp(s * sd - c * cd * std::cos(turn), -1.0, 1.0));
    in.azimuth = -std::atan2(cd * std::sin(turn), -c * sd - s * cd * std::cos(turn));
}

}  // namespace exitance
