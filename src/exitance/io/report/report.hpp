#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "exitance/io/pictures/false_colour.hpp"
#include "exitance/reconstruct/error/error_percentile.hpp"
#include "exitance/reconstruct/light_maps/light_map.hpp"
#include "exitance/reconstruct/measuring_grid.hpp"
#include "exitance/reconstruct/pictures/camera.hpp"
#include "exitance/reconstruct/surface_levels.hpp"

namespace exitance {

/// What numbers of light mean: the mean of the bands in W/m^2, or their luminous mean in lx (and lm/m^2) for scenes
/// whose emitters are given in cd/m^2.
enum class ReportUnit : std::uint8_t { watt, lux };

constexpr std::array<std::pair<ReportUnit, std::string_view>, 2> report_unit_names{
    {{ReportUnit::watt, "watt"}, {ReportUnit::lux, "lux"}}};

struct ReportPicture {
    std::string caption, camera;  ///< The camera as `render --camera` takes it.
    Image image;
};

/// What a report tells. Its solution must outlive it.
struct ReportContent {
    const Solution* solution = nullptr;
    ReportUnit unit = ReportUnit::watt;
    std::vector<ReportPicture> pictures;
    std::vector<GridLight> grids;
    std::vector<SurfacePoints> surfaces;
    std::size_t surfaces_left_out = 0;  ///< Smaller faces than those above.
    ErrorPercentile error;
    std::optional<LightMaps> viewer;  ///< What the embedded viewer shows; none where it would be too large.
    Camera view;                      ///< Where that begins.
    std::string statistics;           ///< As `stats --json` prints them.
};

/// Writes the page, which refers to nothing outside of itself, and beside it its numbers as JSON (report.html,
/// report.json). Each appears whole or not at all.
Result<void> write_report(const ReportContent& content, const std::string& path);

}  // namespace exitance
