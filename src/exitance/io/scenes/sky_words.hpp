#pragma once

#include <string>

#include "exitance/base/result.hpp"
#include "exitance/io/files/epw_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"

namespace exitance {

/// Default luminous efficacies of sun and sky, lm/W.
constexpr double efficacy_of_sun = 100, efficacy_of_sky = 120;

/// Parses a sky such as "perez,lat=47.4,lon=8.5,time=06-21T12:00,dni=700,dhi=120": first the kind, then names with
/// values, in any order. `weather`, if not null, supplies the place and irradiances that are not given. Errors:
/// ErrorCode::usage, with the word that is wrong.
Result<ChosenSky> parse_sky(const std::string& words, const Weather* weather);

/// Lists the supported kinds and names for --help.
std::string sky_help();

}  // namespace exitance
