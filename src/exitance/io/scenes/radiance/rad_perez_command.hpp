#pragma once

#include <optional>
#include <string>
#include <utility>

#include "exitance/core/result.hpp"
#include "exitance/scene/sky/sun_position.hpp"

namespace exitance {

/// What a line `!gensky ...` or `!gendaylit ...` says. Angles in radians but for longitudes, which are degrees west.
struct RadSkyWords {
    std::string program;
    int month = 0, day = 0;
    double hour = 0;
    std::optional<int> year;
    bool is_solar_time = false, has_angles = false, has_meridian = false;
    double altitude = 0, azimuth = 0;  ///< The azimuth from south towards west.
    double latitude = 0.66, longitude = 2.13 * 180 / pi, meridian = 120;
    char kind = 's';  ///< s: clear, i: intermediate, c: overcast, u: uniform.
    bool has_sun = true;
    double ground = 0.2, turbidity = 2.45;
    double zenith = 0, solar = 0;
    char zenith_by = 0, solar_by = 0;  ///< 0: by formulas; b, r: radiance; B, R: irradiance.
    char input = 0;                    ///< gendaylit's P, W, L, G, and its two numbers.
    double first = 0, second = 0;
    double output = 0;  ///< -O: 0 watts by the eye's weights, 1 watts, 2 lumens.

    Vec3 sun() const {
        return {-std::sin(azimuth) * std::cos(altitude), -std::cos(azimuth) * std::cos(altitude), std::sin(altitude)};
    }
};

/// F2 (luminance at the zenith over the sky's reference, CIE) and what a horizontal plane gets over pi times the
/// zenith's luminance, for a kind of sky and the sun's altitude.
std::pair<double, double> rad_sky_factors(char kind, double altitude);

/// A `light` and a `source` of that radiance; `angle`: across, degrees.
std::string rad_sun(double radiance, const Vec3& towards, double angle);

/// What gendaylit prints: Perez' sky.
Result<std::string> gendaylit_output(const RadSkyWords& in);

}  // namespace exitance
