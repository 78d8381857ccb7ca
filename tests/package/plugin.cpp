#include <exitance/solve.hpp>

#include "small_room.hpp"

/// Irradiance in the middle of the floor of a small room, W/m^2.
extern "C" double light_of_a_small_room() {
    const exitance::api::Solution solution = exitance::api::solve(small_room().value(), {.error = 0.1}).value();
    const exitance::api::Probe floor[] = {{{2, 1.5, 0}, {0, 0, 1}}};
    return exitance::api::mean(solution.light(floor).value()[0].irradiance);
}
