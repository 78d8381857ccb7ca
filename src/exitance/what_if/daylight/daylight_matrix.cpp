#include "exitance/what_if/daylight/daylight_matrix.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/what_if/daylight/sensor_places.hpp"

namespace exitance {

void DaylightMatrix::resize(std::size_t sensors, std::size_t patch_count) {
    patches = patch_count;
    direct.assign(sensors * patches, 0), reflected.assign(sensors * patches, 0);
    for (std::vector<float>& replicate : replicates) replicate.assign(sensors * patches, 0);
}

/// Computes the light of sensor i of a block through the panes of every group.
void DaylightRows::find_through(const SurfacePoint& sensor, std::size_t i, const SensorRays& rays,
                                VisiblePatches::Workspace& workspace, DaylightMatrix& out) const {
    const std::size_t m = light_.columns;
    std::vector<float> direct((transport_.pane_groups().count() + 1) * m);
    visible_.irradiance_through(transport_.pane_groups(), sensor, workspace, direct);
    for (std::size_t g = 0; g < through_.size(); ++g) {
        DaylightMatrix& part = out.through[g];
        std::copy_n(&direct[g * m], m, &part.direct[i * m]);
        for (std::size_t k = 0; k < daylight_replicates; ++k) {
            const std::span<float> row(&part.replicates[k][i * m], m);
            const std::vector<RayCounts::End>& crossing = rays[k].through[g].leaves;
            through_[g].gather(k, rays[k], row);
            through_[g].add(k, crossing, rays[k].rays, -1, row), light_.add(k, crossing, rays[k].rays, 1, row);
            for (std::size_t p = 0; p < m; ++p)
                part.reflected[i * m + p] += row[p] / static_cast<float>(daylight_replicates);
        }
    }
}

DaylightMatrix DaylightRows::rows_of(std::span<const SurfacePoint> sensors, std::size_t first,
                                     std::span<const KnownSensor* const> known) const {
    const std::size_t m = light_.columns;
    DaylightMatrix out;
    out.resize(sensors.size(), m);
    out.through.resize(through_.size());
    for (DaylightMatrix& part : out.through) part.resize(sensors.size(), m);
    parallel_ranges(sensors.size(), 4, [&](std::size_t begin, std::size_t end) {
        VisiblePatches::Workspace workspace;
        for (std::size_t i = begin; i < end; ++i) {
            SensorRays rays;
            const std::span<float> direct(&out.direct[i * m], m);
            if (known[i])
                std::copy(known[i]->direct.begin(), known[i]->direct.end(), direct.begin());
            else
                visible_.irradiance(sensors[i], workspace, direct),
                    transport_.cast_sensor(sensors[i], first + i, rays_a_sensor_, rays);
            for (std::size_t k = 0; k < daylight_replicates; ++k) {
                const std::span<float> row(&out.replicates[k][i * m], m);
                light_.gather(k, (known[i] ? known[i]->rays : rays)[k], row);
                for (std::size_t p = 0; p < m; ++p)
                    out.reflected[i * m + p] += row[p] / static_cast<float>(daylight_replicates);
            }
            if (!through_.empty()) find_through(sensors[i], i, known[i] ? known[i]->rays : rays, workspace, out);
        }
    });
    return out;
}

}  // namespace exitance
