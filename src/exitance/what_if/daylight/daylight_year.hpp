#pragma once

#include <array>

#include "exitance/scene/sky/sun_position.hpp"
#include "exitance/what_if/daylight/daylight_matrix.hpp"

namespace exitance {

/// The light of one hour, in lumens: what the sky sends to the ground, and the sun to a plane that faces it.
struct DaylightHour {
    LocalTime time;                 ///< Its middle, in local standard time.
    int hour = 1;                   ///< 1 to 24: when it ends.
    double diffuse_horizontal = 0;  ///< W/m^2
    double direct_normal = 0;       ///< W/m^2
};

/// Where the hours are, and what light counts.
struct DaylightSite {
    Place place;
    double north = 0;               ///< Degrees clockwise from y.
    double ground = 0.2;            ///< Its reflectance.
    double efficacy_diffuse = 120;  ///< lm/W
    double efficacy_direct = 100;   ///< lm/W
};

/// Illuminances of a year.
struct DaylightYear {
    std::size_t sensors = 0;
    std::vector<float> illuminance;  ///< lx: a row an hour, a column a sensor.
    std::vector<float> sun;          ///< Of that, what comes straight from the sun.
};

/// What standards make of a year at a sensor; shares are of the occupied hours.
struct DaylightMetrics {
    double daylight_factor = 0;      ///< Percent, under the traditional overcast sky.
    double autonomy = 0;             ///< DA(300 lx)
    std::array<double, 4> useful{};  ///< UDI: below 100 lx, 100 to 300, 300 to 3000, above.
    double sunny_hours = 0;          ///< Hours with more than 1000 lx straight from the sun.
};

/// What they make of all sensors, which count alike.
struct DaylightSummary {
    double mean_daylight_factor = 0;  ///< Percent.
    double spatial_autonomy = 0;      ///< sDA(300 lx, 50%): share of sensors.
    double sunlight_exposure = 0;     ///< ASE(1000 lx, 250 h): share of sensors.
    std::size_t occupied_hours = 0;
};

/// From 8 to 18 on every day.
constexpr bool is_occupied(int hour) {
    return hour > 8 && hour <= 18;
}

/// Illuminance of every hour at every sensor: Perez' sky over the matrix' patches; the sun's own light by its exact
/// visibility, and reflected as that of the patches about it. Hours without light are 0. About 1 us a sensor and hour
/// of sun. `scene`: that the matrix is of.
DaylightYear daylight_year(const Scene& scene, std::span<const ProbePoint> sensors, const SkyPatches& patches,
                           const DaylightMatrix& matrix, std::span<const DaylightHour> hours, const DaylightSite& site);

std::vector<DaylightMetrics> daylight_metrics(const DaylightYear& year, const SkyPatches& patches,
                                              const DaylightMatrix& matrix, std::span<const DaylightHour> hours,
                                              const DaylightSite& site);
DaylightSummary summarize(std::span<const DaylightMetrics> metrics, std::span<const DaylightHour> hours);

}  // namespace exitance
