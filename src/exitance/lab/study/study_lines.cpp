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

void add_rows(Table& table, const LineRows& of, const std::vector<double>& light, const std::vector<double>& drawn,
              const std::vector<double>& truth) {
    const double length =
        std::hypot(of.line.to[0] - of.line.from[0], of.line.to[1] - of.line.from[1], of.line.to[2] - of.line.from[2]);
    const double largest = *std::max_element(truth.begin(), truth.end());
    for (std::size_t i = 0; i < light.size(); ++i) {
        const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(light.size());
        table.add_row();
        table.set("line", of.line.name), table.set("scene", of.scene), table.set("parameter", of.parameter);
        table.set("row", of.row), table.set("setting", of.setting), table.set("s", field(share * length));
        table.set("irradiance", field(light[i])), table.set("interpolant", field(drawn[i]));
        table.set("error", field((light[i] - truth[i]) / largest));
        table.set("error_interpolant", field((drawn[i] - truth[i]) / largest));
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
                 "error_interpolant"},
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
                add_rows(table, {line, rows.scene, rows.parameter, "reference", "reference"}, truth, truth, truth);
            }
            const RadiosityFunction function(*solution);
            std::vector<double> light, drawn;
            for (const Light& l : function.at(points)) light.push_back(mean(l.irradiance));
            for (const Light& l : function.interpolant_at(points)) drawn.push_back(mean(l.irradiance));
            add_rows(table, rows, light, drawn, truth);
        }
    return table;
}

}  // namespace exitance
