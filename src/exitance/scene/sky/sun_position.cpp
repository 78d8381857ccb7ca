#include "exitance/scene/sky/sun_position.hpp"

#include <cmath>
#include <span>

namespace exitance {
namespace {

struct Term {
    double a, b, c;
};

/// Returns the sum of A cos(B + C t), t in millennia from 2000.
double series(std::span<const Term> terms, double t) {
    double sum = 0;
    for (const auto& [a, b, c] : terms) sum += a * std::cos(b + c * t);
    return sum;
}

// Terms of VSOP87 for the Earth, in 1e-8 rad and 1e-8 AU [Reda04].
constexpr Term longitude_0[] = {{175347046, 0, 0},           {3341656, 4.6692568, 6283.07585},
                                {34894, 4.6261, 12566.1517}, {3497, 2.7441, 5753.3849},
                                {3418, 2.8289, 3.5231},      {3136, 3.6277, 77713.7715},
                                {2676, 4.4181, 7860.4194},   {2343, 6.1352, 3930.2097},
                                {1324, 0.7425, 11506.7698},  {1273, 2.0371, 529.691},
                                {1199, 1.1096, 1577.3435},   {990, 5.233, 5884.927},
                                {902, 2.045, 26.298},        {857, 3.508, 398.149},
                                {780, 1.179, 5223.694},      {753, 2.533, 5507.553},
                                {505, 4.583, 18849.228},     {492, 4.205, 775.523},
                                {357, 2.92, 0.067},          {317, 5.849, 11790.629}};
constexpr Term longitude_1[] = {
    {628331966747, 0, 0}, {206059, 2.678235, 6283.07585}, {4303, 2.6351, 12566.1517}, {425, 1.59, 3.523}};
constexpr Term longitude_2[] = {{52919, 0, 0}, {8720, 1.0721, 6283.0758}, {309, 0.867, 12566.152}};
constexpr Term distance_0[] = {
    {100013989, 0, 0},          {1670700, 3.0984635, 6283.07585}, {13956, 3.05525, 12566.1517},
    {3084, 5.1985, 77713.7715}, {1628, 1.1739, 5753.3849},        {1576, 2.8469, 7860.4194}};
constexpr Term distance_1[] = {{103019, 1.10749, 6283.07585}};

}  // namespace

bool is_date(int year, int month, int day) {
    constexpr int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    if (year < 1 || year > 9999 || month < 1 || month > 12 || day < 1) return false;
    const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    return day <= days[month - 1] + (month == 2 && leap ? 1 : 0);
}

int day_of_year(int year, int month, int day) {
    constexpr int before[] = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
    const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    return before[month - 1] + day + (leap && month > 2 ? 1 : 0);
}

double julian_day(const LocalTime& time) {
    const double y = time.month > 2 ? time.year : time.year - 1, m = time.month > 2 ? time.month : time.month + 12;
    const double century = std::floor(y / 100), leap = 2 - century + std::floor(century / 4);
    return std::floor(365.25 * (y + 4716)) + std::floor(30.6001 * (m + 1)) + time.day + leap - 1524.5 +
           (time.hour - time.zone) / 24;
}

SunPosition sun_position(const LocalTime& time, const Place& place) {
    constexpr double delta_t = 69;  // seconds from universal to terrestrial time, in the first decades of this century
    const double universal = julian_day(time), terrestrial = universal + delta_t / 86400;
    const double century = (terrestrial - 2451545) / 36525, t = century / 10;
    const double earth =
        (series(longitude_0, t) + t * series(longitude_1, t) + t * t * series(longitude_2, t)) / 1e8;  // rad
    const double distance = (series(distance_0, t) + t * series(distance_1, t)) / 1e8;                 // AU

    // The four largest terms of the nutation, arc seconds.
    const double node = (125.04452 - 1934.136261 * century) * degree, sun = (280.4665 + 36000.7698 * century) * degree,
                 moon = (218.3165 + 481267.8813 * century) * degree;
    const double in_longitude =
        -17.20 * std::sin(node) - 1.32 * std::sin(2 * sun) - 0.23 * std::sin(2 * moon) + 0.21 * std::sin(2 * node);
    const double in_obliquity =
        9.20 * std::cos(node) + 0.57 * std::cos(2 * sun) + 0.10 * std::cos(2 * moon) - 0.09 * std::cos(2 * node);
    const double obliquity = (23.4392911 - 0.0130042 * century + in_obliquity / 3600) * degree;
    const double aberration = -20.4898 / 3600 / distance;
    const double lambda = earth + pi + (in_longitude / 3600 + aberration) * degree;

    const double ascension = std::atan2(std::sin(lambda) * std::cos(obliquity), std::cos(lambda));
    const double declination = std::asin(std::sin(obliquity) * std::sin(lambda));
    const double since = universal - 2451545, turned = since / 36525;
    const double sidereal = 280.46061837 + 360.98564736629 * since + 0.000387933 * turned * turned +
                            in_longitude / 3600 * std::cos(obliquity);  // sidereal time at Greenwich, degrees
    const double hour_angle = (std::fmod(sidereal, 360.0) + place.longitude) * degree - ascension;

    const double phi = place.latitude * degree;
    const double sine =
        std::sin(phi) * std::sin(declination) + std::cos(phi) * std::cos(declination) * std::cos(hour_angle);
    const double azimuth =
        std::atan2(std::sin(hour_angle), std::cos(hour_angle) * std::sin(phi) - std::tan(declination) * std::cos(phi));
    double altitude = std::asin(std::fmin(1.0, std::fmax(-1.0, sine)));
    altitude -= 8.794 / 3600 * degree / distance * std::cos(altitude);  // parallax
    double shown = altitude / degree;
    // Degrees; below it the disc is not visible and there is no refraction.
    constexpr double lowest = -0.5667 - 0.26667;
    if (shown > lowest)
        shown += place.pressure / 1010 * 283 / (273 + place.temperature) * 1.02 /
                 (60 * std::tan((shown + 10.3 / (shown + 5.11)) * degree));
    double from_north = std::fmod(azimuth / degree + 180, 360.0);
    if (from_north < 0) from_north += 360;
    return {shown, from_north};
}

Normal sky_direction(double altitude, double azimuth, double north) {
    const double h = altitude * degree, a = (azimuth + north) * degree;
    return {std::cos(h) * std::sin(a), std::cos(h) * std::cos(a), std::sin(h)};
}

}  // namespace exitance
