#pragma once

#include <string>

#include "exitance/base/result.hpp"
#include "exitance/io/files/epw_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"

namespace exitance {

/// What light of the sun and of the sky counts in lumens where nothing else is said, lm/W.
constexpr double efficacy_of_sun = 100, efficacy_of_sky = 120;

/// What a sky is as words say it: "perez,lat=47.4,lon=8.5,time=06-21T12:00,dni=700,dhi=120". First the kind, then
/// names with values, in any order. `weather`, if given, tells place and irradiances that the words leave open. Errors
/// are of code usage and name what is wrong.
Result<ChosenSky> parse_sky(const std::string& words, const Weather* weather);

/// The names that it knows, for --help.
std::string sky_help();

}  // namespace exitance
