#pragma once

#include "exitance/io/files/epw_file.hpp"

namespace exitance {

/// Reads a weather file of Daysim and Radiance's gendaymtx (.wea): the keys place, latitude, longitude (degrees west),
/// time_zone (degrees west), site_elevation and weather_data_file_units, then lines "month day hour direct diffuse"
/// with the middle of each time step. Units 1 are W/m^2, of a plane that faces the sun and of the ground by the sky;
/// units 2 the illuminances of both. Lines of one hour are averaged. Times from 24 to 24.5 are those of the next day,
/// and negative light counts as 0, both with a warning. Errors: cannot_read; bad_input, with the line, for malformed
/// content and for files without light.
Result<Weather> load_wea(const std::string& path, const WeatherEfficacies& efficacies = {});

/// Reads a weather file by the ending of its name: .wea, otherwise as load_epw().
Result<Weather> load_weather(const std::string& path, const WeatherEfficacies& efficacies = {});

}  // namespace exitance
