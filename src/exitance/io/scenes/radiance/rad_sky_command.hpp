#pragma once

#include "exitance/io/scenes/radiance/rad_command.hpp"
#include "exitance/io/scenes/radiance/rad_perez_command.hpp"

namespace exitance {

/// True for `gensky` and `gendaylit`, whose output is computed here.
bool is_sky_command(const CommandWords& words);

/// Returns the output of a line `!gensky ...` or `!gendaylit ...` without running the program: the sun as a `light` and
/// a `source`, the sky as the brightness function `skyfunc`, W/(m^2 sr). Numbers have 9 digits; those of the programs
/// have three.
///
///     gensky MONTH DAY TIME | -ang ALTITUDE AZIMUTH   -s +s -i +i -c -u -t -b -B -r -R -g -a -o -m -y
///     gendaylit, the same two, and one of -P -W -L -G -E; -s +s -c -g -a -o -m -y -O -w -d -i
///
/// Follows the programs of 2021. Without -y, the declination is a sine of the day; with -y, the sun's position is from
/// [Michalsky88]. The sky's scale also follows the programs. `older` selects the behaviour before November 2019: the
/// sine had another period, and gendaylit's `-ang` implied day 150 of the year in place of day 0.
/// Error: words that do not define a sky.
/// Source: manual pages, printed output and published formulas; [Perez93], and the luminous efficacies of [Perez90].
Result<PrintedSky> sky_command_output(const CommandWords& words, bool older = false);

}  // namespace exitance
