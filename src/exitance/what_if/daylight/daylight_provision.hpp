#pragma once

#include "exitance/what_if/daylight/daylight_year.hpp"

namespace exitance {

/// Daylight provision of a plane over a year according to EN 17037; all sensors have equal weight. Levels: 0 none, 1
/// minimum, 2 medium, 3 high.
struct DaylightProvision {
    static constexpr std::array<double, 3> targets{300, 500, 750};   ///< Per level: lx on half of the plane.
    static constexpr std::array<double, 3> minimums{100, 300, 500};  ///< Per level: lx on 95% of the plane.
    static constexpr double target_share = 0.5, minimum_share = 0.95;
    static constexpr double time_share = 0.5;  ///< Share of the daylight hours in which these are required.

    /// Result of one of the two methods of the standard: shares of sensors that reach each target and minimum.
    struct Shares {
        std::array<double, 3> at_target{}, at_minimum{};
        int level() const;
    };

    /// Number of daylight hours: the half of all hours with the most diffuse light, 4,380 per year.
    std::size_t hours = 0;
    std::vector<double> reached;  ///< Illuminance that each sensor reaches in half of the daylight hours, lx.
    Shares by_illuminance;        ///< Shares by `reached`.
    double median_diffuse = 0;    ///< Illuminance of open ground by the sky, reached in half of the daylight hours, lx.
    Shares by_factor;             ///< Shares by `median_diffuse` times each sensor's daylight factor.
};

/// Indices of the half of all hours with the most diffuse light.
std::vector<std::size_t> daylight_hours(std::span<const DaylightHour> hours);

/// Largest value that at least half of the values reach; 0 without values.
double reached_by_half(std::vector<double> values);

DaylightProvision daylight_provision(const DaylightYear& year, std::span<const DaylightMetrics> metrics,
                                     std::span<const DaylightHour> hours, const DaylightSite& site);

/// A day for which sunlight is evaluated.
struct SunDay {
    int month = 3, day = 21;
    double least_altitude = 0;  ///< Degrees; lower suns are ignored.
};

/// Returns the hours for which each sensor sees the sun's centre on a cloudless day, also through panes, in steps of
/// two minutes. The sensor's normal is ignored, but sensors on a surface only see the sun on its front. EN 17037
/// requires 1.5 h (minimum), 3 h (medium) or 4 h (high) on a day between 1 February and 21 March. `zone`: time zone,
/// hours.
std::vector<double> sunlight_hours(const Scene& scene, std::span<const ProbePoint> sensors, const DaylightSite& site,
                                   double zone, const SunDay& day);

}  // namespace exitance
