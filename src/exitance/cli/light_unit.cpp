#include "exitance/cli/light_unit.hpp"

namespace exitance {

LightUnit unit_of(const UnitArguments& arguments, const Scene& scene, Terminal& terminal) {
    const LightUnit unit(arguments.choice, scene.is_photometric(), arguments.efficacy.value_or(daylight_efficacy));
    if (arguments.efficacy && !unit.is_converted())
        terminal.note(scene.is_photometric() ? "--efficacy has no effect: light in lumens is not converted"
                                             : "--efficacy has no effect: light in watts is not converted");
    return unit;
}

}  // namespace exitance
