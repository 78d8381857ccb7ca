#pragma once

#include "exitance/io/scenes/radiance/rad_perez_command.hpp"

namespace exitance {

/// Sets altitude, azimuth and `is_night` from date and hour as gensky and gendaylit compute them. Lines that give
/// angles are unchanged. Without a year, the declination is a sine over the year. With a year, the sun's position is
/// that of [Michalsky88], within 0.01 degrees from 1950 to 2050, without refraction. For gendaylit, if the interval
/// (-i) contains sunrise or sunset, the hour is moved to the middle of its daylight part.
void place_rad_sun(RadSkyWords& in);

}  // namespace exitance
