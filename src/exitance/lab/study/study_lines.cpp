#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/lab/study/study_run.hpp"
#include "exitance/reference/path_reference.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

std::vector<ProbePoint> points_of(const StudyLine& line) {
    const Vec3 n{line.normal[0], line.normal[1], line.normal[2]};
    const Point from{line.from[0], line.from[1], line.from[2]}, to{line.to[0], line.to[1], line.to[2]};
    std::vector<ProbePoint> points;
    for (std::size_t i = 0; i < line.points; ++i) {
        const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(line.points);
        points.push_back({from + share * (to - from), (1 / norm(n)) * n});
    }
    return points;
}

/// Returns the records of runs whose solutions are kept.
std::vector<fs::path> kept_records(const std::string& folder) {
    std::vector<fs::path> records;
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(folder) / "runs", failed))
        if (entry.path().extension() == ".h5") records.push_back(fs::path(entry.path()).replace_extension(".csv"));
    std::sort(records.begin(), records.end());
    return records;
}

struct LineRows {
    const StudyLine& line;
    std::string scene, parameter, row, setting;
};

/// Light at the points of a line, with its first and second derivative along the line.
struct LineLight {
    std::vector<double> E, slope, curvature;  ///< W/m^2, W/m^3, W/m^4
};

/// Evaluates light at the points and a quarter of their distance before and after them. Central differences are exact
/// for quadratic elements, but where a border of elements lies in between. `at`: light at points.
template <class LightAtPoints>
LineLight light_along(const StudyLine& line, const std::vector<ProbePoint>& points, const LightAtPoints& at) {
    constexpr double part = 1.0 / 4;
    const Vec3 whole = points.back().x - points.front().x;
    const Vec3 step = (part / static_cast<double>(std::max<std::size_t>(line.points - 1, 1))) * whole;
    const double h = norm(step);
    const auto moved = [&](double steps) {
        std::vector<ProbePoint> out = points;
        for (ProbePoint& p : out) p.x += steps * step;
        return at(out);
    };
    const std::vector<Light> here = moved(0), before = moved(-1), after = moved(1);
    LineLight out;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double E = mean(here[i].irradiance), a = mean(before[i].irradiance), b = mean(after[i].irradiance);
        out.E.push_back(E);
        out.slope.push_back(h > 0 ? (b - a) / (2 * h) : 0);
        out.curvature.push_back(h > 0 ? (a - 2 * E + b) / (h * h) : 0);
    }
    return out;
}

void add_rows(Table& table, const LineRows& of, const LineLight& light, const LineLight& drawn,
              const std::vector<double>& truth) {
    const double length =
        std::hypot(of.line.to[0] - of.line.from[0], of.line.to[1] - of.line.from[1], of.line.to[2] - of.line.from[2]);
    const double largest = *std::max_element(truth.begin(), truth.end());
    for (std::size_t i = 0; i < light.E.size(); ++i) {
        const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(light.E.size());
        table.add_row();
        table.set("line", of.line.name), table.set("scene", of.scene), table.set("parameter", of.parameter);
        table.set("row", of.row), table.set("setting", of.setting), table.set("s", field(share * length));
        table.set("irradiance", field(light.E[i])), table.set("interpolant", field(drawn.E[i]));
        table.set("error", field((light.E[i] - truth[i]) / largest));
        table.set("error_interpolant", field((drawn.E[i] - truth[i]) / largest));
        if (light.slope.empty()) continue;
        table.set("slope", field(light.slope[i])), table.set("curvature", field(light.curvature[i]));
        table.set("slope_interpolant", field(drawn.slope[i]));
        table.set("curvature_interpolant", field(drawn.curvature[i]));
    }
}

}  // namespace

bool is_chosen(const ChosenSolution& of, const Table& table, std::size_t row) {
    return table.text(row, "row") == of.row && (of.scene.empty() || table.text(row, "scene") == of.scene) &&
           (of.setting.empty() || table.text(row, "level") == of.setting) &&
           (std::isnan(of.value) || table.number(row, "parameter") == of.value);
}

std::string kept_solution(const ChosenSolution& of, const std::string& folder) {
    for (fs::path path : kept_records(folder)) {
        const Result<Table> record = read_csv(path.string());
        if (!record || record->rows.empty() || !is_chosen(of, *record, record->rows.size() - 1)) continue;
        if (std::isnan(of.at)) return path.replace_extension(".h5").string();
        const std::string instant = instant_path(path.replace_extension().string(), of.at);
        return fs::exists(instant) ? instant : "";
    }
    return "";
}

std::string instant_path(const std::string& stem, double at) {
    return fmt::format("{}_at_{:g}.h5", stem, at);
}

Result<Table> profile_table(const Study& study, const StudyOptions& options, Progress& progress,
                            const StopRequest& stop) {
    Table table{{"line", "scene", "parameter", "row", "setting", "s", "irradiance", "interpolant", "error",
                 "error_interpolant", "slope", "curvature", "slope_interpolant", "curvature_interpolant"},
                {}};
    const std::size_t paths = options.quick ? study.reference.quick_paths : study.reference.paths;
    std::map<std::pair<std::string, std::string>, std::vector<double>> truths;  // by the line's name and the scene
    for (const StudyLine& line : study.lines)
        for (fs::path path : kept_records(options.folder)) {
            const Result<Table> record = read_csv(path.string());
            if (!record || record->rows.empty() || stop.requested()) continue;
            const std::size_t last = record->rows.size() - 1;
            if (!is_chosen(line.of, *record, last)) continue;
            const Result<Solution> solution = load_solution(path.replace_extension(".h5").string());
            if (!solution) return solution.error();
            const std::vector<ProbePoint> points = points_of(line);
            const LineRows rows{line, record->text(last, "scene"), record->text(last, "parameter"),
                                record->text(last, "row"), record->text(last, "setting")};
            std::vector<double>& truth = truths[{line.name, rows.scene + " " + rows.parameter}];
            if (truth.empty()) {
                for (const ReferenceLight& light :
                     reference_light(solution->scene, points, std::max<std::size_t>(paths, 16), 1, progress, stop))
                    truth.push_back(mean(light.irradiance));
                add_rows(table, {line, rows.scene, rows.parameter, "reference", "reference"}, {truth, {}, {}},
                         {truth, {}, {}}, truth);
            }
            const RadiosityFunction function(*solution);
            const LineLight light = light_along(line, points, [&](const auto& at) { return function.at(at); });
            const LineLight drawn =
                light_along(line, points, [&](const auto& at) { return function.interpolant_at(at); });
            add_rows(table, rows, light, drawn, truth);
        }
    return table;
}

}  // namespace exitance
