#include "exitance/io/report/daylight_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/write_error.hpp"

namespace exitance {
namespace {

/// Names of the results of DA and UDI, such as DA_300 and UDI_100_300.
std::vector<std::string> result_names(const DaylightCriteria& criteria) {
    const auto& [low, middle, high] = criteria.useful;
    return {fmt::format("DA_{:g}", criteria.target), fmt::format("UDI_below_{:g}", low),
            fmt::format("UDI_{:g}_{:g}", low, middle), fmt::format("UDI_{:g}_{:g}", middle, high),
            fmt::format("UDI_above_{:g}", high)};
}

std::string metrics_header(const DaylightCriteria& criteria) {
    const std::vector<std::string> names = result_names(criteria);
    const std::string continuous = fmt::format("cDA_{:g}", criteria.target);
    std::string out = fmt::format("x,y,z,nx,ny,nz,DF,{},sun_hours,E_half_of_daylight,sunlight_hours,{},electric_hours",
                                  fmt::join(names, ","), continuous);
    const auto add = [&](const std::string& name) { out += fmt::format(",{0}_low,{0}_high", name); };
    add("DF");
    for (const std::string& name : names) add(name);
    add("E_half_of_daylight"), add(continuous), add("electric_hours");
    return out + '\n';
}

/// Row of a sensor in metrics.csv.
std::string metrics_row(const ProbePoint& at, const SensorResults& sensor) {
    const auto& [x, n] = at;
    const DaylightMetrics& m = sensor.metrics;
    const SensorIntervals& s = sensor.intervals;
    std::string row = fmt::format(
        "{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{:.6g},"
        "{:.6g},{:.6g},{:.6g}",
        x.x, x.y, x.z, n.x, n.y, n.z, m.daylight_factor, m.autonomy, m.useful[0], m.useful[1], m.useful[2], m.useful[3],
        m.sunny_hours, sensor.reached, sensor.sunlight, m.continuous, m.electric_hours);
    const auto add = [&](const Interval& interval) {
        row += fmt::format(",{:.6g},{:.6g}", interval.low, interval.high);
    };
    add(s.factor), add(s.autonomy);
    for (const Interval& useful : s.useful) add(useful);
    add(s.reached), add(s.continuous), add(s.electric_hours);
    return row + '\n';
}

/// matrix.csv
class CsvMatrix final : public MatrixFile {
  public:
    explicit CsvMatrix(AtomicFile file) : file_(std::move(file)) {}

    void add(const DaylightMatrix& matrix) override {
        std::string text;
        if (std::exchange(is_first_, false)) {
            text = "ground";
            for (std::size_t p = 1; p < matrix.patches; ++p) text += fmt::format(",patch_{}", p);
            text += '\n';
        }
        for (std::size_t i = 0; i < matrix.sensors(); ++i)
            for (std::size_t p = 0; p < matrix.patches; ++p)
                fmt::format_to(std::back_inserter(text), "{:.6g}{}", matrix.total(i, p),
                               p + 1 < matrix.patches ? ',' : '\n');
        file_.write(text);
    }
    Result<void> finish() override { return file_.commit(); }

  private:
    AtomicFile file_;
    bool is_first_ = true;
};

/// matrix.mtx
class RadianceMatrixFile final : public MatrixFile {
  public:
    explicit RadianceMatrixFile(RadianceMatrixWriter file) : file_(std::move(file)) {}

    void add(const DaylightMatrix& matrix) override {
        std::vector<double> row(matrix.patches);
        for (std::size_t i = 0; i < matrix.sensors(); ++i) {
            for (std::size_t p = 0; p < matrix.patches; ++p) row[p] = matrix.total(i, p);
            file_.append_row(row);
        }
    }
    Result<void> finish() override { return file_.commit(); }

  private:
    RadianceMatrixWriter file_;
};

Result<std::unique_ptr<MatrixFile>> make_matrix_file(const std::string& folder, const DaylightTask& task,
                                                     std::optional<MatrixFormat> format) {
    using Made = std::unique_ptr<MatrixFile>;
    const std::filesystem::path path(folder);
    if (!format) {
        Result<AtomicFile> file = AtomicFile::create((path / "matrix.csv").string());
        if (!file) return file.error();
        return Made(std::make_unique<CsvMatrix>(std::move(*file)));
    }
    Result<RadianceMatrixWriter> file =
        RadianceMatrixWriter::create((path / "matrix.mtx").string(), *format, task.sensors.size(),
                                     SkyPatches::count(static_cast<std::size_t>(task.division)));
    if (!file) return file.error();
    return Made(std::make_unique<RadianceMatrixFile>(std::move(*file)));
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
    out.emplace_back("EN17037_sunlight_hours_most", summary.max_sunlight);
    if (!views.empty()) out.emplace_back("EN17037_view_level", view_level(views));
    if (!summary.glare) return;
    const GlareSummary& glare = *summary.glare;
    out.emplace_back("EN17037_glare_views", static_cast<double>(glare.views));
    out.emplace_back("EN17037_glare_minimum", glare.at_level[0]);
    out.emplace_back("EN17037_glare_medium", glare.at_level[1]);
    out.emplace_back("EN17037_glare_high", glare.at_level[2]);
    out.emplace_back("EN17037_glare_level", glare.level);
    out.emplace_back("EN17037_glare_worst", glare.worst);
}

}  // namespace

Result<void> write_states(const std::string& folder, const DaylightStates& states, const HourlyStates& hourly,
                          std::span<const DaylightHour> hours) {
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    std::string text = "month,day,hour";
    for (const PaneGroup& group : states.groups) text += ',' + quoted(group.name);
    text += '\n';
    for (std::size_t h = 0; h < hours.size(); ++h) {
        text += fmt::format("{},{},{}", hours[h].time.month, hours[h].time.day, hours[h].hour);
        for (const std::vector<std::uint8_t>& state : hourly.state) text += fmt::format(",{}", state[h]);
        text += '\n';
    }
    return write_file((std::filesystem::path(folder) / "states.csv").string(), text);
}

Result<void> write_variants(const std::string& folder, const DaylightTask& task,
                            std::span<const VariantSummary> variants) {
    std::string text = "variant";
    for (const PaneGroup& group : task.states->groups) text += ',' + quoted(group.name);
    text += fmt::format(",sDA_{0:g}_50,sDA_{0:g}_50_low,sDA_{0:g}_50_high,mean_cDA_{0:g},mean_E,ASE_1000_250\n",
                        task.criteria.target);
    for (std::size_t v = 0; v < variants.size(); ++v) {
        const GlassVariant& variant = task.states->variants[v];
        const VariantSummary& s = variants[v];
        text += quoted(variant.name);
        for (const double factor : variant.factors) text += fmt::format(",{:g}", factor);
        text += fmt::format(",{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", s.autonomy, s.bounds.low, s.bounds.high,
                            s.continuous, s.illuminance, s.exposure);
    }
    return write_file((std::filesystem::path(folder) / "variants.csv").string(), text);
}

std::vector<std::pair<std::string, double>> summary_values(const DaylightTask& task, const DaylightSummary& s,
                                                           std::span<const ViewOut> views) {
    const DaylightError error = worst_of(s.errors);
    const std::string sDA = fmt::format("sDA_{:g}_50", task.criteria.target);
    std::vector<std::pair<std::string, double>> out{{"sensors", static_cast<double>(s.sensors)},
                                                    {"hours", static_cast<double>(task.hours.size())},
                                                    {"occupied_hours", static_cast<double>(s.occupied_hours)},
                                                    {"mean_daylight_factor", s.mean_daylight_factor},
                                                    {sDA, s.spatial_autonomy},
                                                    {"ASE_1000_250", s.sunlight_exposure},
                                                    {"error_daylight_factor", error.factor},
                                                    {"error_lux_hours", error.lux_hours},
                                                    {"mean_daylight_factor_low", s.mean_factor.low},
                                                    {"mean_daylight_factor_high", s.mean_factor.high},
                                                    {sDA + "_low", s.spatial_autonomy_bounds.low},
                                                    {sDA + "_high", s.spatial_autonomy_bounds.high}};
    out.emplace_back(fmt::format("mean_cDA_{:g}", task.criteria.target), s.continuous_autonomy);
    out.emplace_back("mean_electric_hours", s.electric_hours);
    out.emplace_back("sDA_conforms_to_LM83", s.lm83.autonomy.empty());
    out.emplace_back("ASE_conforms_to_LM83", s.lm83.exposure.empty());
    add_provision(s, views, out);
    return out;
}

DaylightFiles::DaylightFiles(std::string folder, const DaylightTask& task, std::unique_ptr<HoursFile> hours,
                             AtomicFile metrics, std::unique_ptr<MatrixFile> matrix)
    : folder_(std::move(folder)),
      task_(&task),
      hours_(std::move(hours)),
      metrics_(std::move(metrics)),
      matrix_(std::move(matrix)) {
    metrics_.write(metrics_header(task.criteria));
}

Result<DaylightFiles> DaylightFiles::create(const std::string& folder, const DaylightTask& task,
                                            const DaylightFormats& formats) {
    if (const Result<void> made = make_folder(folder); !made) return made.error();
    const auto in = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
    Result<std::unique_ptr<HoursFile>> hours = make_hours_file(folder, formats.hours, task);
    if (!hours) return hours.error();
    Result<AtomicFile> metrics = AtomicFile::create(in("metrics.csv"));
    Result<std::unique_ptr<MatrixFile>> matrix = make_matrix_file(folder, task, formats.matrix);
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
    hours_->add(block), matrix_->add(block.matrix);
    for (std::size_t i = 0; i < block.results.size(); ++i)
        metrics_.write(metrics_row(task_->sensors[block.first + i], block.results[i]));
    return honeybee_ ? honeybee_->add(block) : Result<void>();
}

Result<void> DaylightFiles::finish(const DaylightSummary& summary, std::span<const Point> eyes,
                                   std::span<const ViewOut> views) {
    const auto in = [&](const char* name) { return (std::filesystem::path(folder_) / name).string(); };
    std::string text = "name,value\n";
    for (const auto& [name, value] : summary_values(*task_, summary, views))
        text += fmt::format("{},{:.6g}\n", name, value);
    for (const Result<void>& written :
         {hours_->finish(), metrics_.commit(), matrix_->finish(), honeybee_ ? honeybee_->finish() : Result<void>(),
          write_grids(in("grids.csv"), *task_, summary), write_file(in("summary.csv"), text)})
        if (!written) return written.error();
    return views.empty() ? Result<void>() : write_views(in("view.csv"), eyes, views);
}

}  // namespace exitance
