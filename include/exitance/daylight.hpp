#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exitance/solution.hpp"

namespace exitance::api {

/// Options of a year of daylight.
struct DaylightOptions {
    double error = 0.02;  ///< Requested relative RMS error of the daylight factors and of the lux hours of the year.
    int division = 1;     ///< Parts of Tregenza's sky patches in each direction: 1, 2 or 4.
    double north = 0;     ///< Degrees from the y axis to north, clockwise seen from above.
    double ground = 0.2;  ///< Reflectance of the ground.
    /// Path of a file with groups of panes, their states such as "blinds down", and the rules that choose them, as
    /// `exitance daylight --states` reads; empty: no pane changes. Needs a scene from files.
    std::string states = {};
};

/// One hour of a weather file, in local standard time.
struct Hour {
    int month = 1, day = 1, hour = 1;  ///< The hour ends at `hour`, 1 to 24.
};

/// A group of panes whose state changes from hour to hour.
struct PaneGroup {
    std::string name;
    std::vector<std::string> states;   ///< Names of the states; the first is that of the scene.
    std::vector<std::uint8_t> chosen;  ///< Per hour: index of its state in `states`.
};

/// Results of all sensors with other glass, which a file of states lists.
struct GlassVariant {
    std::string name;
    double spatial_autonomy = 0;                      ///< sDA(300 lx, 50%): share of the sensors.
    std::array<double, 2> spatial_autonomy_bounds{};  ///< 95% interval of `spatial_autonomy`.
    double continuous_autonomy = 0;  ///< Mean over sensors and occupied hours of min(1, illuminance / 300 lx).
    double mean_illuminance = 0;     ///< Mean over sensors and occupied hours, lx.
    double sunlight_exposure = 0;    ///< ASE(1000 lx, 250 h): share of the sensors.
};

/// Illuminances of sensors in every hour of a weather file, and their annual figures.
struct Daylight {
    std::vector<Hour> hours;
    std::size_t sensors = 0;
    std::vector<float> illuminance;       ///< lx; one row per hour, one column per sensor.
    std::vector<float> sun;               ///< Direct sunlight contained in `illuminance`, lx.
    std::vector<double> daylight_factor;  ///< Per sensor: per cent, under the traditional overcast sky.
    std::vector<double> autonomy;         ///< Per sensor: share of the occupied hours (8 to 18 h) with 300 lx.
    std::vector<std::array<double, 2>> daylight_factor_bounds;  ///< 95% interval of `daylight_factor`.
    std::vector<std::array<double, 2>> autonomy_bounds;         ///< 95% interval of `autonomy`.
    /// Per sensor: shares of the occupied hours below 100 lx, from 100 to 300, from 300 to 3000, and above.
    std::vector<std::array<double, 4>> useful;
    std::vector<double> sunny_hours;     ///< Per sensor: occupied hours with more than 1000 lx of direct sunlight.
    double spatial_autonomy = 0;         ///< sDA(300 lx, 50%): share of the sensors.
    double sunlight_exposure = 0;        ///< ASE(1000 lx, 250 h): share of the sensors.
    double error_daylight_factor = 0;    ///< Relative RMS error of the daylight factors.
    double error_lux_hours = 0;          ///< Relative RMS error of the sums of all hours' illuminances.
    std::vector<PaneGroup> pane_groups;  ///< The groups of `DaylightOptions::states`.
    std::vector<GlassVariant> glass_variants;  ///< Its variants.
    /// Sentences about the weather file, about light that crosses several groups of panes, and about an error above the
    /// requested one.
    std::vector<std::string> warnings;
};

/// Computes the daylight of a year at sensors by daylight coefficients: one transport for all sky patches, and exact
/// direct light of sun and sky. The scene's own lamps are off, and its sky is replaced by the weather. Rays and
/// elements are added until the requested error is reached.
/// epw      weather file
/// sensors  points and normals
/// Errors: cannot_read, bad_input for the weather file and the file of states; usage for options out of range or no
/// sensors; limit after a stop.
Result<Daylight> daylight(const Scene& scene, const std::string& epw, std::span<const Probe> sensors,
                          const DaylightOptions& options = {}, const Control& control = {});

}  // namespace exitance::api
