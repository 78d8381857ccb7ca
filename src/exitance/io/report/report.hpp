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
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

struct ReportPicture {
    std::string caption, camera;  ///< The camera as `render --camera` takes it.
    Image image;
};

/// What a report tells. Its solution must outlive it.
struct ReportContent {
    const Solution* solution = nullptr;
    LightUnit unit;  ///< Of all numbers of light.
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
