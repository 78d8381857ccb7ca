#pragma once

#include <functional>

#include "exitance/what_if/daylight/daylight_sample.hpp"
#include "exitance/what_if/daylight/year_suns.hpp"

namespace exitance {

/// Returns the light of every hour at a sensor of the setting with all groups in their first states, lx: all of it,
/// then the part that has crossed panes of each group.
using OpenLight = std::function<std::vector<std::vector<float>>(std::size_t sensor)>;

/// Chooses the state of every group in every hour by its rule.
class StateChooser {
  public:
    /// `places`: all sensors of the setting; `groups`: the panes of the groups in the setting's scene. `states` must
    /// outlive this. For groups with the rule `sunlight`: O(sensors x hours with sun).
    StateChooser(const DaylightStates& states, const DaylightSetting& setting, const Occluders& occluders,
                 const PaneGroups& groups, std::span<const SurfacePoint> places, const OpenLight& open_light);

    /// Returns the state of every group and hour. `factors`: of the light through the panes of each group, at most 1.
    std::vector<std::vector<std::uint8_t>> choose(std::span<const double> factors) const;

  private:
    std::vector<std::uint8_t> by_illuminance(std::size_t group, std::span<const double> factors) const;
    std::vector<std::uint8_t> by_sunlight(std::size_t group, double factor) const;

    const DaylightStates& states_;
    std::size_t hours_;
    /// Per group and hour: the direct sunlight through the group that more than 2% of the sensors of some grid have,
    /// lx; 0 below 1000 lx.
    std::vector<std::vector<float>> sunlight_;
    /// Per group with the rule `illuminance`: the mean of OpenLight at its sensors.
    std::vector<std::vector<std::vector<double>>> light_;
};

/// Returns the states of every hour and the weight of each part of the light: first the groups in the setting's scene,
/// in order, then the scenes with shades. `twice`: light that crosses panes twice, as a share of all light.
HourlyStates make_hourly_states(const DaylightStates& states, const StateChooser& chooser,
                                const DaylightSetting& setting, double twice);

}  // namespace exitance
