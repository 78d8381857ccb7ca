#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/scene/sky/sun_position.hpp"
#include "exitance/what_if/daylight/daylight_matrix.hpp"

namespace exitance {

/// Weather of one hour: irradiance of the ground by the sky, and of a plane that faces the sun by the sun.
struct DaylightHour {
    LocalTime time;                 ///< Middle of the hour, in local standard time.
    int hour = 1;                   ///< End of the hour, 1 to 24.
    double diffuse_horizontal = 0;  ///< W/m^2
    double direct_normal = 0;       ///< W/m^2
};

/// True if sky or sun give light in an hour.
constexpr bool has_light(const DaylightHour& hour) {
    return hour.diffuse_horizontal > 0 || hour.direct_normal > 0;
}

/// Location, orientation and luminous efficacies.
struct DaylightSite {
    Place place;
    double zone = 0;                ///< Time zone, hours ahead of universal time.
    double north = 0;               ///< Direction of north, degrees clockwise from y.
    double ground = 0.2;            ///< Reflectance of the ground.
    double efficacy_diffuse = 120;  ///< lm/W
    double efficacy_direct = 100;   ///< lm/W
};

/// Sky and sun of every hour, as luminances of the patches of the sky: Perez' model, scaled to the measured diffuse
/// light. For reflected light the sun is spread over the patches around it.
class YearSky {
  public:
    YearSky(const SkyPatches& patches, std::span<const DaylightHour> hours, const DaylightSite& site);

    std::size_t hours() const { return suns_.size(); }
    /// Sums over the hours of the luminances, cd/m^2 h: of the sky alone, and with the sun spread over its patches.
    const std::vector<double>& sum_of_sky() const { return sum_of_sky_; }
    const std::vector<double>& sum_with_sun() const { return sum_with_sun_; }

    /// Adds the light of the sky alone in every hour to `lux`: a row per sensor, a column per hour. `coefficients`: a
    /// row per sensor, a column per patch. O(rows x hours x patches), 0.05 ns each.
    void add_sky(std::span<const float> coefficients, std::span<float> lux) const { add(sky_, coefficients, lux); }
    /// Adds the light of the sky and of the sun that is spread over its patches.
    void add_with_sun(std::span<const float> coefficients, std::span<float> lux) const {
        add(with_sun_, coefficients, lux);
    }

    /// Direction to the sun, and its illuminance of a plane that faces it, lx.
    struct Sun {
        Normal towards;
        double illuminance = 0;
        std::array<std::size_t, 4> patches{};  ///< The four patches around the direction to the sun.
    };
    const Sun& sun(std::size_t hour) const { return suns_[hour]; }
    /// Indices of the hours with light, ascending.
    const std::vector<std::size_t>& bright_hours() const { return bright_; }
    /// Luminances of the patches by the sky alone in the hour bright_hours()[k], cd/m^2.
    std::span<const float> sky_luminances(std::size_t k) const {
        return std::span(sky_).subspan(k * patches_, patches_);
    }

  private:
    void add(std::span<const float> luminances, std::span<const float> coefficients, std::span<float> lux) const;

    std::size_t patches_;
    std::vector<std::size_t> bright_;
    std::vector<float> sky_, with_sun_;  ///< Luminances of the patches, cd/m^2, a row per hour of `bright_`.
    std::vector<double> sum_of_sky_, sum_with_sun_;
    std::vector<Sun> suns_;
};

/// Luminances of the patches under the traditional overcast sky with a diffuse illuminance of 100 lx, and of the ground
/// below it: their light at a sensor is its daylight factor in per cent.
std::vector<double> overcast_luminances(const SkyPatches& patches, double ground);

/// True from 8 to 18 h on every day.
constexpr bool is_working_hour(int hour) {
    return hour > 8 && hour <= 18;
}

/// Occupied hours, and the illuminances that count. The defaults are those of LM-83 and of common use.
struct DaylightCriteria {
    std::vector<std::uint8_t> occupied;            ///< 1 for each occupied hour, else 0; empty: is_working_hour().
    double target = 300;                           ///< Illuminance of DA, sDA and of the dimmed electric light, lx.
    std::array<double, 3> useful{100, 300, 3000};  ///< Limits of UDI, lx, ascending.
    double dimmed_power = 0;  ///< Power of electric light that is dimmed to nothing, as a share of its full power.

    /// `hour`: the hour with index `h` of the year.
    bool is_occupied(const DaylightHour& hour, std::size_t h) const {
        return occupied.empty() ? is_working_hour(hour.hour) : occupied[h] != 0;
    }
};

/// Direct sunlight above which an hour is sunny, lx, and sunny hours above which a sensor counts in ASE.
constexpr double sunny_illuminance = 1000, max_sunny_hours = 250;
/// Least DA (daylight autonomy) of a sensor that counts in sDA (spatial daylight autonomy).
constexpr double required_autonomy = 0.5;

/// Annual metrics of standards at a sensor; shares are of the occupied hours.
struct DaylightMetrics {
    double daylight_factor = 0;  ///< Daylight factor under the traditional overcast sky, per cent.
    double autonomy = 0;         ///< DA: share of the hours with the target illuminance.
    double continuous = 0;       ///< Continuous DA: mean of the shares of the target that each hour reaches.
    /// Energy of electric light that the sensor dims, in hours at full power. Its power in every occupied hour is
    /// p + (1 - p) max(0, 1 - E / target), with p = DaylightCriteria::dimmed_power.
    double electric_hours = 0;
    std::array<double, 4> useful{};  ///< UDI: below the first limit, between the limits, above the last.
    double sunny_hours = 0;          ///< Hours with more than 1000 lx of direct sunlight.
};

/// Metrics of one sensor from its illuminances in all hours, lx. `factor`: its daylight factor, per cent.
DaylightMetrics metrics_of(double factor, std::span<const float> illuminance, std::span<const float> sun,
                           std::span<const DaylightHour> hours, const DaylightCriteria& criteria);

}  // namespace exitance
