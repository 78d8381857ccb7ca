#include "exitance/io/scenes/honeybee/honeybee_modifiers.hpp"

namespace exitance {
namespace {

RadPrimitive plastic(std::string name, double reflectance) {
    return {"void", "plastic", std::move(name), {}, {reflectance, reflectance, reflectance, 0, 0}};
}

RadPrimitive glass(std::string name, double transmissivity) {
    return {"void", "glass", std::move(name), {}, {transmissivity, transmissivity, transmissivity}};
}

constexpr const char *wall = "generic_wall_0.50", *ground = "generic_floor_0.20", *ceiling = "generic_ceiling_0.80",
                     *door = "generic_opaque_door_0.50", *outer_window = "generic_exterior_window_vis_0.64",
                     *inner_window = "generic_interior_window_vis_0.88", *inner_shade = "generic_interior_shade_0.50",
                     *outer_shade = "generic_exterior_shade_0.35", *context = "generic_context_0.20";

}  // namespace

const HoneybeeModifierSet& generic_modifier_set() {
    static const HoneybeeModifierSet set{{"wall_set.exterior_modifier", wall},
                                         {"wall_set.interior_modifier", wall},
                                         {"floor_set.exterior_modifier", ground},
                                         {"floor_set.interior_modifier", ground},
                                         {"roof_ceiling_set.exterior_modifier", ceiling},
                                         {"roof_ceiling_set.interior_modifier", ceiling},
                                         {"aperture_set.window_modifier", outer_window},
                                         {"aperture_set.skylight_modifier", outer_window},
                                         {"aperture_set.operable_modifier", outer_window},
                                         {"aperture_set.interior_modifier", inner_window},
                                         {"door_set.exterior_modifier", door},
                                         {"door_set.interior_modifier", door},
                                         {"door_set.overhead_modifier", door},
                                         {"door_set.exterior_glass_modifier", outer_window},
                                         {"door_set.interior_glass_modifier", inner_window},
                                         {"shade_set.exterior_modifier", outer_shade},
                                         {"shade_set.interior_modifier", inner_shade},
                                         {"context_modifier", context}};
    return set;
}

std::vector<RadPrimitive> generic_modifiers() {
    // The two transmissivities are honeybee-standards' own digits for transmittances of 0.64 and 0.88.
    return {plastic(wall, 0.5),
            plastic(ground, 0.2),
            plastic(ceiling, 0.8),
            plastic(door, 0.5),
            plastic(inner_shade, 0.5),
            plastic(outer_shade, 0.35),
            plastic(context, 0.2),
            glass(outer_window, 0.6975761815384331),
            glass(inner_window, 0.9584154328610596)};
}

}  // namespace exitance
