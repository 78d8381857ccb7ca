#include "exitance/what_if/daylight/daylight_results.hpp"

#include <algorithm>
#include <utility>

#include "exitance/processes/exchange_archived.hpp"
#include "exitance/processes/result_of_all.hpp"
#include "exitance/scene/place_finder.hpp"
#include "exitance/what_if/daylight/sensor_places.hpp"

namespace exitance {
namespace {

/// Sensors whose results are in memory together.
constexpr std::size_t block_sensors = 256;
/// Sensors that each of many processes evaluates at once, unless fewer are left. derived from the tiles of YearSky
constexpr std::size_t min_own_sensors = 16;

Error stopped() {
    return {ErrorCode::limit, "stopped before the results of the year were complete", "", ""};
}

/// Evaluates `count` things (sensors or eyes) in blocks, which processes divide, and passes the results of the blocks,
/// in order, to `take` in all processes. evaluate(first, count) returns the results of consecutive things. Errors:
/// ErrorCode::limit after a stop request, or that of `take` in any process. Collective.
template <class Block, class Evaluate, class ArchiveOne, class Take>
Result<void> pass_blocks(std::size_t count, const Evaluate& evaluate, const ArchiveOne& archive_one, const Take& take,
                         Progress& progress, const StopRequest& stop) {
    const std::size_t all = processes(), most = std::max(min_own_sensors, block_sensors / all);
    for (std::size_t at = 0, end = 0; at < count; at = end) {
        const std::size_t of_own = std::min(most, (count - at + all - 1) / all);
        end = std::min(count, at + all * of_own);
        std::vector<Block> blocks((end - at + of_own - 1) / of_own);
        const std::size_t own = own_process(), first = at + own * of_own;
        do_own_share([&] {
            if (own < blocks.size()) blocks[own] = evaluate(first, std::min(of_own, end - first));
        });
        exchange_archived(std::span(blocks), 1, archive_one, "year");
        for (Block& block : blocks)
            if (const Result<void> taken = result_of_all(take(block)); !taken) return taken.error();
        if (stop.requested()) return stopped();
        progress.advance(static_cast<double>(end) / static_cast<double>(count));
    }
    return {};
}

/// Converts a block to bytes and back.
constexpr auto archive_block = [](auto& archive, DaylightBlock& block) {
    DaylightMatrix& matrix = block.matrix;
    archive(block.first, matrix.patches, matrix.direct, matrix.reflected);
    for (std::vector<float>& replicate : matrix.replicates) archive(replicate);
    archive(block.illuminance, block.sun, block.results);
};

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
    const auto evaluate_some = [&](std::size_t at, std::size_t count) {
        const auto together = std::span(places).subspan(at, count);
        return years.evaluate(range.first + at, together, rows.rows(together, range.first + at, known));
    };
    return pass_blocks<DaylightBlock>(places.size(), evaluate_some, archive_block, sink, d.progress, d.stop);
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
    using Years = std::vector<GlareYear>;
    const auto evaluate_some = [&](std::size_t at, std::size_t count) {
        const auto together = std::span(std::as_const(eyes)).subspan(at, count);
        const std::size_t first =
            d.task.sensors.size() + at;  // numbers differ from those of the sensors, and so do random points
        const auto unknown = [](std::size_t) -> const KnownSensor* { return nullptr; };
        return glare.evaluate(together, years.evaluate(first, together, rows.rows(together, first, unknown)));
    };
    const auto archive_years = [](auto& archive, Years& some) {
        some.resize(archive_size(archive, some.size(), 1));
        for (GlareYear& year : some) archive(year.probability, year.statistics);
    };
    Years out;
    const auto take = [&](Years& some) -> Result<void> {
        for (GlareYear& year : some) out.push_back(std::move(year));
        return {};
    };
    const Result<void> done = pass_blocks<Years>(eyes.size(), evaluate_some, archive_years, take, d.progress, d.stop);
    if (!done) return done.error();
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
    const auto evaluate_some = [&](std::size_t first, std::size_t count) {
        DaylightMatrix matrix;
        matrix.resize(count, patches.size());
        const auto rows = coefficients.subspan(first * patches.size(), count * patches.size());
        matrix.reflected.assign(rows.begin(), rows.end());
        for (std::vector<float>& replicate : matrix.replicates) replicate = matrix.reflected;
        return years.evaluate(first, std::span(places).subspan(first, count), std::move(matrix));
    };
    Progress none;
    return pass_blocks<DaylightBlock>(places.size(), evaluate_some, archive_block, sink, none, stop);
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
