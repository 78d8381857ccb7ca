#pragma once

#include <string>
#include <vector>

#include "exitance/core/result.hpp"
#include "exitance/scene/sky/sun_position.hpp"

namespace exitance {

/// An hour of a weather file, in local standard time: the hour that ends at `hour`.
struct WeatherHour {
    int year = 2021, month = 1, day = 1, hour = 1;
    double direct_normal = 0, diffuse_horizontal = 0;  ///< W/m^2, means over the hour; 0 where they are missing.
    bool is_missing = false;

    /// The middle of the hour.
    LocalTime middle(double zone) const { return {year, month, day, hour - 0.5, zone}; }
};

/// EnergyPlus' weather file.
struct Weather {
    std::string city;
    Place place;
    double zone = 0;  ///< Hours ahead of universal time.
    std::vector<WeatherHour> hours;

    /// The hour that holds a moment of the year; none if there is none.
    const WeatherHour* at(int month, int day, double hour) const;
};

/// Reads a weather file (.epw): place and irradiances. Of direct and diffuse light the one that is missing (9999 and
/// more) follows from the other and from global light; else the hour is missing, and counts as no light. 29 February is
/// one of a leap year, whatever the line's year. Error: of code bad_input with the line.
Result<Weather> load_epw(const std::string& path);

}  // namespace exitance
