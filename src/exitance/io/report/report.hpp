#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/error/error_percentile.hpp"
#include "exitance/evaluate/surface_levels.hpp"
#include "exitance/io/pictures/false_colour.hpp"
#include "exitance/io/report/report_words.hpp"
#include "exitance/measure/floor_rooms.hpp"
#include "exitance/measure/glare/glare.hpp"
#include "exitance/measure/light_maps/light_map.hpp"
#include "exitance/measure/measuring_grid.hpp"
#include "exitance/measure/pictures/camera.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

struct ReportPicture {
    std::string caption, camera;  ///< `camera` is in the syntax of `render --camera`.
    Image image;
};

/// An observer in the room, with the glare at this position.
struct ObserverGlare {
    Observer observer;
    Glare glare;
};

/// Requirements on the planes of one name, on a room, or on observers; see read_requirement() and require_tasks().
struct Requirement {
    struct Limit {
        std::string quantity;  ///< "Em", "U0", "Ez" or "UGR"; of a task also "Ra", "walls" or "ceiling".
        double value = 0;      ///< Required value: lx or W/m^2 for illuminances, otherwise a number.
    };
    /// Name of planes, or label of a room, to which ": " and a task may be added; empty: all planes and observers.
    std::string plane;
    std::vector<Limit> limits;
};

/// Texts of the first page; empty ones are left out.
struct ReportHeading {
    std::string title, project, client, author, date;
};

/// Content of a report. The solution must outlive this object.
struct ReportContent {
    ReportHeading heading;
    ReportWords words;  ///< Language and order of the page.
    std::vector<Requirement> requirements;
    const Solution* solution = nullptr;
    LightUnit unit;  ///< Unit of all light values.
    std::vector<ReportPicture> pictures;
    FloorRooms rooms;  ///< Rooms of the scene; none if no part of the report needs them.
    std::vector<GridLight> grids;
    double maintenance = 1;  ///< Maintenance factor of the values of grids.
    std::vector<ObserverGlare> observers;
    std::vector<SurfacePoints> surfaces;
    std::size_t surfaces_left_out = 0;  ///< Number of faces too small to be listed.
    ErrorPercentile error;
    std::optional<LightMaps> viewer;  ///< Light maps for the embedded viewer; none if it would be too large.
    Camera view;                      ///< Initial view of the viewer.
    std::string statistics;           ///< Output of `stats --json`.
    /// Requested parts that are missing because a limit or a signal stopped the run.
    std::vector<std::string> unfinished;
};

/// Writes the page, which needs no other files, and in the same folder its numbers as JSON (report.html, report.json).
/// Each appears whole or not at all.
Result<void> write_report(const ReportContent& content, const std::string& path);

/// Writes tables and plans to a folder, which is created if necessary:
///
///     planes.csv           one row per measuring plane: name, kind, position, Em, U0, Ud, ...
///     plane_1.csv, ...     one row per point: position, normal, value
///     plane_1.svg, .pdf    a plan to scale with isolines
///     observers.csv        one row per observer: position, line of sight, UGR, background, sources (if there are any)
///     luminaires.csv       one row per luminaire: type, file, room, position, flux, power (if there are any)
///     requirements.csv     one row per required number: where, quantity, required, reached, verdict (if there are any)
///     surfaces.csv         one row per surface: name, material, area, illuminances (if there is a page)
Result<void> write_report_tables(const ReportContent& content, const std::string& folder);

}  // namespace exitance
