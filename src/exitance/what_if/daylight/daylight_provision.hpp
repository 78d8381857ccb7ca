#pragma once

#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/visible_part.hpp"
#include "exitance/what_if/daylight/daylight_year.hpp"

namespace exitance {

/// A day for which sunlight is evaluated.
struct SunDay {
    int month = 3, day = 21;
    double min_altitude = 0;  ///< Minimum altitude, degrees; a lower sun is ignored.
};

/// Daylight provision of a plane over a year according to EN 17037; all sensors have equal weight. Levels: 0 none, 1
/// minimum, 2 medium, 3 high.
struct DaylightProvision {
    static constexpr std::array<double, 3> targets{300, 500, 750};   ///< Per level: lx on half of the plane.
    static constexpr std::array<double, 3> minimums{100, 300, 500};  ///< Per level: lx on 95% of the plane.
    static constexpr double target_share = 0.5, minimum_share = 0.95;
    static constexpr double time_share = 0.5;  ///< Share of the daylight hours in which the levels must be reached.

    /// Result of one of the two methods of the standard: shares of sensors that reach each target and minimum.
    struct Shares {
        std::array<double, 3> at_target{}, at_minimum{};
        int level() const;
    };

    /// Number of daylight hours: the half of all hours with the most diffuse light, 4,380 per year.
    std::size_t hours = 0;
    Shares by_illuminance;      ///< Shares by the illuminance reached in half of the daylight hours.
    double median_diffuse = 0;  ///< Illuminance of open ground by the sky, reached in half of the daylight hours, lx.
    Shares by_factor;           ///< Shares by `median_diffuse` times each sensor's daylight factor.
};

/// Indices of the half of all hours with the most diffuse light.
std::vector<std::size_t> daylight_hours(std::span<const DaylightHour> hours);

/// Largest value that at least half of the values reach; 0 without values.
double reached_by_half(std::vector<double> values);

/// Counts the sensors that reach the targets and minimums.
class ProvisionCount {
  public:
    ProvisionCount(std::span<const DaylightHour> hours, const DaylightSite& site);

    /// Adds a sensor: `reached` is its illuminance reached in half of the daylight hours, lx, and `factor` its daylight
    /// factor, per cent.
    void add(double reached, double factor);
    DaylightProvision provision() const;

  private:
    static void count(double lux, DaylightProvision::Shares& counts);

    std::size_t hours_ = 0, sensors_ = 0;
    double median_diffuse_ = 0;
    DaylightProvision::Shares by_illuminance_, by_factor_;  ///< Sensors that reach each level so far.
};

/// Counts the hours for which sensors see the sun's centre on a cloudless day, also through panes, in steps of two
/// minutes. The sensor's normal is ignored, but sensors on a surface only see the sun on its front. EN 17037 requires
/// 1.5 h (minimum), 3 h (medium) or 4 h (high) on a day between 1 February and 21 March.
class SunlightHours {
  public:
    /// `occluders` must outlive this object.
    SunlightHours(const Occluders& occluders, const DaylightSite& site, const SunDay& day);
    /// Hours at a sensor. About 1 us per step.
    double at(const SurfacePoint& sensor) const;

  private:
    const Occluders& occluders_;
    std::vector<Normal> suns_;
};

}  // namespace exitance
