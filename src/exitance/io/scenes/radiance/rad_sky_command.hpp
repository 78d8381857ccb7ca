#pragma once

#include <string>

#include "exitance/io/scenes/radiance/rad_command.hpp"
#include "exitance/io/scenes/radiance/rad_perez_command.hpp"

namespace exitance {

/// True for `gensky` and `gendaylit`, whose output is known in closed form.
bool is_sky_command(const CommandWords& words);

/// The text that a line `!gensky ...` or `!gendaylit ...` stands for, without running a program: the sun as a `light`
/// and a `source`, the sky as the brightness function `skyfunc`, W/(m^2 sr). Numbers have 9 digits in place of the
/// programs' three.
///
///     gensky MONTH DAY TIME | -ang ALTITUDE AZIMUTH   -s +s -i +i -c -u -t -b -B -r -R -g -a -o -m -y
///     gendaylit, the same two, and one of -P -W -L -G -E; -s +s -c -g -a -o -m -y -O -w -d -i
///
/// The programs are those of 2021: the sun's place without -y by a sine for the declination, with -y by [Michalsky88];
/// the sky's scale too is the programs' own. `older`: as before November 2019, when the sine had another period and
/// gendaylit's `-ang` meant day 150 of the year in place of day 0. Source: their manual pages, printed output and
/// published formulas; [Perez93], and the luminous efficacies of [Perez90]. Error: words that make no sky, in the words
/// of the user.
Result<PrintedSky> sky_command_output(const CommandWords& words, bool older = false);

}  // namespace exitance
