#include "exitance/io/report/daylight_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "exitance/io/files/atomic_file.hpp"

namespace exitance {
namespace {

Result<void> write_hours(const std::string& path, const DaylightTask& task, std::span<const float> values) {
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    const std::size_t n = task.sensors.size();
    fmt::memory_buffer row;
    const auto out = [&] { return std::back_inserter(row); };
    fmt::format_to(out(), "month,day,hour");
    for (std::size_t i = 0; i < n; ++i) fmt::format_to(out(), ",E_{}", i);
    for (std::size_t h = 0; h < task.hours.size(); ++h) {
        const DaylightHour& hour = task.hours[h];
        fmt::format_to(out(), "\n{},{},{}", hour.time.month, hour.time.day, hour.hour);
        for (std::size_t i = 0; i < n; ++i) {
            const float v = values[h * n + i];
            if (v == 0)
                fmt::format_to(out(), ",0");
            else
                fmt::format_to(out(), ",{:.5g}", v);
        }
        file->write(std::string_view(row.data(), row.size()));
        row.clear();
    }
    file->write("\n");
    return file->commit();
}

Result<void> write_metrics(const std::string& path, const DaylightTask& task, const DaylightResults& results) {
    std::string text =
        "x,y,z,nx,ny,nz,DF,DA_300,UDI_below_100,UDI_100_300,UDI_300_3000,UDI_above_3000,sun_hours,"
        "E_half_of_daylight,sunlight_hours,DF_low,DF_high,DA_300_low,DA_300_high,UDI_below_100_low,UDI_below_100_high,"
        "UDI_100_300_low,UDI_100_300_high,UDI_300_3000_low,UDI_300_3000_high,UDI_above_3000_low,UDI_above_3000_high,"
        "E_half_of_daylight_low,E_half_of_daylight_high\n";
    for (std::size_t i = 0; i < results.sensors.size(); ++i) {
        const auto& [x, n] = task.sensors[i];
        const SensorResults& sensor = results.sensors[i];
        const DaylightMetrics& m = sensor.metrics;
        const SensorIntervals& s = sensor.intervals;
        text += fmt::format(
            "{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{:.6g},"
            "{:.6g}",
            x.x, x.y, x.z, n.x, n.y, n.z, m.daylight_factor, m.autonomy, m.useful[0], m.useful[1], m.useful[2],
            m.useful[3], m.sunny_hours, sensor.reached, sensor.sunlight);
        const auto add = [&](const Interval& interval) {
            text += fmt::format(",{:.6g},{:.6g}", interval.low, interval.high);
        };
        add(s.factor), add(s.autonomy);
        for (const Interval& useful : s.useful) add(useful);
        add(s.reached);
        text += '\n';
    }
    return write_file(path, text);
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

Result<void> write_matrix(const std::string& path, const DaylightMatrix& matrix) {
    std::string text = "ground";
    for (std::size_t p = 1; p < matrix.patches; ++p) text += fmt::format(",patch_{}", p);
    for (std::size_t i = 0; i < matrix.sensors(); ++i) {
        text += '\n';
        for (std::size_t p = 0; p < matrix.patches; ++p)
            text += fmt::format("{}{:.6g}", p > 0 ? "," : "", matrix.total(i, p));
    }
    return write_file(path, text + "\n");
}

Result<void> write_views(const std::string& path, const DaylightResults& results) {
    std::string text = "x,y,z,sight_angle,distance,sky,landscape,ground,level\n";
    for (std::size_t i = 0; i < results.eyes.size(); ++i) {
        const Point& x = results.eyes[i];
        const ViewOut& v = results.views[i];
        text += fmt::format("{:.10g},{:.10g},{:.10g},{:.5g},{:.5g},{:d},{:d},{:d},{}\n", x.x, x.y, x.z, v.sight_angle,
                            v.distance, v.sky, v.landscape, v.ground, v.level());
    }
    return write_file(path, text);
}

/// The highest level that at least three quarters of the eye points reach.
int view_level(const std::vector<ViewOut>& views) {
    constexpr double wanted = 0.75;
    for (int level = 3; level > 0; --level) {
        const auto reached =
            std::count_if(views.begin(), views.end(), [&](const ViewOut& v) { return v.level() >= level; });
        if (static_cast<double>(reached) >= wanted * static_cast<double>(views.size())) return level;
    }
    return 0;
}

void add_provision(const DaylightResults& results, std::vector<std::pair<std::string, double>>& out) {
    const DaylightProvision& p = results.summary.provision;
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
    out.emplace_back("EN17037_sunlight_hours_most", results.summary.most_sunlight);
    if (!results.views.empty()) out.emplace_back("EN17037_view_level", view_level(results.views));
}

}  // namespace

std::vector<std::pair<std::string, double>> summary_values(const DaylightTask& task, const DaylightResults& results) {
    const DaylightSummary& s = results.summary;
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
    add_provision(results, out);
    return out;
}

Result<void> write_daylight(const std::string& folder, const DaylightTask& task, const DaylightResults& results) {
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) return Error{ErrorCode::cannot_write, "cannot be made: " + failure.message(), folder, ""};
    const auto in = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
    std::string summary = "name,value\n";
    for (const auto& [name, value] : summary_values(task, results)) summary += fmt::format("{},{:.6g}\n", name, value);
    for (const Result<void>& written :
         {write_hours(in("illuminance.csv"), task, results.year.illuminance),
          write_hours(in("sun.csv"), task, results.year.sun), write_metrics(in("metrics.csv"), task, results),
          write_grids(in("grids.csv"), task, results.summary), write_matrix(in("matrix.csv"), results.matrix),
          write_file(in("summary.csv"), summary)})
        if (!written) return written.error();
    return results.views.empty() ? Result<void>() : write_views(in("view.csv"), results);
}

}  // namespace exitance
