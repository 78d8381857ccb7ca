#include "exitance/what_if/daylight/daylight_results.hpp"

#include <algorithm>

#include "exitance/scene/place_finder.hpp"
#include "exitance/what_if/daylight/sensor_places.hpp"

namespace exitance {
namespace {

/// Sensors whose results are in memory together.
constexpr std::size_t block_sensors = 256;

Error stopped() {
    return {ErrorCode::limit, "stopped before the results of the year were complete", "", ""};
}

}  // namespace

struct DaylightSimulation::Data {
    Data(const Scene& of_scene, const DaylightTask& of_task, Progress& of_progress, const StopRequest& of_stop)
        : task(of_task),
          progress(of_progress),
          stop(of_stop),
          patches(task.division),
          finer(task.division < finest_division ? std::make_unique<SkyPatches>(2 * task.division) : nullptr),
          sky(patches, task.hours, task.site),
          setting{of_scene,   task.sensors, task.grids, patches,       finer.get(),
                  task.hours, task.site,    sky,        task.criteria, seed},
          transport(of_scene, patches, finer.get(), seed) {}

    static constexpr int finest_division = 4;
    static constexpr std::uint64_t seed = 1;

    const DaylightTask& task;
    Progress& progress;
    const StopRequest& stop;
    SkyPatches patches;
    std::unique_ptr<SkyPatches> finer;
    YearSky sky;
    DaylightSetting setting;
    DaylightTransport transport;
    std::unique_ptr<DaylightSample> sample;  ///< Null if the light was taken.
    DaylightLight light;
};

DaylightSimulation::DaylightSimulation(const Scene& scene, const DaylightTask& task, Progress& progress,
                                       const StopRequest& stop) {
    progress.phase("rays");
    data_ = std::make_unique<Data>(scene, task, progress, stop);
}

DaylightSimulation::~DaylightSimulation() = default;

Result<void> DaylightSimulation::find_light() {
    Data& d = *data_;
    d.sample = std::make_unique<DaylightSample>(d.setting, d.transport);
    d.light = find_daylight_light(d.setting, d.transport, *d.sample, d.task.error, d.progress, d.stop);
    d.transport.forget_rows();
    if (d.stop.requested()) return stopped();
    return {};
}

bool DaylightSimulation::take(DaylightLight light) {
    Data& d = *data_;
    d.transport.make_elements(light.options.elements);
    if (light.elements.columns != d.patches.size() || light.options.seed != Data::seed) return false;
    for (const std::vector<float>& replicate : light.elements.reflected)
        if (replicate.size() != d.transport.leaves() * light.elements.columns) return false;
    d.light = std::move(light);
    return true;
}

const DaylightLight& DaylightSimulation::light() const {
    return data_->light;
}

Result<void> DaylightSimulation::evaluate(SensorRange range, const DaylightSink& sink) const {
    const Data& d = *data_;
    d.progress.phase("year");
    const auto sensors = std::span(d.task.sensors).subspan(range.first, range.count);
    const std::vector<Receiver> places = sensor_places(d.setting.scene, d.transport.stage().occluders, sensors);
    const DaylightRows rows(d.transport, d.light.elements, d.patches, d.light.options.rays_a_sensor);
    const SensorYears years(d.setting, d.light.bias, d.task.sun_day);
    const auto known = [&](std::size_t i) { return d.sample ? d.sample->find(i) : nullptr; };
    for (std::size_t at = 0; at < places.size(); at += block_sensors) {
        const auto together = std::span(places).subspan(at, std::min(block_sensors, places.size() - at));
        const std::size_t first = range.first + at;
        const DaylightBlock block = years.evaluate(first, together, rows.rows(together, first, known));
        if (const Result<void> taken = sink(block); !taken) return taken.error();
        if (d.stop.requested()) return stopped();
        d.progress.advance(static_cast<double>(at + together.size()) / static_cast<double>(places.size()));
    }
    return {};
}

Result<std::vector<GlareYear>> DaylightSimulation::glare(std::span<const ProbePoint> views, double threshold) const {
    const Data& d = *data_;
    d.progress.phase("glare");
    std::vector<Receiver> eyes = sensor_places(d.setting.scene, d.transport.stage().occluders, views);
    const PlaceFinder places(d.setting.scene);
    for (Receiver& eye : eyes)  // rays from an eye on a wall would end there
        if (!eye.own.is_none()) eye.x += places.step() * d.setting.scene.regions()[eye.own].plane.n, eye.own = {};
    const DaylightRows rows(d.transport, d.light.elements, d.patches, d.light.options.rays_a_sensor);
    const SensorYears years(d.setting, d.light.bias, {});
    const GlareYears glare(d.setting, d.transport, d.light.elements, threshold);
    std::vector<GlareYear> out;
    for (std::size_t at = 0; at < eyes.size(); at += block_sensors) {
        const auto together = std::span(eyes).subspan(at, std::min(block_sensors, eyes.size() - at));
        const std::size_t first =
            d.task.sensors.size() + at;  // numbers differ from those of the sensors, and so do random points
        const auto unknown = [](std::size_t) -> const KnownSensor* { return nullptr; };
        const DaylightBlock block = years.evaluate(first, together, rows.rows(together, first, unknown));
        for (GlareYear& year : glare.evaluate(together, block)) out.push_back(std::move(year));
        if (d.stop.requested()) return stopped();
        d.progress.advance(static_cast<double>(out.size()) / static_cast<double>(eyes.size()));
    }
    return out;
}

Result<void> evaluate_coefficients(const Scene& scene, const DaylightTask& task, std::span<const float> coefficients,
                                   const DaylightSink& sink, const StopRequest& stop) {
    const SkyPatches patches(task.division);
    const YearSky sky(patches, task.hours, task.site);
    const DaylightSetting setting{scene,      task.sensors, task.grids, patches,       nullptr,
                                  task.hours, task.site,    sky,        task.criteria, 1};
    const SensorYears years(setting, {}, task.sun_day);
    const std::vector<Receiver> places = sensor_places(scene, Occluders(scene), task.sensors);
    for (std::size_t first = 0; first < places.size(); first += block_sensors) {
        const std::size_t count = std::min(block_sensors, places.size() - first);
        DaylightMatrix matrix;
        matrix.resize(count, patches.size());
        const auto rows = coefficients.subspan(first * patches.size(), count * patches.size());
        matrix.reflected.assign(rows.begin(), rows.end());
        for (std::vector<float>& replicate : matrix.replicates) replicate = matrix.reflected;
        const DaylightBlock block = years.evaluate(first, std::span(places).subspan(first, count), std::move(matrix));
        if (const Result<void> taken = sink(block); !taken) return taken.error();
        if (stop.requested()) return stopped();
    }
    return {};
}

Result<DaylightSummary> simulate_year(const Scene& scene, const DaylightTask& task, const DaylightSink& sink,
                                      Progress& progress, const StopRequest& stop) {
    DaylightSimulation simulation(scene, task, progress, stop);
    if (const Result<void> found = simulation.find_light(); !found) return found.error();
    DaylightTotals totals(task.grids, task.hours, task.site, task.criteria);
    const auto add = [&](const DaylightBlock& block) {
        for (const SensorResults& sensor : block.results) totals.add(sensor);
        return sink(block);
    };
    if (const Result<void> done = simulation.evaluate({0, task.sensors.size()}, add); !done) return done.error();
    return totals.summary(simulation.light().bias);
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
