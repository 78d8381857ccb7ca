#pragma once

#include <array>

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

/// Location, orientation and luminous efficacies.
struct DaylightSite {
    Place place;
    double north = 0;               ///< Degrees clockwise from y.
    double ground = 0.2;            ///< Reflectance of the ground.
    double efficacy_diffuse = 120;  ///< lm/W
    double efficacy_direct = 100;   ///< lm/W
};

/// Illuminances of a year.
struct DaylightYear {
    std::size_t sensors = 0;
    std::vector<float> illuminance;  ///< lx; one row per hour, one column per sensor.
    std::vector<float> sun;          ///< Direct sunlight contained in `illuminance`, lx.
};

/// Annual metrics of standards at a sensor; shares are of the occupied hours.
struct DaylightMetrics {
    double daylight_factor = 0;      ///< Per cent, under the traditional overcast sky.
    double autonomy = 0;             ///< DA(300 lx)
    std::array<double, 4> useful{};  ///< UDI: below 100 lx, 100 to 300, 300 to 3000, above.
    double sunny_hours = 0;          ///< Hours with more than 1000 lx of direct sunlight.
};

/// Metrics of all sensors, with equal weights.
struct DaylightSummary {
    double mean_daylight_factor = 0;  ///< Per cent.
    double spatial_autonomy = 0;      ///< sDA(300 lx, 50%): share of sensors.
    double sunlight_exposure = 0;     ///< ASE(1000 lx, 250 h): share of sensors.
    std::size_t occupied_hours = 0;
};

/// True from 8 to 18 h on every day.
constexpr bool is_occupied(int hour) {
    return hour > 8 && hour <= 18;
}

/// Computes the illuminance of every hour at every sensor. The sky is Perez' model over the matrix's patches. Direct
/// sunlight uses exact visibility; its reflections are those of the patches around the sun. Hours without light are 0.
/// `scene`: the scene that the matrix was computed for. About 1 us per sensor and hour of sun.
DaylightYear daylight_year(const Scene& scene, std::span<const ProbePoint> sensors, const SkyPatches& patches,
                           const DaylightMatrix& matrix, std::span<const DaylightHour> hours, const DaylightSite& site);

std::vector<DaylightMetrics> daylight_metrics(const DaylightYear& year, const SkyPatches& patches,
                                              const DaylightMatrix& matrix, std::span<const DaylightHour> hours,
                                              const DaylightSite& site);
DaylightSummary summarize(std::span<const DaylightMetrics> metrics, std::span<const DaylightHour> hours);

}  // namespace exitance
