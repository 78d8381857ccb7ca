#include "exitance/what_if/daylight/daylight_results.hpp"

#include <algorithm>

#include "exitance/what_if/daylight/sensor_places.hpp"

namespace exitance {
namespace {

/// Sensors whose results are in memory together.
constexpr std::size_t block_sensors = 256;

Error stopped() {
    return {ErrorCode::limit, "stopped before the results of the year were complete", "", ""};
}

}  // namespace

Result<DaylightSummary> simulate_year(const Scene& scene, const DaylightTask& task, const DaylightSink& sink,
                                      Progress& progress, const StopRequest& stop) {
    constexpr int finest_division = 4;
    constexpr std::uint64_t seed = 1;
    const SkyPatches patches(task.division);
    std::optional<SkyPatches> finer;
    if (task.division < finest_division) finer.emplace(2 * task.division);
    const YearSky sky(patches, task.hours, task.site);
    const DaylightSetting setting{scene,      task.sensors, task.grids, patches, finer ? &*finer : nullptr,
                                  task.hours, task.site,    sky,        seed};
    progress.phase("rays");
    DaylightTransport transport(scene, patches, setting.finer, seed);
    DaylightSample sample(setting, transport);
    const DaylightLight light = find_daylight_light(setting, transport, sample, task.error, progress, stop);
    transport.forget_rows();
    if (stop.requested()) return stopped();

    progress.phase("year");
    const std::vector<Receiver> places = sensor_places(scene, transport.stage().occluders, task.sensors);
    const DaylightRows rows(transport, light.elements, patches, light.options.rays_a_sensor);
    const SensorYears years(setting, light.bias, task.sun_day);
    DaylightTotals totals(task.grids, task.hours, task.site);
    for (std::size_t first = 0; first < places.size(); first += block_sensors) {
        const auto together = std::span(places).subspan(first, std::min(block_sensors, places.size() - first));
        const DaylightBlock block =
            years.evaluate(first, together, rows.rows(together, first, [&](std::size_t i) { return sample.find(i); }));
        for (const SensorResults& sensor : block.results) totals.add(sensor);
        if (const Result<void> taken = sink(block); !taken) return taken.error();
        if (stop.requested()) return stopped();
        progress.advance(static_cast<double>(first + together.size()) / static_cast<double>(places.size()));
    }
    return totals.summary(light.bias);
}

Result<DaylightResults> collect_year(const Scene& scene, const DaylightTask& task, Progress& progress,
                                     const StopRequest& stop) {
    const std::size_t n = task.sensors.size(), hours = task.hours.size();
    DaylightResults out;
    out.year.sensors = n;
    out.year.illuminance.resize(n * hours), out.year.sun.resize(n * hours);
    const auto append = [](std::vector<float>& all, const std::vector<float>& more) {
        all.insert(all.end(), more.begin(), more.end());
    };
    const auto keep = [&](const DaylightBlock& block) -> Result<void> {
        out.matrix.patches = block.matrix.patches;
        append(out.matrix.direct, block.matrix.direct), append(out.matrix.reflected, block.matrix.reflected);
        for (std::size_t k = 0; k < daylight_replicates; ++k)
            append(out.matrix.replicates[k], block.matrix.replicates[k]);
        for (std::size_t i = 0; i < block.results.size(); ++i)
            for (std::size_t h = 0; h < hours; ++h) {
                out.year.illuminance[h * n + block.first + i] = block.illuminance[i * hours + h];
                out.year.sun[h * n + block.first + i] = block.sun[i * hours + h];
            }
        out.sensors.insert(out.sensors.end(), block.results.begin(), block.results.end());
        return {};
    };
    Result<DaylightSummary> summary = simulate_year(scene, task, keep, progress, stop);
    if (!summary) return summary.error();
    out.summary = std::move(*summary);
    return out;
}

}  // namespace exitance
