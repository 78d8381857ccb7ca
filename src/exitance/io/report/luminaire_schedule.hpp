#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exitance/io/report/report.hpp"

namespace exitance {

/// Luminaires of a scene as a schedule lists them: by type, by room, and one by one. Power is that of the photometric
/// files; it is not reduced by dimming, because the files do not state how.
struct LuminaireSchedule {
    /// Smallest and largest value of some luminaires.
    struct Range {
        double least = HUGE_VAL, most = -HUGE_VAL;
        void add(double value) { least = std::min(least, value), most = std::max(most, value); }
    };
    /// All luminaires of one photometric file and one flux.
    struct Type {
        std::string label;  ///< "A", "B", ..., "Z", "AA", ...
        const LuminaireType* facts = nullptr;
        std::size_t count = 0;
        double flux = 0;    ///< Flux of one new luminaire at full output, lm.
        Range output;       ///< Flux in this solution over that of the maintained luminaire at full output.
        Range maintenance;  ///< Maintenance factors that the light contains.
    };
    struct Item {
        std::string label;  ///< Type and number, "A3".
        std::size_t type = 0;
        const InstalledLuminaire* facts = nullptr;
        std::optional<std::size_t> room;
    };
    struct Room {
        std::size_t room = 0;
        std::map<std::size_t, std::size_t> counts;  ///< Number of luminaires of every type.
        std::optional<double> watts;                ///< Power of the luminaires, W; none if that of one is unknown.
        double watts_per_area = 0;                  ///< W/m^2 of floor
        std::optional<double> light;                ///< Mean illuminance on the room's largest plane, lx.
        double per_100_lux() const { return 100 * watts_per_area / *light; }  ///< W/(m^2 100 lx)
    };
    /// Emitting faces of one material that belong to no photometric file. Their power is unknown.
    struct Other {
        std::string material;
        std::size_t faces = 0;
        double area = 0;  ///< m^2
        double flux = 0;  ///< lm
    };
    std::vector<Type> types;
    std::vector<Item> items;
    std::vector<Room> rooms;
    std::vector<Other> others;

    bool is_empty() const { return items.empty() && others.empty(); }
};

struct ReportFigures;

/// Finds the schedule of a report. `figures`: its grids must be complete.
LuminaireSchedule find_schedule(const ReportContent& content, const ReportFigures& figures);

/// Formats the schedule as a part of the page (HTML; empty if nothing emits), as a JSON object, and as luminaires.csv
/// with a row per luminaire.
std::string schedule_html(const ReportContent& content, const LuminaireSchedule& schedule);
std::string schedule_json(const LuminaireSchedule& schedule);
std::string luminaires_csv(const ReportContent& content, const LuminaireSchedule& schedule);

/// Draws a plan of a room with the outlines and labels of its luminaires, its walls and its furniture (SVG).
std::string luminaire_plan(const ReportContent& content, const LuminaireSchedule& schedule, std::size_t room);

}  // namespace exitance
