#pragma once

#include <string>

#include "exitance/io/scenes/radiance/rad_command.hpp"

namespace exitance {

/// Is it `gensky` or `gendaylit`, whose output is known in closed form?
bool is_sky_command(const CommandWords& words);

/// The text that a line `!gensky ...` or `!gendaylit ...` stands for, without running a program: the sun as a `light`
/// and a `source`, the sky as the brightness function `skyfunc`, W/(m^2 sr). Numbers have 9 digits in place of the
/// programs' three.
///
///     gensky MONTH DAY TIME | -ang ALTITUDE AZIMUTH   -s +s -i +i -c -u -t -b -B -r -R -g -a -o -m -y
///     gendaylit, the same two, and one of -P -W -L -G; -s +s -g -a -o -m -y -O -w
///
/// The sun's place is that of the programs (a sine for the declination) or, with -y, that of `sun_position` without
/// refraction; the sky's scale too is the programs' own. Source: their manual pages and printed output; [Perez93], and
/// the luminous efficacies of Perez and others of 1990. Error: words that make no sky, in the words of the user.
Result<std::string> sky_command_output(const CommandWords& words);

}  // namespace exitance
