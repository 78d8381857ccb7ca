#pragma once

#include <string>
#include <vector>

#include "exitance/base/result.hpp"
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
    std::vector<std::string> warnings;  ///< Sentences about what was missing or changed in the file.

    /// The hour that holds a moment of the year; none if there is none.
    const WeatherHour* at(int month, int day, double hour) const;
    /// A sentence if the hours are not those of one year, each once (29 February or not); empty if they are.
    std::string not_a_year() const;
};

/// Luminous efficacies by which irradiances and illuminances stand for each other, lm/W.
struct WeatherEfficacies {
    double direct = 100, diffuse = 120;
};

/// Reads a weather file (.epw): place and irradiances.
///
/// The header begins with LOCATION; hours begin after DATA PERIODS, or with the first line of numbers. Fields are
/// separated by commas (or by semicolons or tabs throughout). Keys may be in any case; control-Z ends the file. Several
/// lines of one hour with different minutes are averaged. Hours that are counted from 0 to 23 become 1 to 24, with a
/// warning. 29 February is one of a leap year, whatever the line's year.
///
/// Of direct and diffuse irradiance the missing one (9999 and more, or blank) follows from its illuminance, or from the
/// other one and global irradiance or illuminance. If neither is known the hour is missing, and counts as no light.
/// Irradiances or illuminances that are 0 in the whole file count as missing.
/// Errors: cannot_read; bad_input with the line, or if no hour has light that is known.
Result<Weather> load_epw(const std::string& path, const WeatherEfficacies& efficacies = {});

}  // namespace exitance
