#include "exitance/lab/study/study_plots.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/child_process.hpp"
#include "exitance/lab/study/study_analysis.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr double gnuplot_seconds = 60;
constexpr std::size_t max_marked = 60;    // curves with more points get no markers
constexpr double room_for_labels = 0.08;  // share of the range of the data

struct PlotCurve {
    std::string name;
    std::vector<std::pair<double, double>> points;
};

/// A text above the points of one x.
struct PlotLabel {
    double x = 0, y = 0;
    std::string text;
};

/// Replaces points of equal x by their mean: geometric if y has a logarithmic axis.
void take_means(std::vector<std::pair<double, double>>& points, bool log) {
    std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::pair<double, double>> means;
    for (std::size_t i = 0; i < points.size();) {
        std::size_t end = i;
        double sum = 0;
        for (; end < points.size() && points[end].first == points[i].first; ++end)
            sum += log ? std::log(points[end].second) : points[end].second;
        const double mean = sum / static_cast<double>(end - i);
        means.emplace_back(points[i].first, log ? std::exp(mean) : mean);
        i = end;
    }
    points = std::move(means);
}

/// Quotes text for gnuplot.
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

/// Returns the curves of a panel, in the order in which their names occur. Points are averaged and sorted by x, but
/// keep their order if intermediate solutions are included.
std::vector<PlotCurve> curves_of(const Table& table, const StudyPlot& plot, const std::string& panel) {
    std::vector<PlotCurve> curves;
    for (const std::size_t row : measured_rows(table, plot.where, !plot.checkpoints)) {
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
        for (PlotCurve& curve : curves) take_means(curve.points, is_log(plot, 'y'));
    return curves;
}

/// Returns the values of the plot's column of labels for every x, placed above its highest point.
std::vector<PlotLabel> labels_of(const Table& table, const StudyPlot& plot, const std::string& panel) {
    std::vector<PlotLabel> labels;
    if (plot.labels.empty()) return labels;
    for (const std::size_t row : measured_rows(table, plot.where, !plot.checkpoints)) {
        const double x = table.number(row, plot.x), y = table.number(row, plot.y);
        const double value = table.number(row, plot.labels);
        if ((!plot.panel.empty() && table.text(row, plot.panel) != panel) || !(std::isfinite(x) && std::isfinite(y)))
            continue;
        auto at = std::find_if(labels.begin(), labels.end(), [&](const PlotLabel& label) { return label.x == x; });
        if (at == labels.end())
            at = labels.insert(at, {x, y, std::isfinite(value) ? fmt::format("{:.2g}", value) : ""});
        at->y = std::max(at->y, y);
    }
    return labels;
}

std::vector<std::string> panels_of(const Table& table, const StudyPlot& plot) {
    if (plot.panel.empty()) return {""};
    std::vector<std::string> panels;
    for (const std::size_t row : measured_rows(table, plot.where, !plot.checkpoints))
        if (const std::string& text = table.text(row, plot.panel);
            std::find(panels.begin(), panels.end(), text) == panels.end())
            panels.push_back(text);
    return panels;
}

struct Range {
    double lo = HUGE_VAL, hi = -HUGE_VAL;
};

Range range_of(char axis, const std::vector<PlotCurve>& curves) {
    Range range;
    for (const PlotCurve& curve : curves)
        for (const auto& [x, y] : curve.points)
            range = {std::min(range.lo, axis == 'x' ? x : y), std::max(range.hi, axis == 'x' ? x : y)};
    return range;
}

/// Range of a linear axis: the data and a margin, plus `room` above it for labels; not below zero if no value is.
std::string linear_axis(char axis, Range data, double room) {
    constexpr double margin = 0.04;
    const double span = data.hi > data.lo ? data.hi - data.lo : std::max(1.0, std::abs(data.hi));
    const double lo = data.lo - margin * span, hi = data.hi + (margin + room) * span;
    return fmt::format("set {}range [{:.6g}:{:.6g}]\n", axis, data.lo >= 0 ? std::max(0.0, lo) : lo, hi);
}

/// Range of a logarithmic axis. If it spans few powers of ten, digits between them are marked as well.
std::string log_axis(char axis, Range data, double room) {
    constexpr double share = 0.05, min_margin = 1.1, few = 100, fewest = 10;
    const double ratio = data.hi / data.lo, margin = std::max(min_margin, std::pow(ratio, share));
    const double lo = data.lo / margin, hi = data.hi * margin * std::pow(std::max(ratio, min_margin), room);
    std::string text =
        fmt::format("set logscale {0}\nset format {0} '%g'\nset {0}range [{1:.6g}:{2:.6g}]\n", axis, lo, hi);
    if (hi / lo > few) return text;
    const std::vector<double> digits =
        hi / lo > fewest ? std::vector<double>{1, 2, 5} : std::vector<double>{1, 1.5, 2, 3, 4, 5, 6, 8};
    std::vector<std::string> marks;
    for (double power = std::pow(10, std::floor(std::log10(lo))); power <= hi; power *= 10)
        for (const double digit : digits)
            if (digit * power >= lo && digit * power <= hi) marks.push_back(fmt::format("{:.6g}", digit * power));
    return text + fmt::format("set {}tics ({})\n", axis, fmt::join(marks, ", "));
}

/// Fitted law of a curve for the legend, if the plot requests it: x^exponent, or a x^2 + b x.
std::string law_of(const StudyPlot& plot, const PlotCurve& curve, std::string& drawn) {
    std::vector<double> x, y;
    for (const auto& [at, value] : curve.points) x.push_back(at), y.push_back(value);
    if (plot.fit == "power") {
        const double exponent = fit_power(x, y);
        return std::isfinite(exponent) ? fmt::format(": x^{:.2f}", exponent) : "";
    }
    if (plot.fit != "quadratic") return "";
    const QuadraticFit fit = fit_quadratic(x, y);
    if (!std::isfinite(fit.sigma)) return "";
    drawn = fmt::format("{:.9g} * x**2 + {:.9g} * x", fit.sigma, fit.beta);
    return fmt::format(": {:.2g} x^2 + {:.2g} x", fit.sigma, fit.beta);
}

std::string data_blocks(const std::vector<PlotCurve>& curves, const std::vector<PlotLabel>& labels) {
    std::string text;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        text += fmt::format("$curve{} << END\n", i);
        for (const auto& [x, y] : curves[i].points) text += fmt::format("{:.9g} {:.9g}\n", x, y);
        text += "END\n";
    }
    if (labels.empty()) return text;
    text += "$labels << END\n";
    for (const PlotLabel& label : labels)
        text += fmt::format("{:.9g} {:.9g} {}\n", label.x, label.y, quoted(label.text));
    return text + "END\n";
}

std::string script(const StudyPlot& plot, const std::string& title, const std::vector<PlotCurve>& curves,
                   const std::vector<PlotLabel>& labels, const std::string& stem) {
    std::string text = "set encoding utf8\n" + data_blocks(curves, labels);
    text += fmt::format("set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n", quoted(title),
                        quoted(plot.x_label), quoted(plot.y_label));
    text += "set key outside right top noenhanced\nset grid back lc rgb '#dddddd' lt 1\nset border lc rgb '#555555'\n";
    text += "set tics nomirror\n";
    for (const char axis : {'x', 'y'}) {
        const double room = axis == 'y' && !labels.empty() ? room_for_labels : 0;
        const Range data = range_of(axis, curves);
        text += is_log(plot, axis) ? log_axis(axis, data, room) : linear_axis(axis, data, room);
    }
    // Colours that are distinct with colour vision deficiencies [Okabe08].
    constexpr std::array colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const char* colour = colours[i % colours.size()];
        const std::string marks =
            curves[i].points.size() > max_marked ? "lines" : fmt::format("linespoints ps 0.7 pt {}", 4 + i % 11);
        std::string fitted;
        const std::string law = law_of(plot, curves[i], fitted);
        parts.push_back(fmt::format("$curve{} using 1:2 with {} lw 1.6 dt {} lc rgb '{}' title {}", i, marks,
                                    1 + i / colours.size() % 4, colour, quoted(curves[i].name + law)));
        if (!fitted.empty())
            parts.push_back(fmt::format("{} with lines lw 1 dt 3 lc rgb '{}' notitle", fitted, colour));
    }
    if (!labels.empty()) parts.push_back("$labels using 1:2:3 with labels offset 0,0.9 font ',9' notitle");
    const std::string draw = fmt::format("plot {}", fmt::join(parts, ", \\\n     "));
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
            const std::vector<PlotLabel> labels = labels_of(table->second, plot, panel);
            if (const Result<void> written = write_file(gp, script(plot, title, curves, labels, name)); !written)
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
