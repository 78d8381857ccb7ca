#include <fmt/format.h>

#include "exitance/base/words.hpp"
#include "exitance/io/photometry/polar_diagram.hpp"
#include "exitance/io/report/luminaire_schedule.hpp"
#include "exitance/io/report/report_figures.hpp"

namespace exitance {
namespace {

constexpr const char* unknown = "unknown";

std::string watts_or(double watts, const char* otherwise) {
    return watts > 0 ? short_figure(watts) : otherwise;
}

/// Formats a range of shares in percent: "100%", "50% to 100%".
std::string percent_range(const LuminaireSchedule::Range& range) {
    const std::string least = fmt::format("{:.0f}%", 100 * range.least),
                      most = fmt::format("{:.0f}%", 100 * range.most);
    return least == most ? least : fmt::format("{} to {}", least, most);
}

/// Formats a range of factors: "0.8", "0.8 to 0.9".
std::string factor_range(const LuminaireSchedule::Range& range) {
    const std::string least = fmt::format("{:.2g}", range.least), most = fmt::format("{:.2g}", range.most);
    return least == most ? least : fmt::format("{} to {}", least, most);
}

std::string types_table(const LuminaireSchedule& schedule) {
    if (schedule.types.empty()) return "";
    std::string html =
        "<table class=\"schedule\">\n<thead><tr><th class=\"text\">Type</th><th class=\"text\">Distribution</th><th "
        "class=\"text\">Luminaire</th><th>Number</th><th>Flux lm</th><th>Power W</th><th>lm/W</th><th>Total "
        "W</th><th>Output</th><th>Maintenance</th></tr></thead>\n";
    std::size_t count = 0;
    double watts = 0, flux = 0;
    bool is_known = true;
    for (const LuminaireSchedule::Type& type : schedule.types) {
        const LuminaireType& facts = *type.facts;
        const double number = static_cast<double>(type.count);
        count += type.count, watts += number * facts.watts, flux += number * type.flux;
        is_known = is_known && facts.watts > 0;
        html += fmt::format(
            "<tr><td class=\"text label\">{}</td><td>{}</td><td class=\"text "
            "product\">{}<br><small>{}</small></td><td>{}</td>"
            "<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            type.label, small_polar_diagram(facts.curves), escaped(facts.name), escaped(facts.file), type.count,
            short_figure(type.flux), watts_or(facts.watts, unknown),
            facts.watts > 0 ? short_figure(type.flux / facts.watts) : "-", watts_or(number * facts.watts, "-"),
            percent_range(type.output), factor_range(type.maintenance));
    }
    html += fmt::format(
        "<tr class=\"total\"><td class=\"text\" colspan=\"3\">All</td><td>{}</td><td>{}</td><td></td><td></td>"
        "<td>{}</td><td></td><td></td></tr>\n</table>\n",
        count, short_figure(flux), is_known ? short_figure(watts) : unknown);
    return html +
           "<p class=\"note\">Flux and power of one new luminaire at full output, by its photometric file. Output: "
           "share of it in this solution (dimming). Power is not reduced by dimming. Red, solid: C0-C180; blue, "
           "dashed: C90-C270; the number is the outermost circle.</p>\n";
}

std::string others_table(const LuminaireSchedule& schedule) {
    if (schedule.others.empty()) return "";
    std::string html =
        "<h3>Light without a photometric file</h3>\n<table>\n<thead><tr><th class=\"text\">Emitting "
        "material</th><th>Faces</th><th>Area m²</th><th>Flux lm</th></tr></thead>\n";
    for (const LuminaireSchedule::Other& other : schedule.others)
        html += fmt::format("<tr><td class=\"text\">{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                            escaped(other.material), other.faces, short_figure(other.area), short_figure(other.flux));
    return html + "</table>\n<p class=\"note\">The power of these faces is unknown and not in the sums.</p>\n";
}

std::string rooms_table(const ReportContent& content, const LuminaireSchedule& schedule) {
    if (schedule.rooms.empty()) return "";
    std::string html =
        "<table>\n<thead><tr><th class=\"text\">Room</th><th class=\"text\">Luminaires</th><th>Power "
        "W</th><th>W/m²</th><th>Mean lx</th><th>W/m² per 100 lx</th></tr></thead>\n";
    for (const LuminaireSchedule::Room& room : schedule.rooms) {
        std::string counts;
        for (const auto& [type, count] : room.counts)
            counts += fmt::format("{}{} × {}", counts.empty() ? "" : ", ", count, schedule.types[type].label);
        html += fmt::format(
            "<tr><td class=\"text\">{}</td><td class=\"text\">{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>"
            "\n",
            escaped(content.rooms.label(room.room)), counts, room.watts ? short_figure(*room.watts) : unknown,
            room.watts ? short_figure(room.watts_per_area) : "-", room.light ? short_figure(*room.light) : "-",
            room.watts && room.light ? short_figure(room.per_100_lux()) : "-");
    }
    return html +
           "</table>\n<p class=\"note\">Power per floor area. The mean is that of the largest horizontal measuring "
           "plane "
           "in the room.</p>\n";
}

std::string layout(const ReportContent& content, const LuminaireSchedule& schedule) {
    std::string html;
    for (const LuminaireSchedule::Room& room : schedule.rooms)
        html += fmt::format(
            "<h3>Layout: {}</h3>\n<figure>{}<figcaption>Luminaires (yellow) by type and number; "
            "x to the right, y upwards.</figcaption></figure>\n",
            escaped(content.rooms.label(room.room)), luminaire_plan(content, schedule, room.room));
    return html;
}

std::string places_table(const ReportContent& content, const LuminaireSchedule& schedule) {
    constexpr std::size_t max_rows = 60;  // derived from the two columns of a page
    if (schedule.items.empty()) return "";
    std::string html =
        "<h3>Positions</h3>\n<div class=\"columns\"><table>\n<thead><tr><th class=\"text\">Luminaire</th><th>x "
        "m</th><th>y m</th><th>z m</th><th class=\"text\">Name</th></tr></thead>\n";
    const std::size_t count = std::min(max_rows, schedule.items.size());
    for (std::size_t i = 0; i < count; ++i) {
        const LuminaireSchedule::Item& item = schedule.items[i];
        const Point& p = item.facts->position;
        html += fmt::format(
            "<tr><td class=\"text\">{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.2f}</td><td class=\"text\">{}</td>"
            "</tr>\n",
            item.label, p.x, p.y, p.z, escaped(content.solution->scene.groups()[GroupId(item.facts->group)]));
    }
    html += "</table></div>\n";
    if (count < schedule.items.size())
        html += fmt::format("<p class=\"note\">{} more are in luminaires.csv of the tables.</p>\n",
                            schedule.items.size() - count);
    return html;
}

std::string quoted_field(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
}

}  // namespace

std::string schedule_html(const ReportContent& content, const LuminaireSchedule& schedule) {
    return types_table(schedule) + rooms_table(content, schedule) + others_table(schedule) + layout(content, schedule) +
           places_table(content, schedule);
}

std::string schedule_json(const LuminaireSchedule& schedule) {
    std::string types, rooms, others;
    for (const LuminaireSchedule::Type& type : schedule.types)
        types += fmt::format(
            "{}{{\"label\": {}, \"name\": {}, \"file\": {}, \"count\": {}, \"flux\": {}, \"power\": {}, \"output\": "
            "[{}, {}], \"maintenance\": [{}, {}]}}",
            types.empty() ? "" : ",\n      ", json_text(type.label), json_text(type.facts->name),
            json_text(type.facts->file), type.count, figure(type.flux),
            type.facts->watts > 0 ? figure(type.facts->watts) : "null", figure(type.output.least),
            figure(type.output.most), figure(type.maintenance.least), figure(type.maintenance.most));
    for (const LuminaireSchedule::Room& room : schedule.rooms)
        rooms +=
            fmt::format("{}{{\"room\": {}, \"power\": {}, \"power_per_area\": {}, \"power_per_area_100_lux\": {}}}",
                        rooms.empty() ? "" : ",\n      ", room.room + 1, room.watts ? figure(*room.watts) : "null",
                        room.watts ? figure(room.watts_per_area) : "null",
                        room.watts && room.light ? figure(room.per_100_lux()) : "null");
    for (const LuminaireSchedule::Other& other : schedule.others)
        others += fmt::format("{}{{\"material\": {}, \"faces\": {}, \"area\": {}, \"flux\": {}}}",
                              others.empty() ? "" : ",\n      ", json_text(other.material), other.faces,
                              figure(other.area), figure(other.flux));
    return fmt::format("{{\"types\": [{}],\n    \"rooms\": [{}],\n    \"others\": [{}]}}", types, rooms, others);
}

std::string luminaires_csv(const ReportContent& content, const LuminaireSchedule& schedule) {
    std::string text = "luminaire,type,name,file,room,x,y,z,flux,power,maintenance\n";
    for (const LuminaireSchedule::Item& item : schedule.items) {
        const LuminaireSchedule::Type& type = schedule.types[item.type];
        const Point& p = item.facts->position;
        text +=
            fmt::format("{},{},{},{},{},{:.6g},{:.6g},{:.6g},{},{},{:.6g}\n", item.label, type.label,
                        quoted_field(content.solution->scene.groups()[GroupId(item.facts->group)]),
                        quoted_field(type.facts->file), item.room ? quoted_field(content.rooms.label(*item.room)) : "",
                        p.x, p.y, p.z, figure(type.flux), watts_or(type.facts->watts, ""), item.facts->maintenance);
    }
    return text;
}

}  // namespace exitance
