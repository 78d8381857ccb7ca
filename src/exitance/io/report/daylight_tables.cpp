#include "exitance/io/report/daylight_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "exitance/io/files/atomic_file.hpp"

namespace exitance {
namespace {

constexpr std::string_view metrics_header =
    "x,y,z,nx,ny,nz,DF,DA_300,UDI_below_100,UDI_100_300,UDI_300_3000,UDI_above_3000,sun_hours,"
    "E_half_of_daylight,sunlight_hours,DF_low,DF_high,DA_300_low,DA_300_high,UDI_below_100_low,UDI_below_100_high,"
    "UDI_100_300_low,UDI_100_300_high,UDI_300_3000_low,UDI_300_3000_high,UDI_above_3000_low,UDI_above_3000_high,"
    "E_half_of_daylight_low,E_half_of_daylight_high\n";

/// Row of a sensor in metrics.csv.
std::string metrics_row(const ProbePoint& at, const SensorResults& sensor) {
    const auto& [x, n] = at;
    const DaylightMetrics& m = sensor.metrics;
    const SensorIntervals& s = sensor.intervals;
    std::string row = fmt::format(
        "{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{:.6g},"
        "{:.6g}",
        x.x, x.y, x.z, n.x, n.y, n.z, m.daylight_factor, m.autonomy, m.useful[0], m.useful[1], m.useful[2], m.useful[3],
        m.sunny_hours, sensor.reached, sensor.sunlight);
    const auto add = [&](const Interval& interval) {
        row += fmt::format(",{:.6g},{:.6g}", interval.low, interval.high);
    };
    add(s.factor), add(s.autonomy);
    for (const Interval& useful : s.useful) add(useful);
    add(s.reached);
    return row + '\n';
}

std::string matrix_header(std::size_t patches) {
    std::string text = "ground";
    for (std::size_t p = 1; p < patches; ++p) text += fmt::format(",patch_{}", p);
    return text + '\n';
}

/// Row of a sensor in matrix.csv.
std::string matrix_row(const DaylightMatrix& matrix, std::size_t sensor) {
    std::string text;
    for (std::size_t p = 0; p < matrix.patches; ++p)
        fmt::format_to(std::back_inserter(text), "{}{:.6g}", p > 0 ? "," : "", matrix.total(sensor, p));
    return text + '\n';
}

/// Quotes a name for CSV.
std::string quoted(const std::string& name) {
    std::string out = "\"";
    for (const char c : name) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + '"';
}

Result<void> write_grids(const std::string& path, const DaylightTask& task, const DaylightSummary& summary) {
    std::string text = "grid,sensors,mean_daylight_factor,error_daylight_factor,error_lux_hours\n";
    for (std::size_t g = 0; g < task.grids.size(); ++g)
        text += fmt::format("{},{},{:.6g},{:.4g},{:.4g}\n", quoted(task.grids[g].name), task.grids[g].count,
                            summary.grid_factors[g], summary.errors[g].factor, summary.errors[g].lux_hours);
    return write_file(path, text);
}

Result<void> write_views(const std::string& path, std::span<const Point> eyes, std::span<const ViewOut> views) {
    std::string text = "x,y,z,sight_angle,distance,sky,landscape,ground,level\n";
    for (std::size_t i = 0; i < eyes.size(); ++i) {
        const Point& x = eyes[i];
        const ViewOut& v = views[i];
        text += fmt::format("{:.10g},{:.10g},{:.10g},{:.5g},{:.5g},{:d},{:d},{:d},{}\n", x.x, x.y, x.z, v.sight_angle,
                            v.distance, v.sky, v.landscape, v.ground, v.level());
    }
    return write_file(path, text);
}

/// The highest level that at least three quarters of the eye points reach.
int view_level(std::span<const ViewOut> views) {
    constexpr double wanted = 0.75;
    for (int level = 3; level > 0; --level) {
        const auto reached =
            std::count_if(views.begin(), views.end(), [&](const ViewOut& v) { return v.level() >= level; });
        if (static_cast<double>(reached) >= wanted * static_cast<double>(views.size())) return level;
    }
    return 0;
}

void add_provision(const DaylightSummary& summary, std::span<const ViewOut> views,
                   std::vector<std::pair<std::string, double>>& out) {
    const DaylightProvision& p = summary.provision;
    out.emplace_back("EN17037_daylight_hours", static_cast<double>(p.hours));
    const auto add = [&](const std::string& way, const DaylightProvision::Shares& shares) {
        for (std::size_t k = 0; k < 3; ++k)
            out.emplace_back(fmt::format("EN17037{}_target_{:g}", way, DaylightProvision::targets[k]),
                             shares.at_target[k]);
        for (std::size_t k = 0; k < 3; ++k)
            out.emplace_back(fmt::format("EN17037{}_minimum_{:g}", way, DaylightProvision::minimums[k]),
                             shares.at_minimum[k]);
        out.emplace_back(fmt::format("EN17037{}_level", way), shares.level());
    };
    add("", p.by_illuminance);
    out.emplace_back("EN17037_median_diffuse", p.median_diffuse);
    add("_factor", p.by_factor);
    out.emplace_back("EN17037_sunlight_hours_most", summary.most_sunlight);
    if (!views.empty()) out.emplace_back("EN17037_view_level", view_level(views));
}

}  // namespace

std::vector<std::pair<std::string, double>> summary_values(const DaylightTask& task, const DaylightSummary& s,
                                                           std::span<const ViewOut> views) {
    const DaylightError error = worst_of(s.errors);
    std::vector<std::pair<std::string, double>> out{{"sensors", static_cast<double>(s.sensors)},
                                                    {"hours", static_cast<double>(task.hours.size())},
                                                    {"occupied_hours", static_cast<double>(s.occupied_hours)},
                                                    {"mean_daylight_factor", s.mean_daylight_factor},
                                                    {"sDA_300_50", s.spatial_autonomy},
                                                    {"ASE_1000_250", s.sunlight_exposure},
                                                    {"error_daylight_factor", error.factor},
                                                    {"error_lux_hours", error.lux_hours},
                                                    {"mean_daylight_factor_low", s.mean_factor.low},
                                                    {"mean_daylight_factor_high", s.mean_factor.high},
                                                    {"sDA_300_50_low", s.spatial_autonomy_bounds.low},
                                                    {"sDA_300_50_high", s.spatial_autonomy_bounds.high}};
    add_provision(s, views, out);
    return out;
}

DaylightFiles::DaylightFiles(std::string folder, const DaylightTask& task, std::unique_ptr<HoursFile> hours,
                             AtomicFile metrics, AtomicFile matrix)
    : folder_(std::move(folder)),
      task_(&task),
      hours_(std::move(hours)),
      metrics_(std::move(metrics)),
      matrix_(std::move(matrix)) {
    metrics_.write(metrics_header);
}

Result<DaylightFiles> DaylightFiles::create(const std::string& folder, const DaylightTask& task,
                                            const DaylightFormats& formats) {
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) return Error{ErrorCode::cannot_write, "cannot be made: " + failure.message(), folder, ""};
    const auto in = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
    Result<std::unique_ptr<HoursFile>> hours = make_hours_file(folder, formats.hours, task);
    if (!hours) return hours.error();
    Result<AtomicFile> metrics = AtomicFile::create(in("metrics.csv")), matrix = AtomicFile::create(in("matrix.csv"));
    if (!metrics) return metrics.error();
    if (!matrix) return matrix.error();
    DaylightFiles out(folder, task, std::move(*hours), std::move(*metrics), std::move(*matrix));
    if (formats.honeybee) {
        Result<HoneybeeResults> honeybee = HoneybeeResults::create(in("honeybee"), task);
        if (!honeybee) return honeybee.error();
        out.honeybee_.emplace(std::move(*honeybee));
    }
    return out;
}

Result<void> DaylightFiles::add(const DaylightBlock& block) {
    if (block.first == 0) matrix_.write(matrix_header(block.matrix.patches));
    hours_->add(block);
    for (std::size_t i = 0; i < block.results.size(); ++i) {
        metrics_.write(metrics_row(task_->sensors[block.first + i], block.results[i]));
        matrix_.write(matrix_row(block.matrix, i));
    }
    return honeybee_ ? honeybee_->add(block) : Result<void>();
}

Result<void> DaylightFiles::finish(const DaylightSummary& summary, std::span<const Point> eyes,
                                   std::span<const ViewOut> views) {
    const auto in = [&](const char* name) { return (std::filesystem::path(folder_) / name).string(); };
    std::string text = "name,value\n";
    for (const auto& [name, value] : summary_values(*task_, summary, views))
        text += fmt::format("{},{:.6g}\n", name, value);
    for (const Result<void>& written :
         {hours_->finish(), metrics_.commit(), matrix_.commit(), honeybee_ ? honeybee_->finish() : Result<void>(),
          write_grids(in("grids.csv"), *task_, summary), write_file(in("summary.csv"), text)})
        if (!written) return written.error();
    return views.empty() ? Result<void>() : write_views(in("view.csv"), eyes, views);
}

}  // namespace exitance
