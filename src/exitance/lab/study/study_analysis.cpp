#include "exitance/lab/study/study_analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "exitance/lab/study/study_run.hpp"

namespace exitance {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

struct Curve {
    std::vector<double> x, y;
};

/// y over x of the selected rows, sorted by x; values that are no numbers are omitted.
Curve curve_of(const Table& table, const std::string& x, const std::string& y, const RowFilter& where) {
    std::vector<std::pair<double, double>> points;
    for (const std::size_t row : measured_rows(table, where, true)) {
        const double at = x.empty() ? 0 : table.number(row, x), value = table.number(row, y);
        if (std::isfinite(at) && std::isfinite(value)) points.emplace_back(at, value);
    }
    std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    Curve curve;
    for (const auto& [at, value] : points) curve.x.push_back(at), curve.y.push_back(value);
    return curve;
}

/// Last x at which two curves cross, with both linear between the x that they share.
double crossing(const Curve& a, const Curve& b) {
    double found = unknown, last_x = 0, last = unknown;
    for (std::size_t i = 0; i < a.x.size(); ++i) {
        const auto at = std::find(b.x.begin(), b.x.end(), a.x[i]);
        if (at == b.x.end()) continue;
        const double gap = a.y[i] - b.y[static_cast<std::size_t>(at - b.x.begin())];
        if (std::isfinite(last) && (gap > 0) != (last > 0)) found = last_x + (a.x[i] - last_x) * last / (last - gap);
        last = gap, last_x = a.x[i];
    }
    return found;
}

/// Geometric mean of the ratio of y to that of the other rows with the same scene and parameter; only at the largest x
/// if `last`.
double mean_ratio(const Table& table, const StudyConclusion& c, bool last) {
    const std::vector<std::size_t> others = measured_rows(table, c.against, true);
    std::vector<std::pair<double, double>> ratios;  // by x
    for (const std::size_t row : measured_rows(table, c.where, true))
        for (const std::size_t other : others) {
            const bool same_x = c.x.empty() || table.text(row, c.x) == table.text(other, c.x);
            if (table.text(row, "scene") != table.text(other, "scene") ||
                table.text(row, "parameter") != table.text(other, "parameter") || !same_x)
                continue;
            const double ratio = table.number(row, c.y) / table.number(other, c.y);
            if (ratio > 0 && std::isfinite(ratio)) ratios.emplace_back(c.x.empty() ? 0 : table.number(row, c.x), ratio);
        }
    if (ratios.empty()) return unknown;
    const double largest = std::max_element(ratios.begin(), ratios.end())->first;
    double sum = 0;
    std::size_t count = 0;
    for (const auto& [x, ratio] : ratios)
        if (!last || x == largest) sum += std::log(ratio), ++count;
    return std::exp(sum / static_cast<double>(count));
}

double measured(const Table& table, const StudyConclusion& c) {
    if (c.measure == Measure::ratio || c.measure == Measure::last_ratio)  // x may be text
        return mean_ratio(table, c, c.measure == Measure::last_ratio);
    const Curve curve = curve_of(table, c.x, c.y, c.where);
    if (curve.y.empty()) return unknown;
    switch (c.measure) {
        case Measure::value: {
            double sum = 0;
            for (double y : curve.y) sum += y;
            return sum / static_cast<double>(curve.y.size());
        }
        case Measure::largest:
            return *std::max_element(curve.y.begin(), curve.y.end());
        case Measure::last:
            return curve.y.back();
        case Measure::slope:
            return fit_power(curve.x, curve.y);
        case Measure::ratio:
        case Measure::last_ratio:
            break;
        case Measure::crossing:
            return crossing(curve, curve_of(table, c.x, c.y, c.against));
        case Measure::quadratic_misfit:
            return fit_quadratic(curve.x, curve.y).misfit;
    }
    return unknown;
}

std::string range_text(const StudyConclusion& c) {
    if (std::isfinite(c.least) && std::isfinite(c.most)) return fmt::format("{:g} to {:g}", c.least, c.most);
    if (std::isfinite(c.least)) return fmt::format("at least {:g}", c.least);
    return std::isfinite(c.most) ? fmt::format("at most {:g}", c.most) : "any";
}

/// A row's time until its final solution, and its errors up to then.
struct History {
    std::string row, setting, method, basis;
    std::vector<std::pair<double, double>> steps;  ///< Logarithms of seconds and of errors.
    double end = 0;                                ///< Seconds.
    bool done = false;
};

double error_at(const History& history, double seconds) {
    const double at = std::log(seconds);
    const auto& steps = history.steps;
    if (steps.empty() || at < steps.front().first) return unknown;
    for (std::size_t i = 1; i < steps.size(); ++i)
        if (at <= steps[i].first) {
            const double span = steps[i].first - steps[i - 1].first;
            const double share = span > 0 ? (at - steps[i - 1].first) / span : 1;
            return std::exp((1 - share) * steps[i - 1].second + share * steps[i].second);
        }
    return std::exp(steps.back().second);
}

}  // namespace

std::vector<std::size_t> chosen_rows(const Table& table, const RowFilter& where, bool last_only) {
    std::vector<std::size_t> rows;
    const bool has_last = last_only && table.has("is_last");
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        if (has_last && table.text(row, "is_last") == "0") continue;
        const bool fits = std::all_of(where.begin(), where.end(), [&](const auto& entry) {
            return std::find(entry.second.begin(), entry.second.end(), table.text(row, entry.first)) !=
                   entry.second.end();
        });
        if (fits) rows.push_back(row);
    }
    return rows;
}

std::vector<std::size_t> measured_rows(const Table& table, const RowFilter& where, bool last_only) {
    std::vector<std::size_t> rows = chosen_rows(table, where, last_only);
    if (!table.has("status")) return rows;
    std::erase_if(rows, [&](std::size_t row) {
        const std::string& status = table.text(row, "status");
        return status.starts_with("time limit") || status.starts_with("memory limit") ||
               status.starts_with("not run") || status.starts_with("failed");
    });
    return rows;
}

std::vector<Verdict> judge(const Study& study, const StudyTables& tables, bool quick) {
    std::vector<Verdict> verdicts;
    for (const StudyConclusion& c : study.conclusions) {
        Verdict verdict;
        verdict.conclusion = &c;
        if (const auto table = tables.find(c.table); table != tables.end()) verdict.value = measured(table->second, c);
        if (std::isfinite(verdict.value)) {
            const bool holds = verdict.value >= c.least && verdict.value <= c.most;
            verdict.holds = quick ? Verdict::Holds::not_judged : holds ? Verdict::Holds::yes : Verdict::Holds::no;
            verdict.detail = fmt::format("{:.4g} ({})", verdict.value, range_text(c));
        }
        verdicts.push_back(std::move(verdict));
    }
    return verdicts;
}

QuadraticFit fit_quadratic(const std::vector<double>& x, const std::vector<double>& y) {
    // Residuals are weighted by 1 / y: 1 = sigma x^2 / y + beta x / y.
    double aa = 0, ab = 0, bb = 0, a1 = 0, b1 = 0;
    std::size_t n = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!(y[i] > 0)) continue;
        const double a = x[i] * x[i] / y[i], b = x[i] / y[i];
        aa += a * a, ab += a * b, bb += b * b, a1 += a, b1 += b, ++n;
    }
    QuadraticFit fit;
    const double det = aa * bb - ab * ab;
    if (n < 2 || !(std::abs(det) > 1e-12 * aa * bb)) return {unknown, unknown, unknown};
    fit.sigma = (a1 * bb - b1 * ab) / det, fit.beta = (b1 * aa - a1 * ab) / det;
    for (std::size_t i = 0; i < x.size(); ++i)
        if (y[i] > 0) fit.misfit += std::pow((fit.sigma * x[i] * x[i] + fit.beta * x[i]) / y[i] - 1, 2);
    fit.misfit = std::sqrt(fit.misfit / static_cast<double>(n));
    return fit;
}

double fit_power(const std::vector<double>& x, const std::vector<double>& y) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!(x[i] > 0) || !(y[i] > 0)) continue;
        const double a = std::log(x[i]), b = std::log(y[i]);
        n += 1, sx += a, sy += b, sxx += a * a, sxy += a * b;
    }
    const double det = n * sxx - sx * sx;
    return n >= 2 && det > 1e-9 ? (n * sxy - sx * sy) / det : unknown;
}

Table equal_time_table(const Study& study, const Table& results) {
    std::map<std::pair<std::string, std::string>, std::vector<History>> by_scene;
    std::vector<std::pair<std::string, std::string>> order;
    const auto takes_part = [&](const std::string& label) {
        const auto row =
            std::find_if(study.rows.begin(), study.rows.end(), [&](const auto& r) { return r.label == label; });
        return row == study.rows.end() || row->equal_time;
    };
    for (std::size_t row = 0; row < results.rows.size(); ++row) {
        if (!takes_part(results.text(row, "row"))) continue;
        const std::pair key(results.text(row, "scene"), results.text(row, "parameter"));
        if (!by_scene.contains(key)) order.push_back(key);
        std::vector<History>& histories = by_scene[key];
        const std::string& setting = results.text(row, "setting");
        auto at = std::find_if(histories.begin(), histories.end(),
                               [&](const History& history) { return history.setting == setting; });
        if (at == histories.end())
            at = histories.insert(
                at, {results.text(row, "row"), setting, results.text(row, "method"), results.text(row, "basis"), {}});
        const double seconds = results.number(row, "processor_seconds"),
                     error = results.number(row, "relative_rms_error");
        if (seconds > 0 && error > 0) at->steps.emplace_back(std::log(seconds), std::log(error));
        if (results.text(row, "is_last") == "1") at->end = seconds, at->done = results.text(row, "status") == "done";
    }
    Table out{{"study", "scene", "parameter", "row", "setting", "method", "basis", "seconds", "relative_rms_error"},
              {}};
    for (const auto& key : order) {
        double common = std::numeric_limits<double>::infinity();
        for (const History& history : by_scene[key])
            if (history.done && history.end > 0) common = std::min(common, history.end);
        if (!std::isfinite(common)) continue;
        for (const History& history : by_scene[key]) {
            out.add_row();
            out.set("study", results.text(0, "study")), out.set("scene", key.first), out.set("parameter", key.second);
            out.set("row", history.row), out.set("setting", history.setting), out.set("method", history.method);
            out.set("basis", history.basis), out.set("seconds", field(common));
            out.set("relative_rms_error", field(error_at(history, common)));
        }
    }
    return out;
}

}  // namespace exitance
