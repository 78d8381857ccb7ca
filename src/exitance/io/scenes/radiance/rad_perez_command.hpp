#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/scene/sky/sun_position.hpp"

namespace exitance {

/// Parsed arguments of a line `!gensky ...` or `!gendaylit ...`. Angles in radians, except longitudes, in degrees west.
struct RadSkyWords {
    std::string program;
    bool older = false;  ///< Follows the programs before November 2019.
    int month = 0, day = 0;
    double hour = 0;
    std::optional<int> year;
    bool is_solar_time = false, has_angles = false, has_meridian = false;
    double altitude = 0, azimuth = 0;  ///< The azimuth is from south towards west.
    bool is_night = false;             ///< The date and hour are before sunrise or after sunset.
    double latitude = 0.66, longitude = 2.13 * 180 / pi, meridian = 120;
    char kind = 's';  ///< s: clear, i: intermediate, c: overcast, u: uniform.
    bool has_sun = true;
    double ground = 0.2, turbidity = 2.45;
    double zenith = 0, solar = 0;
    char zenith_by = 0, solar_by = 0;  ///< How they are given: 0: by formulas; b, r: as radiance; B, R: as irradiance.
    char input = 0;                    ///< gendaylit's P, W, L, G with two numbers, or E with one.
    double first = 0, second = 0;
    double output = 0;            ///< -O: 0: lumens over 179, 1: watts, 2: lumens.
    double dew_point = 10.97353;  ///< -d, degrees C; the default gives 2 cm of precipitable water.
    double interval = 0;          ///< -i: interval around the hour, minutes.

    Vec3 sun() const {
        return {-std::sin(azimuth) * std::cos(altitude), -std::cos(azimuth) * std::cos(altitude), std::sin(altitude)};
    }
};

/// Output of a sky program, and warnings for the user.
struct PrintedSky {
    std::string text;
    std::vector<std::string> warnings = {};
};

/// Computes two factors for a kind of sky and the sun's altitude (radians): F2, the ratio of zenith luminance to the
/// sky's reference luminance (CIE), and the ratio of horizontal irradiance to pi times the zenith luminance.
std::pair<double, double> rad_sky_factors(char kind, double altitude);

/// Formats a `light` of that radiance and a `source` of `angle` degrees diameter.
std::string rad_sun(double radiance, const Vec3& towards, double angle);

/// Returns the text that gendaylit prints: Perez' sky. If the program prints a sky without light (at night, for light
/// above the solar constant, for coefficients outside the model), so does this function, with a warning.
Result<PrintedSky> gendaylit_output(const RadSkyWords& in);

}  // namespace exitance
