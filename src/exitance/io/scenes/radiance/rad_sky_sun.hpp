#pragma once

#include "exitance/io/scenes/radiance/rad_perez_command.hpp"

namespace exitance {

/// Sets altitude, azimuth and `is_night` of a line's date and hour, as gensky and gendaylit compute them; lines with
/// angles keep theirs. Without a year the declination is a sine over the year. With one it is that of [Michalsky88],
/// within 0.01 degrees from 1950 to 2050; refraction does not count. For gendaylit the hour is shifted into the light
/// where its interval (-i) holds a sunrise or sunset.
void place_rad_sun(RadSkyWords& in);

}  // namespace exitance
