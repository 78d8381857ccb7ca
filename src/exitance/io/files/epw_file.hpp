#pragma once

#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/scene/sky/sun_position.hpp"

namespace exitance {

/// Weather of one hour, in local standard time: the hour that ends at `hour`, 1 to 24.
struct WeatherHour {
    int year = 2021, month = 1, day = 1, hour = 1;
    double direct_normal = 0, diffuse_horizontal = 0;  ///< Mean irradiances of the hour, W/m^2; 0 if missing.
    bool is_missing = false;

    /// Returns the middle of the hour; `zone` is the time zone in hours ahead of UTC.
    LocalTime middle(double zone) const { return {year, month, day, hour - 0.5, zone}; }
};

/// Content of an EnergyPlus weather file.
struct Weather {
    std::string city;
    Place place;
    double zone = 0;  ///< Time zone, hours ahead of UTC.
    std::vector<WeatherHour> hours;
    std::vector<std::string> warnings;  ///< One sentence for each kind of missing or corrected data.

    /// Returns the hour that contains a moment of the year, or null.
    const WeatherHour* at(int month, int day, double hour) const;
    /// Returns empty text if the file holds every hour of one year exactly once (with or without 29 February),
    /// otherwise a sentence that describes the difference.
    std::string not_a_year() const;
};

/// Luminous efficacies for converting between irradiance and illuminance, lm/W.
struct WeatherEfficacies {
    double direct = 100, diffuse = 120;
};

/// Reads a weather file (.epw): location and hourly irradiances.
///
/// The header begins with LOCATION. Hours begin after DATA PERIODS, or with the first line of numbers. Fields are
/// separated by commas, or by semicolons or tabs in the whole file. Keys may be in upper or lower case; control-Z ends
/// the file. Lines of the same hour with different minutes are averaged. Hours that are counted from 0 to 23, and
/// clock times from 0:10 to 24:00, become hours from 1 to 24, with a warning. 29 February is accepted in every year and
/// read as that of a leap year.
///
/// If direct or diffuse irradiance is missing (blank, or at least 9999), it is computed from its illuminance, or from
/// the other of the two and global irradiance or illuminance. If that is impossible, the hour is marked as missing and
/// has no light. Columns of irradiance or illuminance that are 0 in the whole file are treated as missing.
/// Errors: cannot_read; bad_input, with the line, for malformed content and for files in which no hour has known light.
Result<Weather> load_epw(const std::string& path, const WeatherEfficacies& efficacies = {});

}  // namespace exitance
