#pragma once

#include <functional>

#include "exitance/what_if/daylight/daylight_sample.hpp"
#include "exitance/what_if/daylight/year_suns.hpp"

namespace exitance {

/// Returns the light of every hour at a sensor of the setting with all groups in their first states, lx.
using OpenLight = std::function<std::vector<float>(std::size_t sensor)>;

/// Chooses the state of every group in every hour by its rule. `places`: all sensors of the setting; `groups`: the
/// panes of the groups in the setting's scene. For groups with the rule `sunlight`: O(sensors x hours with sun).
std::vector<std::vector<std::uint8_t>> choose_states(const DaylightStates& states, const DaylightSetting& setting,
                                                     const Occluders& occluders, const PaneGroups& groups,
                                                     std::span<const Receiver> places, const OpenLight& open_light);

/// Returns the weights of the parts: those of the groups in the setting's scene, in order, then those of the scenes.
/// `twice`: light that crosses panes twice, relative to all light.
HourlyStates make_hourly_states(const DaylightStates& states, std::vector<std::vector<std::uint8_t>> chosen,
                                double twice);

}  // namespace exitance
