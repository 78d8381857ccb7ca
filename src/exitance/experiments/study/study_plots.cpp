#include "exitance/experiments/study/study_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/child_process.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr double gnuplot_seconds = 60;
constexpr std::size_t most_marked = 60;  // points of a curve that are marked

struct PlotCurve {
    std::string name;
    std::vector<std::pair<double, double>> points;
};

/// Text in gnuplot's double quotes.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return out + "\"";
}

std::string file_name(const std::string& text) {
    std::string out;
    for (const char c : text) out += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' ? c : '_';
    return out;
}

bool is_log(const StudyPlot& plot, char axis) {
    return plot.log.find(axis) != std::string::npos;
}

/// The curves of a panel, in the order in which their names come; a curve's points by x, or as they come where
/// solutions on the way are among them.
std::vector<PlotCurve> curves_of(const Table& table, const StudyPlot& plot, const std::string& panel) {
    std::vector<PlotCurve> curves;
    for (const std::size_t row : chosen_rows(table, plot.where, !plot.checkpoints)) {
        if (!plot.panel.empty() && table.text(row, plot.panel) != panel) continue;
        const double x = table.number(row, plot.x), y = table.number(row, plot.y);
        const bool drawn =
            std::isfinite(x) && std::isfinite(y) && (!is_log(plot, 'x') || x > 0) && (!is_log(plot, 'y') || y > 0);
        if (!drawn) continue;
        const std::string& name = table.text(row, plot.series);
        auto at = std::find_if(curves.begin(), curves.end(), [&](const PlotCurve& c) { return c.name == name; });
        if (at == curves.end()) at = curves.insert(at, {name, {}});
        at->points.emplace_back(x, y);
    }
    if (!plot.checkpoints)
        for (PlotCurve& curve : curves) std::stable_sort(curve.points.begin(), curve.points.end());
    return curves;
}

std::vector<std::string> panels_of(const Table& table, const StudyPlot& plot) {
    if (plot.panel.empty()) return {""};
    std::vector<std::string> panels;
    for (const std::size_t row : chosen_rows(table, plot.where, !plot.checkpoints))
        if (const std::string& text = table.text(row, plot.panel);
            std::find(panels.begin(), panels.end(), text) == panels.end())
            panels.push_back(text);
    return panels;
}

std::string script(const StudyPlot& plot, const std::string& title, const std::vector<PlotCurve>& curves,
                   const std::string& stem) {
    std::string text = "set encoding utf8\n";
    for (std::size_t i = 0; i < curves.size(); ++i) {
        text += fmt::format("$curve{} << END\n", i);
        for (const auto& [x, y] : curves[i].points) text += fmt::format("{:.9g} {:.9g}\n", x, y);
        text += "END\n";
    }
    text += fmt::format("set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n", quoted(title),
                        quoted(plot.x_label), quoted(plot.y_label));
    text += "set key outside right top noenhanced\nset grid back lc rgb '#dddddd' lt 1\nset border lc rgb '#555555'\n";
    text += "set tics nomirror\nset offsets graph 0.03, graph 0.03, graph 0.03, graph 0.03\n";
    for (const char axis : {'x', 'y'})
        if (is_log(plot, axis)) text += fmt::format("set logscale {}\nset format {} '%g'\n", axis, axis);
    // Colours that people who see few of them tell apart [Okabe08].
    constexpr std::array colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
    std::string draw = "plot ";
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const std::string marks =
            curves[i].points.size() > most_marked ? "lines" : fmt::format("linespoints ps 0.7 pt {}", 4 + i % 11);
        draw +=
            fmt::format("{}$curve{} using 1:2 with {} lw 1.6 dt {} lc rgb '{}' title {}", i > 0 ? ", \\\n     " : "", i,
                        marks, 1 + i / colours.size() % 4, colours[i % colours.size()], quoted(curves[i].name));
    }
    text += "set terminal svg size 820,480 font 'sans-serif,13' background '#ffffff'\n";
    text += fmt::format("set output {}\n{}\n", quoted(stem + ".svg"), draw);
    text += "set terminal pngcairo size 820,480 font 'sans-serif,10'\n";
    text += fmt::format("set output {}\nreplot\n", quoted(stem + ".png"));
    return text;
}

}  // namespace

Result<std::vector<DrawnPlot>> draw_plots(const Study& study, const StudyTables& tables, const std::string& folder,
                                          const StopRequest& stop) {
    std::vector<DrawnPlot> drawn;
    if (study.plots.empty()) return drawn;
    if (!is_program("gnuplot"))
        return Error{ErrorCode::failure, "gnuplot is not installed", "plots", "it is in Debian's package gnuplot-nox"};
    const fs::path plots = fs::path(folder) / "plots";
    std::error_code failed;
    fs::create_directories(plots, failed);
    for (const StudyPlot& plot : study.plots) {
        const auto table = tables.find(plot.table);
        if (table == tables.end()) continue;
        for (const std::string& panel : panels_of(table->second, plot)) {
            const std::vector<PlotCurve> curves = curves_of(table->second, plot, panel);
            if (curves.empty() || stop.requested()) continue;
            const std::string name = panel.empty() ? plot.name : plot.name + "_" + file_name(panel);
            const std::string title = panel.empty() ? plot.title : fmt::format("{}: {}", plot.title, panel);
            const std::string gp = (plots / (name + ".gp")).string();
            if (const Result<void> written = write_file(gp, script(plot, title, curves, name)); !written)
                return written.error();
            const ProgramRun run = run_program({"gnuplot", name + ".gp"}, plots.string(), gnuplot_seconds, stop);
            if (run.status != 0 && !stop.requested())
                return Error{ErrorCode::failure, "gnuplot fails: " + run.err.substr(0, 300), gp, ""};
            drawn.push_back({&plot, panel, (plots / (name + ".svg")).string(), (plots / (name + ".png")).string()});
        }
    }
    return drawn;
}

}  // namespace exitance
