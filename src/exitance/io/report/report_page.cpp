#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <span>
#include <utility>

#include "exitance/base/distinct_numbers.hpp"
#include "exitance/base/version.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/report/report_figures.hpp"
#include "exitance/io/report/requirements.hpp"

namespace exitance {
namespace {

constexpr const char* style = R"css(
:root { color-scheme: light; }
body { font: 15px/1.5 system-ui, sans-serif; color: #1b1b1f; background: #fff; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.7rem; margin-bottom: .2rem; } h2 { font-size: 1.25rem; margin-top: 2.2rem; border-bottom: 1px solid #ccc; }
img, canvas, svg.plan { width: 100%; height: auto; display: block; } img, canvas { background: #141418; } svg.plan { background: #d8d8dc; }
figure { margin: 1rem 0; break-inside: avoid; } figcaption, .note { color: #555; font-size: .85rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .85rem; margin: .6rem 0; }
th, td { padding: .15rem .7rem .15rem 0; text-align: right; vertical-align: top; border-bottom: 1px solid #eee; }
th { border-bottom: 1px solid #999; } td.text, th.text { text-align: left; } td.text { overflow-wrap: anywhere; min-width: 5.5em; } td.label { min-width: 0; font-weight: bold; } td.name { white-space: nowrap; }
.facts td { text-align: left; overflow-wrap: anywhere; } .facts td:first-child { color: #555; white-space: nowrap; }
.polar { width: 5.2rem; display: block; } .schedule td { vertical-align: middle; } .schedule td.text.product { min-width: 9em; } .total td { font-weight: bold; border-top: 1px solid #999; }
svg.layout { width: 100%; height: auto; display: block; background: #f4f4f6; } .layout .cut { fill: none; stroke: #222; stroke-width: 1.4; } .layout .lamp { fill: #ffd45e; stroke: #7a5200; stroke-width: 1; }
.layout text { font: bold 12px sans-serif; text-anchor: middle; fill: #101014; paint-order: stroke; stroke: #fff; stroke-width: 2.5px; }
.reached, .missed, .unknown { white-space: nowrap; }
.reached { color: #0a6b2d; } .missed { color: #a4161a; font-weight: bold; } .unknown { color: #777; }
.warning { border-left: .3rem solid #c77700; padding-left: .6rem; margin: .3rem 0; }
.legend { font-size: .85rem; } .legend span { white-space: nowrap; margin-right: .8rem; }
.legend i { display: inline-block; width: 1rem; height: .8rem; margin-right: .3rem; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
.plan .line { fill: none; stroke: #fff; stroke-width: 1.5; } .plan text { font: var(--size) sans-serif; text-anchor: middle; fill: #fff; paint-order: stroke; stroke: #000; stroke-width: 2px; }
.plan .below { fill: none; stroke: #fff; stroke-opacity: .45; stroke-width: .7; } .plan .cut { fill: none; stroke: #000; stroke-width: 2.5; } .plan .level { font-weight: bold; font-style: italic; }
.wide { overflow-x: auto; } details { margin: .6rem 0; }
@page { size: A4; margin: 18mm 16mm; }
@media print { #surfaces, #walk, details { display: none; } body { margin: 0; max-width: none; font-size: 10.5pt; } canvas, .viewer { display: none; } .wide { overflow: visible; } h2, h3 { break-after: avoid; } tr { break-inside: avoid; } thead { display: table-header-group; } a { color: inherit; } }
)css";

std::string percent(double share) {
    return fmt::format("{:.3g}%", 100 * share);
}

std::string fact(const std::string& name, const std::string& value) {
    return "<tr><td>" + name + "</td><td>" + value + "</td></tr>\n";
}

std::string section(const char* id, const std::string& title, const std::string& body) {
    return body.empty() ? "" : fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, title, body);
}

std::string overview(const ReportContent& content, const ReportFigures& figures) {
    const Scene& scene = content.solution->scene;
    const SolveStatistics& s = content.solution->statistics;
    const Vec3 size = scene.box().size();
    std::string rows = fact("Scene", escaped(scene.file()));
    rows += fact("Size", fmt::format("{} x {} x {} m, {} m² in {} surfaces", figure(size.x), figure(size.y),
                                     figure(size.z), figure(figures.area), scene.surfaces().size()));
    rows += fact("Light", fmt::format("{} emitting surfaces, {} lights without extent", scene.emitters().size(),
                                      scene.lights().size()));
    rows += fact("Error", s.relative_error_estimate
                              ? fmt::format("{} (relative RMS, estimated)", percent(*s.relative_error_estimate))
                              : "not known");
    rows += fact("Numbers", content.unit.is_lux() ? "illuminance in lx, radiosity in lm/m²"
                                                  : "irradiance and radiosity in W/m² (means of the bands)");
    return "<table class=\"facts\">\n" + rows + "</table>\n";
}

/// Facts of the first page that the user gave.
std::string heading(const ReportHeading& h) {
    std::string rows;
    const std::array<std::pair<const char*, const std::string*>, 4> lines{
        {{"Project", &h.project}, {"Client", &h.client}, {"Author", &h.author}, {"Date", &h.date}}};
    for (const auto& [name, text] : lines)
        if (!text->empty()) rows += fact(name, escaped(*text));
    return rows.empty() ? "" : "<table class=\"facts\">\n" + rows + "</table>\n";
}

/// Words and symbol of a required quantity.
std::string name_of_quantity(const std::string& symbol) {
    static const std::map<std::string, std::string> words{
        {"Em", "Mean illuminance <i>E</i><sub>m</sub>"},        {"U0", "Uniformity <i>U</i><sub>0</sub>"},
        {"Ez", "Cylindrical illuminance <i>E</i><sub>z</sub>"}, {"UGR", "Glare UGR"},
        {"Ra", "Colour rendering <i>R</i><sub>a</sub>"},        {"walls", "Mean illuminance of walls"},
        {"ceiling", "Mean illuminance of the ceiling"}};
    const auto at = words.find(symbol);
    return at == words.end() ? escaped(symbol) : at->second;
}

/// Required and measured numbers with verdicts.
std::string requirements(const ReportContent& content, const ReportFigures& figures) {
    const std::vector<Judgement> judged = judge(content, figures);
    if (judged.empty()) return "";
    std::string html =
        "<table>\n<thead><tr><th class=\"text\">Where</th><th class=\"text\">Task</th><th class=\"text\">Quantity</th>"
        "<th>Required</th><th>Reached</th><th class=\"text\">Verdict</th></tr></thead>\n";
    for (const Judgement& j : judged) {
        const bool is_light = j.quantity != "U0" && j.quantity != "UGR" && j.quantity != "Ra";
        const std::string unit = is_light ? std::string(" ") + symbol(content.unit) : "";
        html += fmt::format(
            "<tr><td class=\"text\">{}</td><td class=\"text\">{}</td><td class=\"text\">{}</td><td>{} {}{}</td>"
            "<td>{}</td><td class=\"text {}\">{}</td></tr>\n",
            escaped(j.where), escaped(j.task), name_of_quantity(j.quantity),
            j.quantity == "UGR" ? "at most" : "at least", j.required, unit,
            j.verdict == Fulfilment::not_measured ? "-" : distinct_texts(j.reached, j.required).first + unit,
            j.verdict == Fulfilment::missed         ? "missed"
            : j.verdict == Fulfilment::not_measured ? "unknown"
                                                    : "reached",
            words_of(j.verdict));
    }
    return html +
           "</table>\n<p class=\"note\">\"Reached within the error\": the number misses the requirement by less than "
           "the estimated error of the light. \"Not measured\": the quantity does not follow from the solution, such "
           "as "
           "colour rendering, or no plane or observer was asked for.</p>\n";
}

std::string rooms_part(const ReportContent& content) {
    const FloorRooms& rooms = content.rooms;
    if (rooms.count() == 0) return "";
    std::string html =
        "<table>\n<thead><tr><th class=\"text\">Room</th><th>Floor m²</th><th>Height m</th></tr></thead>\n";
    for (std::size_t i = 0; i < rooms.count(); ++i)
        html += fmt::format("<tr><td class=\"text\">{}</td><td>{}</td><td>{}</td></tr>\n", escaped(rooms.label(i)),
                            short_figure(rooms[i].area), short_figure(rooms[i].height));
    return html + "</table>\n";
}

std::string unfinished(const ReportContent& content) {
    if (content.unfinished.empty()) return "";
    std::string parts;
    for (const std::string& part : content.unfinished) parts += (parts.empty() ? "" : ", ") + escaped(part);
    return "<p class=\"warning\">The report was stopped by a limit. These parts are not finished and left out: " +
           parts + ".</p>\n";
}

Result<std::string> pictures(const ReportContent& content) {
    std::string html;
    for (const ReportPicture& picture : content.pictures) {
        const Result<std::string> address = data_address(picture.image);
        if (!address) return address.error();
        html += fmt::format(
            "<figure><img src=\"{}\" alt=\"{}\" width=\"{}\" height=\"{}\"><figcaption>{}</figcaption></figure>\n",
            *address, escaped(picture.caption), picture.image.width, picture.image.height, escaped(picture.caption));
    }
    return html;
}

/// An error with one significant digit, without exponents.
std::string one_digit(double error) {
    if (!(error > 0)) return "0";
    const double unit = std::pow(10, std::floor(std::log10(error)));
    return fmt::format("{:.6g}", std::round(error / unit) * unit);
}

std::string point_words(const Vec3& p) {
    return fmt::format("({:.3g}, {:.3g}, {:.3g})", p.x, p.y, p.z);
}

std::string grid_table(const ReportFigures::Grid& grid) {
    const GridLight& light = *grid.light;
    std::string html = "<details><summary>All points</summary><div class=\"wide\"><table>\n";
    for (int row = light.rows - 1; row >= 0; --row) {
        html += "<tr>";
        for (int column = 0; column < light.columns; ++column) {
            const auto i = static_cast<std::size_t>(row * light.columns + column);
            html += "<td>" + (light.is_open[i] ? figure(grid.values[i]) : std::string("-")) + "</td>";
        }
        html += "</tr>\n";
    }
    return html + "</table></div></details>\n";
}

std::string grids(const ReportContent& content, const ReportFigures& figures) {
    std::string html;
    for (std::size_t i = 0; i < figures.grids.size(); ++i) {
        const ReportFigures::Grid& grid = figures.grids[i];
        const GridLight& light = *grid.light;
        html += fmt::format("<h3>Plane {}{}</h3>\n<table class=\"facts\">\n", i + 1,
                            light.name.empty() ? "" : ": " + escaped(light.name));
        html +=
            fact("Where", fmt::format("from {} along {} and {} m, seen from {}", point_words(light.plane.origin),
                                      point_words(light.plane.u), point_words(light.plane.v), point_words(light.n)));
        html += fact(
            "Points",
            fmt::format(
                "{} x {}, {} and {} m apart, {} m from the edges{}", light.columns, light.rows,
                short_figure(light.step_u), short_figure(light.step_v), short_figure(light.plane.margin),
                grid.hidden > 0 ? fmt::format("; {} of them below or within something, left out", grid.hidden) : ""));
        const char* unit = symbol(content.unit);
        const double error = content.solution->statistics.relative_error_estimate.value_or(0);
        html +=
            fact(light.is_cylindrical ? "Mean E<sub>z</sub>" : "Mean E<sub>m</sub>",
                 fmt::format(
                     "{} ± {} {}{}", short_figure(grid.levels.mean), one_digit(error * grid.levels.mean), unit,
                     content.maintenance < 1 ? fmt::format(" (maintained: factor {:.3g})", content.maintenance) : ""));
        html += fact("Minimum", short_figure(grid.levels.least) + " " + unit);
        html += fact("Maximum", short_figure(grid.levels.most) + " " + unit);
        html += fact("Uniformity U<sub>0</sub>", fmt::format("{:.2f} (minimum / mean)", grid.levels.uniformity()));
        html += fact("Diversity U<sub>d</sub>", fmt::format("{:.2f} (minimum / maximum)", grid.levels.diversity()));
        html += "</table>\n<figure>" + grid_plan(grid, content.unit, content.solution->scene) +
                "<figcaption>Values at the points, lines of equal light (italic), and what the plane cuts "
                "(black).</figcaption></figure>\n" +
                grid_table(grid);
    }
    return html;
}

std::string materials(const ReportContent& content, const ReportFigures& figures) {
    std::string html = fmt::format(
        "<div class=\"wide\"><table>\n<thead><tr><th class=\"text\">Material</th><th>Reflectance R, G, "
        "B</th><th>Radiance R, "
        "G, B</th><th>Surfaces</th><th>Area m²</th><th>Mean irradiance {}</th></tr></thead>\n",
        symbol(content.unit));
    for (const ReportFigures::MaterialUse& m : figures.materials)
        html += fmt::format(
            "<tr><td class=\"text\">{}</td><td>{} {} {}</td><td>{} {} {}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            escaped(m.name), figure(m.reflectance[0]), figure(m.reflectance[1]), figure(m.reflectance[2]),
            short_figure(m.radiance[0]), short_figure(m.radiance[1]), short_figure(m.radiance[2]), m.faces,
            short_figure(m.area), short_figure(m.irradiance));
    return html + "</table></div>\n";
}

std::string surfaces(const ReportContent& content, const ReportFigures& figures) {
    std::string html = fmt::format(
        "<div class=\"wide\"><table>\n<thead><tr><th>Surface</th><th>Line</th><th class=\"text\">Group</th><th "
        "class=\"text\""
        ">Material</th><th>Area m²</th><th>Mean "
        "{0}</th><th>Minimum</th><th>Maximum</th><th>Uniformity</th><th>Radiosity "
        "{0}</th></tr></thead>\n",
        symbol(content.unit));
    constexpr std::size_t max_rows = 20;  // derived from the rows that fill half a page
    for (const ReportFigures::Face& face : std::span(figures.faces).first(std::min(max_rows, figures.faces.size()))) {
        const Levels& l = face.irradiance;
        const std::string light =
            l.count == 0 ? "<td colspan=\"5\" class=\"text\">covered</td>"
                         : fmt::format("<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>", figure(l.mean),
                                       figure(l.least), figure(l.most), figure(l.uniformity()), figure(face.radiosity));
        html += fmt::format(
            "<tr><td>{}</td><td>{}</td><td class=\"text\">{}</td><td class=\"text\">{}</td><td>{}</td>{}</tr>\n",
            face.surface.value, face.line, escaped(face.group), escaped(face.material), figure(face.area), light);
    }
    html +=
        "</table></div>\n<p class=\"note\">Light of the full function at 16 to 1024 points of a surface, those that "
        "lie "
        "in the open. Uniformity is the minimum over the mean.</p>\n";
    const std::size_t others = figures.faces.size() - std::min(max_rows, figures.faces.size());
    if (others + content.surfaces_left_out > 0)
        html += fmt::format("<p class=\"note\">{} smaller surfaces are not listed.</p>\n",
                            others + content.surfaces_left_out);
    return html;
}

std::string error_part(const ReportContent& content) {
    const SolveStatistics& s = content.solution->statistics;
    const auto known = [](const std::optional<double>& error) { return error ? percent(*error) : "not known"; };
    std::string rows =
        fact("Estimate", known(s.relative_error_estimate) + " of the light, relative RMS over all surfaces");
    rows += fact("Bound", known(s.relative_error_bound) + " at most, at 95% confidence");
    rows += fact("Of what export writes", known(s.relative_error_estimate_interpolant));
    if (content.error.points > 0)
        rows +=
            fact("99th percentile",
                 fmt::format("{} of the mean irradiance: at 99 of 100 places it is off by less (median {}; {} places "
                             "checked by rays of their own, whose noise of {} is part of these figures)",
                             percent(content.error.p99), percent(content.error.median), content.error.points,
                             percent(content.error.noise)));
    return "<table class=\"facts\">\n" + rows + "</table>\n";
}

std::string energy_part(const EnergyBalance& energy, const LightUnit& own) {
    const auto power = [&](double value) {
        return fmt::format("{} {}{}", figure(value), own.power(), own.is_lux() ? "" : " (mean of the bands)");
    };
    std::string rows = fact("Emitted", power(energy.emitted)) + fact("Absorbed", power(energy.absorbed));
    if (energy.escaped > 0) rows += fact("Escaped", power(energy.escaped) + ", where the scene is open");
    rows += fact("Difference", percent(energy.defect) + " of the emitted power");
    return "<table class=\"facts\">\n" + rows + "</table>\n";
}

std::string method_part(const ReportContent& content) {
    const SolveStatistics& s = content.solution->statistics;
    std::string rows = fact("Method", escaped(s.basis.empty() ? s.method : s.method + ", " + s.basis + " basis"));
    rows += fact("Reached", s.converged
                                ? "yes"
                                : "no" + (s.is_stopped() ? fmt::format(", stopped by {}", name_of(s.stopped_by)) : ""));
    rows += fact("Elements", fmt::format("{}, {} of them leaves", s.elements, s.leaf_elements));
    rows += fact("Transport", fmt::format("{} links, {} form factors, {} rays", s.links, s.form_factors, s.rays));
    rows += fact("Solution", fmt::format("{} iterations, residual {:.2g}", s.iterations, s.residual));
    std::string parts;
    RunSeconds::for_parts([&](RunPart part) {
        if (part == RunPart::total || !(s.seconds[part] > 0)) return;
        parts += fmt::format("{}{} {:.3g}", parts.empty() ? "" : ", ", RunSeconds::name(part), s.seconds[part]);
    });
    rows += fact("Time", fmt::format("{:.3g} s on {} threads ({})", s.seconds[RunPart::total], s.threads, parts));
    rows += fact("Memory", fmt::format("{:.3g} MB at most", static_cast<double>(s.peak_memory_bytes) / 1e6));
    return "<table class=\"facts\">\n" + rows + "</table>\n";
}

std::string warnings(const SolveStatistics& s) {
    std::string html;
    for (const std::string& warning : s.warnings) html += "<p class=\"warning\">" + escaped(warning) + "</p>\n";
    return html.empty() ? "<p>None.</p>\n" : html;
}

/// Escapes JSON for an HTML element, so that it cannot contain a closing tag.
std::string embedded(std::string json) {
    for (std::size_t at = 0; (at = json.find("</", at)) != std::string::npos; at += 3) json.replace(at, 2, "<\\/");
    return json;
}

/// Parts of the page by name, in their own order or in that of `names`. The part without a name comes first then.
std::string in_order(const std::vector<std::pair<std::string, std::string>>& parts,
                     const std::vector<std::string>& names) {
    std::string html;
    for (const auto& [name, part] : parts)
        if (names.empty() || name.empty()) html += part;
    for (const std::string& name : names)
        for (const auto& [other, part] : parts)
            if (other == name) html += part;
    return html;
}

}  // namespace

Result<void> write_report(const ReportContent& content, const std::string& path) {
    const ReportFigures figures = find_figures(content);
    const Result<std::string> shown = pictures(content), viewer = report_viewer(content);
    if (!shown) return shown.error();
    if (!viewer) return viewer.error();
    const std::string json = report_json(content, figures);
    const std::string name = std::filesystem::path(content.solution->scene.file()).filename().string();
    const std::string title = content.heading.title.empty() ? "Light in " + name : content.heading.title;
    const SolveStatistics& s = content.solution->statistics;
    const std::vector<std::pair<std::string, std::string>> parts{
        {"requirements", section("requirements", "Requirements", requirements(content, figures))},
        {"", overview(content, figures) + unfinished(content)},
        {"rooms", section("rooms", "Rooms", rooms_part(content))},
        {"luminaires", section("luminaires", "Luminaires", schedule_html(content, figures.luminaires))},
        {"pictures", section("pictures", "Pictures", *shown)},
        {"walk", viewer->empty() ? "" : "<div class=\"viewer\">" + section("walk", "Look around", *viewer) + "</div>"},
        {"grids", section("grids", "Measuring planes", grids(content, figures))},
        {"glare", section("glare", "Glare", observers_html(content))},
        {"materials", section("materials", "Materials", materials(content, figures))},
        {"surfaces", section("surfaces", "Surfaces", surfaces(content, figures))},
        {"energy", section("energy", "Energy balance",
                           energy_part(s.energy, own_unit(content.solution->scene.is_photometric())))},
        {"error", section("error", "Error", error_part(content))},
        {"method", section("method", "Method and what it took", method_part(content))},
        {"warnings", section("warnings", "Warnings", warnings(s))}};
    std::string page =
        fmt::format(
            "<!doctype html>\n<html lang=\"{2}\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
            "content=\"width=device-width\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n"
            "<h1>{0}</h1>\n",
            escaped(title), style, escaped(content.words.language())) +
        heading(content.heading) + in_order(parts, content.words.sections()) +
        fmt::format("<p class=\"note\">Made by exitance {}.</p>\n", program_version);
    if (content.words.translates()) page = content.words.page(page);
    page += "<script type=\"application/json\" id=\"numbers\">\n" + embedded(json) + "</script>\n</body>\n</html>\n";
    const std::string twin = std::filesystem::path(path).replace_extension(".json").string();
    if (const Result<void> written = write_file(twin, json); !written) return written;
    return write_file(path, page);
}

}  // namespace exitance
