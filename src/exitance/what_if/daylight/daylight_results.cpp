#include "exitance/what_if/daylight/daylight_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exitance/base/distinct_numbers.hpp"
#include "exitance/processes/exchange_archived.hpp"
#include "exitance/processes/result_of_all.hpp"
#include "exitance/scene/place_finder.hpp"
#include "exitance/what_if/daylight/misplaced_sensors.hpp"
#include "exitance/what_if/daylight/sensor_places.hpp"

namespace exitance {
namespace {

/// Number of sensors whose results are in memory together.
constexpr std::size_t block_sensors = 256;
/// Number of sensors that a process evaluates at once, at least. Derived from the tiles of YearSky, of 16 sensors.
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

/// The light in one scene: the task's own, or one of its states.
struct DaylightSimulation::SceneLight {
    SceneLight(const DaylightSetting& of_setting, const Scene& scene, PaneGroups groups)
        : setting{scene,
                  of_setting.sensors,
                  of_setting.grids,
                  of_setting.patches,
                  of_setting.finer,
                  of_setting.hours,
                  of_setting.site,
                  of_setting.sky,
                  of_setting.criteria,
                  of_setting.seed},
          transport(scene, setting.patches, setting.finer, setting.seed, std::move(groups)) {}

    DaylightSetting setting;
    DaylightTransport transport;
    std::unique_ptr<DaylightSample> sample;  ///< Finds the light; null if take() has provided it.
    DaylightLight light;

    DaylightRows rows() const {
        return {transport, light.elements, setting.patches, light.options.rays_a_sensor, light.through};
    }
    const KnownSensor* find(std::size_t sensor) const { return sample ? sample->find(sensor) : nullptr; }
    std::vector<SurfacePoint> places(std::span<const ProbePoint> sensors) const {
        return sensor_places(setting.scene, transport.stage().occluders, sensors);
    }
};

struct DaylightSimulation::Data {
    Data(const Scene& scene, const DaylightTask& of_task, Progress& of_progress, const StopRequest& of_stop)
        : task(of_task),
          progress(of_progress),
          stop(of_stop),
          patches(task.division),
          finer(task.division < finest_division ? std::make_unique<SkyPatches>(2 * task.division) : nullptr),
          sky(patches, task.hours, task.site),
          open({scene, task.sensors, task.grids, patches, finer.get(), task.hours, task.site, sky, task.criteria, seed},
               scene, groups_of(scene, task.states)) {}

    static PaneGroups groups_of(const Scene& scene, const DaylightStates* states) {
        if (!states) return PaneGroups();
        return states->groups.front().has_all_light ? PaneGroups::all_light()
                                                    : PaneGroups(scene, states->group_of_pane, states->groups.size());
    }

    static constexpr int finest_division = 4;
    static constexpr std::uint64_t seed = 1;

    const DaylightTask& task;
    Progress& progress;
    const StopRequest& stop;
    SkyPatches patches;
    std::unique_ptr<SkyPatches> finer;
    YearSky sky;
    SceneLight open;                                   ///< Light with all groups of panes in their first states.
    std::vector<std::unique_ptr<SceneLight>> changed;  ///< Light in the scenes of other states.
    HourlyStates states;
    double error_of_states = 0;  ///< Largest error of a grid in the scenes of states.
};

DaylightSimulation::DaylightSimulation(const Scene& scene, const DaylightTask& task, Progress& progress,
                                       const StopRequest& stop) {
    progress.phase("rays");
    data_ = std::make_unique<Data>(scene, task, progress, stop);
    if (!task.states) return;
    for (const StateScene& state : task.states->scenes) {
        PaneGroups panes = task.states->groups[state.group].has_all_light
                               ? PaneGroups::all_light()
                               : PaneGroups(state.scene, state.group_of_pane, 1);
        data_->changed.push_back(std::make_unique<SceneLight>(data_->open.setting, state.scene, std::move(panes)));
    }
}

DaylightSimulation::~DaylightSimulation() = default;

void DaylightSimulation::find_light(SceneLight& scene) {
    Data& d = *data_;
    scene.sample = std::make_unique<DaylightSample>(scene.setting, scene.transport);
    scene.light = find_daylight_light(scene.setting, scene.transport, *scene.sample, d.task.error, d.progress, d.stop);
    scene.transport.forget_rows();
}

Result<void> DaylightSimulation::find_light() {
    Data& d = *data_;
    find_light(d.open);
    for (const std::unique_ptr<SceneLight>& scene : d.changed) {
        find_light(*scene);
        DaylightBias& bias = d.open.light.bias;
        if (scene->light.bias.total() > bias.total()) bias = scene->light.bias;
        d.error_of_states = std::max(d.error_of_states, worst_of(scene->sample->errors(scene->light.bias)).largest());
    }
    if (d.stop.requested()) return stopped();
    if (d.task.states) choose_states();
    return {};
}

void DaylightSimulation::choose_states() {
    Data& d = *data_;
    const std::vector<SurfacePoint> places = d.open.places(d.task.sensors);
    const DaylightRows rows = d.open.rows();
    const SensorYears years(d.open.setting, {}, {});
    const YearSuns suns(d.sky);
    const PaneGroups& panes = d.open.transport.pane_groups();
    const auto open_light = [&](std::size_t sensor) {
        const auto known = [&](std::size_t i) { return d.open.find(i); };
        const auto place = std::span(places).subspan(sensor, 1);
        DaylightMatrix matrix = rows.rows(place, sensor, known);
        const std::vector<DaylightMatrix> through = std::exchange(matrix.through, {});
        const DaylightBlock block = years.evaluate(sensor, place, std::move(matrix));
        std::vector<std::vector<float>> out{block.illuminance};
        for (std::size_t g = 0; g < through.size(); ++g) {
            std::vector<float>& part = out.emplace_back(block.sun);
            suns.keep_through(panes, g, place[0], part);
            d.sky.add_sky(through[g].direct, part), d.sky.add_with_sun(through[g].reflected, part);
        }
        return out;
    };
    const StateChooser chooser(*d.task.states, d.open.setting, d.open.transport.stage().occluders, panes, places,
                               open_light);
    const double twice = panes.has_all_light() ? 0 : d.open.light.twice;
    d.states = make_hourly_states(*d.task.states, chooser, d.open.setting, twice);
    const std::size_t groups = d.task.states->groups.size();
    for (std::size_t k = 0; k < d.states.parts.size(); ++k) {
        const DaylightTransport& transport = k < groups ? d.open.transport : d.changed[k - groups]->transport;
        d.states.parts[k].groups = &transport.pane_groups();
        if (k >= groups) d.states.parts[k].occluders = &transport.stage().occluders;
    }
    d.open.setting.states = &d.states;
}

const HourlyStates* DaylightSimulation::states() const {
    return data_->open.setting.states;
}

std::vector<std::string> DaylightSimulation::warnings() const {
    // Share of the light at the sensors that may cross panes twice without a warning; derived from the default error
    // of 2%, of which it is half.
    constexpr double small_share = 0.01;
    const double twice = data_->states.twice, error = data_->error_of_states, wanted = data_->task.error;
    std::vector<std::string> out;
    if (twice > small_share)
        out.push_back(
            fmt::format("{:.2g}% of the light crosses panes of groups twice, and counts as if it crossed them once: "
                        "intervals of hours with changed states are wider by it",
                        100 * twice));
    if (error > wanted) {
        const NumberTexts percents = distinct_percents(error, wanted, 2);
        out.push_back(fmt::format("the error of {}% with the geometry of a state is above the requested {}%",
                                  percents.first, percents.second));
    }
    return out;
}

std::vector<std::string> DaylightSimulation::sensor_warnings() const {
    const SceneLight& open = data_->open;
    const std::vector<SurfacePoint> places = open.places(data_->task.sensors);
    return warnings_of(find_misplaced(open.transport.stage(), places), places);
}

/// Returns the rows of the parts of HourlyStates at consecutive sensors. `through`: those of the task's scene.
std::vector<StateRows> DaylightSimulation::state_rows(std::size_t first, std::span<const SurfacePoint> places,
                                                      std::vector<DaylightMatrix> through) const {
    const Data& d = *data_;
    std::vector<StateRows> out;
    for (DaylightMatrix& part : through)
        out.push_back({std::move(part), std::vector<SurfacePoint>(places.begin(), places.end())});
    for (const std::unique_ptr<SceneLight>& scene : d.changed) {
        std::vector<SurfacePoint> here = scene->places(std::span(d.task.sensors).subspan(first, places.size()));
        const auto known = [&](std::size_t i) { return scene->find(i); };
        DaylightMatrix part = std::move(scene->rows().rows(here, first, known).through[0]);
        out.push_back({std::move(part), std::move(here)});
    }
    return out;
}

bool DaylightSimulation::take(DaylightLight light) {
    SceneLight& open = data_->open;
    open.transport.make_elements(light.options.elements);
    if (light.elements.columns != data_->patches.size() || light.options.seed != Data::seed) return false;
    for (const std::vector<float>& replicate : light.elements.reflected)
        if (replicate.size() != open.transport.leaves() * light.elements.columns) return false;
    open.light = std::move(light);
    return true;
}

const DaylightLight& DaylightSimulation::light() const {
    return data_->open.light;
}

Result<void> DaylightSimulation::evaluate(SensorRange range, const DaylightSink& sink) const {
    const Data& d = *data_;
    d.progress.phase("year");
    const std::vector<SurfacePoint> places = d.open.places(std::span(d.task.sensors).subspan(range.first, range.count));
    const DaylightRows rows = d.open.rows();
    const SensorYears years(d.open.setting, d.open.light.bias, d.task.sun_day);
    const auto known = [&](std::size_t i) { return d.open.find(i); };
    const auto evaluate_some = [&](std::size_t at, std::size_t count) {
        const auto together = std::span(places).subspan(at, count);
        const std::size_t first = range.first + at;
        DaylightMatrix matrix = rows.rows(together, first, known);
        const std::vector<StateRows> parts = state_rows(first, together, std::exchange(matrix.through, {}));
        return years.evaluate(first, together, std::move(matrix), parts);
    };
    return pass_blocks<DaylightBlock>(places.size(), evaluate_some, archive_block, sink, d.progress, d.stop);
}

Result<std::vector<GlareYear>> DaylightSimulation::glare(std::span<const ProbePoint> views, double threshold) const {
    const Data& d = *data_;
    d.progress.phase("glare");
    const Scene& scene = d.open.setting.scene;
    std::vector<SurfacePoint> eyes = d.open.places(views);
    const PlaceFinder places(scene);
    for (SurfacePoint& eye : eyes)  // rays from an eye on a wall would end there
        if (!eye.region.is_none()) eye.x += places.step() * scene.regions()[eye.region].plane.n, eye.region = {};
    const DaylightRows rows(d.open.transport, d.open.light.elements, d.patches, d.open.light.options.rays_a_sensor);
    const SensorYears years(d.open.setting, d.open.light.bias, {});
    const GlareYears glare(d.open.setting, d.open.transport, d.open.light.elements, threshold);
    using Years = std::vector<GlareYear>;
    const auto evaluate_some = [&](std::size_t at, std::size_t count) {
        const auto together = std::span(std::as_const(eyes)).subspan(at, count);
        const std::size_t first =
            // number of the first eye, after those of the sensors, so that their random points differ
            d.task.sensors.size() + at;
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
    const std::vector<SurfacePoint> places = sensor_places(scene, Occluders(scene), task.sensors);
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

namespace {

/// Finds the light and evaluates all sensors.
Result<DaylightSummary> run_year(DaylightSimulation& simulation, const DaylightTask& task, const DaylightSink& sink) {
    if (const Result<void> found = simulation.find_light(); !found) return found.error();
    DaylightTotals totals(task.grids, task.hours, task.site, task.criteria);
    const auto add = [&](const DaylightBlock& block) {
        for (const SensorResults& sensor : block.results) totals.add(sensor);
        return sink(block);
    };
    if (const Result<void> done = simulation.evaluate({0, task.sensors.size()}, add); !done) return done.error();
    return totals.summary(simulation.light().bias);
}

}  // namespace

Result<DaylightResults> collect_year(const Scene& scene, const DaylightTask& task, Progress& progress,
                                     const StopRequest& stop) {
    const std::size_t n = task.sensors.size(), hours = task.hours.size();
    DaylightResults out;
    out.year.sensors = n;
    out.year.illuminance.resize(n * hours), out.year.sun.resize(n * hours);
    const auto append = [](std::vector<float>& all, const std::vector<float>& more) {
        all.insert(all.end(), more.begin(), more.end());
    };
    const std::size_t variants = task.states ? task.states->variants.size() : 0;
    VariantTotals of_variants(variants);
    const auto keep = [&](const DaylightBlock& block) -> Result<void> {
        for (std::size_t i = 0; i < block.variants.size(); i += variants)
            of_variants.add(std::span(block.variants).subspan(i, variants));
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
    DaylightSimulation simulation(scene, task, progress, stop);
    Result<DaylightSummary> summary = run_year(simulation, task, keep);
    if (!summary) return summary.error();
    out.summary = std::move(*summary);
    if (const HourlyStates* const states = simulation.states()) out.states = states->state;
    if (variants > 0) out.variants = of_variants.summaries();
    out.warnings = simulation.warnings();
    return out;
}

}  // namespace exitance
