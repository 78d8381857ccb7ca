#pragma once

#include "exitance/what_if/daylight/daylight_year.hpp"

namespace exitance {

/// What EN 17037 makes of a year on a plane, whose sensors count alike. Levels: 0 none, 1 minimum, 2 medium, 3 high.
struct DaylightProvision {
    static constexpr std::array<double, 3> targets{300, 500, 750};   ///< lx, on half of the plane,
    static constexpr std::array<double, 3> minimums{100, 300, 500};  ///< and on 95% of it, a level each,
    static constexpr double target_share = 0.5, minimum_share = 0.95;
    static constexpr double time_share = 0.5;  ///< in half of the daylight hours.

    /// The plane by one of the two ways of the standard: the shares of sensors at each target and minimum.
    struct Shares {
        std::array<double, 3> at_target{}, at_minimum{};
        int level() const;
    };

    std::size_t hours = 0;        ///< Daylight hours: the half of all hours with most diffuse light, 4,380 of a year.
    std::vector<double> reached;  ///< lx that each sensor has in half of them.
    Shares by_illuminance;        ///< Of these.
    double median_diffuse = 0;    ///< lx of the open ground in half of the daylight hours, from the sky,
    Shares by_factor;             ///< times each sensor's daylight factor.
};

DaylightProvision daylight_provision(const DaylightYear& year, std::span<const DaylightMetrics> metrics,
                                     std::span<const DaylightHour> hours, const DaylightSite& site);

/// A day on which sunlight is counted.
struct SunDay {
    int month = 3, day = 21;
    double least_altitude = 0;  ///< Degrees: lower suns do not count.
};

/// Hours for which each sensor sees the sun's centre on a cloudless day, whatever its own normal (but on a surface from
/// its front alone), through panes too; in steps of two minutes. EN 17037 asks for 1.5 h (minimum), 3 h (medium) or 4 h
/// (high) between 1 February and 21 March.
std::vector<double> sunlight_hours(const Scene& scene, std::span<const ProbePoint> sensors, const DaylightSite& site,
                                   double zone, const SunDay& day);

}  // namespace exitance
