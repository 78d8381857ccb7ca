#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "exitance/error/error_percentile.hpp"
#include "exitance/evaluate/surface_levels.hpp"
#include "exitance/io/pictures/false_colour.hpp"
#include "exitance/measure/glare/glare.hpp"
#include "exitance/measure/light_maps/light_map.hpp"
#include "exitance/measure/measuring_grid.hpp"
#include "exitance/measure/pictures/camera.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

struct ReportPicture {
    std::string caption, camera;  ///< The camera as `render --camera` takes it.
    Image image;
};

/// Somebody in the room, and how glaring it is there.
struct ObserverGlare {
    Observer observer;
    Glare glare;
};

/// What a report tells. Its solution must outlive it.
struct ReportContent {
    const Solution* solution = nullptr;
    LightUnit unit;  ///< Of all numbers of light.
    std::vector<ReportPicture> pictures;
    std::vector<GridLight> grids;
    double maintenance = 1;  ///< What values of grids are multiplied by.
    std::vector<ObserverGlare> observers;
    std::vector<SurfacePoints> surfaces;
    std::size_t surfaces_left_out = 0;  ///< Smaller faces than those above.
    ErrorPercentile error;
    std::optional<LightMaps> viewer;  ///< What the embedded viewer shows; none where it would be too large.
    Camera view;                      ///< Where that begins.
    std::string statistics;           ///< As `stats --json` prints them.
    /// Parts that were requested and not finished, because a limit or a signal has stopped the run.
    std::vector<std::string> unfinished;
};

/// Writes the page, which refers to nothing outside of itself, and beside it its numbers as JSON (report.html,
/// report.json). Each appears whole or not at all.
Result<void> write_report(const ReportContent& content, const std::string& path);

/// Writes, into a folder that is made where it is missing:
///     planes.csv           a row a measuring plane: name, kind, place, Em, U0, Ud, ...
///     plane_1.csv, ...     a row a point: place, normal, value
///     plane_1.svg, .pdf    a plan to scale with lines of equal light
///     observers.csv        a row an observer: place, line of sight, UGR, background, sources (where there are any)
Result<void> write_report_tables(const ReportContent& content, const std::string& folder);

}  // namespace exitance
