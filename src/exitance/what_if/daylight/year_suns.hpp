#pragma once

#include <span>
#include <vector>

#include "exitance/scene/point_light.hpp"
#include "exitance/visibility/glass/pane_groups.hpp"
#include "exitance/what_if/daylight/daylight_year.hpp"

namespace exitance {

/// The sun of every hour of a year as parallel light, for exact direct sunlight at sensors.
class YearSuns {
  public:
    /// `sky` must outlive this object.
    explicit YearSuns(const YearSky& sky);

    /// Writes the direct sunlight of every hour at a sensor, lx. `direct`: irradiance by every patch at the sensor: one
    /// that sees none of the sun's patches does not see the sun. Hours without sun are not changed.
    void find(const Occluders& occluders, const SurfacePoint& at, std::span<const float> direct,
              std::span<float> sun) const;

    /// Direct sunlight of an hour, and the groups whose panes it has crossed.
    struct Through {
        PaneGroups::Mask groups = 0;
        float illuminance = 0;  ///< lx
    };
    /// Writes the direct sunlight of every hour that crosses panes of groups; `least`: lesser light is left out, lx.
    void find_through(const Occluders& occluders, const PaneGroups& groups, const SurfacePoint& at, double least,
                      std::span<Through> out) const;

    /// Sets the hours to 0 in which the sun does not shine through panes of a group.
    void keep_through(const PaneGroups& groups, std::size_t group, const SurfacePoint& at, std::span<float> sun) const;

  private:
    const YearSky& sky_;
    std::vector<std::vector<PunctualLight>> suns_;  ///< The sun of every hour; empty without one.
};

}  // namespace exitance
