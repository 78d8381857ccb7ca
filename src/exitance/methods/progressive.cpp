#include "exitance/methods/shooting_setup.hpp"

namespace exitance {

/// Progressive radiosity [Cohen88]: the element with the most unshot power shoots it to all others, until little is
/// left. Form factors are taken at the receivers' points [Wallace89], so that none is larger than it can be. A column
/// of n form factors a shot, computed when it is first wanted.
GlobalLight solve_progressive(const MethodInput& input) {
    ShootingSetup setup(input, input.direct);
    input.progress.phase("shoot");
    const SolveReport report = setup.run();
    GlobalLight light = setup.finish(report);
    light.on_projection = true;
    return light;
}

}  // namespace exitance
