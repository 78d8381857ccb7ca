#include "exitance/methods/shooting_setup.hpp"

namespace exitance {

/// Progressive radiosity [Cohen88]: the element with the most unshot power shoots it to all others, until little is
/// left. Form factors are evaluated at the receivers' points [Wallace89], so that none exceeds its true maximum. A shot
/// needs a column of n form factors, computed on first use.
GlobalLight solve_progressive(const MethodInput& input) {
    ShootingSetup setup(input, input.direct);
    input.progress.phase("shoot");
    const SolveReport report = setup.run();
    GlobalLight light = setup.finish(report);
    light.on_projection = true;
    return light;
}

}  // namespace exitance
