#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/scene/sky/sun_position.hpp"

namespace exitance {

/// The words of a line `!gensky ...` or `!gendaylit ...`. Angles in radians but for longitudes, which are degrees west.
struct RadSkyWords {
    std::string program;
    bool older = false;  ///< Follows the programs of before November 2019.
    int month = 0, day = 0;
    double hour = 0;
    std::optional<int> year;
    bool is_solar_time = false, has_angles = false, has_meridian = false;
    double altitude = 0, azimuth = 0;  ///< The azimuth from south towards west.
    bool is_night = false;             ///< The date and hour lie before sunrise or after sunset.
    double latitude = 0.66, longitude = 2.13 * 180 / pi, meridian = 120;
    char kind = 's';  ///< s: clear, i: intermediate, c: overcast, u: uniform.
    bool has_sun = true;
    double ground = 0.2, turbidity = 2.45;
    double zenith = 0, solar = 0;
    char zenith_by = 0, solar_by = 0;  ///< 0: by formulas; b, r: radiance; B, R: irradiance.
    char input = 0;                    ///< gendaylit's P, W, L, G with two numbers, or E with one.
    double first = 0, second = 0;
    double output = 0;            ///< -O: 0 watts by the eye's weights, 1 watts, 2 lumens.
    double dew_point = 10.97353;  ///< -d, degrees C; the default makes 2 cm of water in the air.
    double interval = 0;          ///< -i: minutes about the hour for which gendaylit's sky counts.

    Vec3 sun() const {
        return {-std::sin(azimuth) * std::cos(altitude), -std::cos(azimuth) * std::cos(altitude), std::sin(altitude)};
    }
};

/// Text that a program prints, and what a user has to know of it.
struct PrintedSky {
    std::string text;
    std::vector<std::string> warnings = {};
};

/// For a kind of sky and the sun's altitude: F2 (luminance at the zenith over the sky's reference, CIE), and the
/// irradiance of a horizontal plane over pi times the zenith's luminance.
std::pair<double, double> rad_sky_factors(char kind, double altitude);

/// Text of a `light` and a `source` of that radiance; `angle`: across, degrees.
std::string rad_sun(double radiance, const Vec3& towards, double angle);

/// The text that gendaylit prints: Perez' sky. Where the program prints a sky without light (by night, light above the
/// solar constant, coefficients that the model does not cover) so does this, with a warning.
Result<PrintedSky> gendaylit_output(const RadSkyWords& in);

}  // namespace exitance
