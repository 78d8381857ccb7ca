#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "exitance/base/words.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/write_error.hpp"
#include "exitance/io/report/isolux_plan.hpp"
#include "exitance/io/report/requirements.hpp"

namespace exitance {
namespace {

/// Formats a place or a direction for the page, in metres.
std::string place(const Vec3& v) {
    const auto rounded = [](double x) { return std::abs(x) < 0.005 ? 0 : x; };
    return fmt::format("{:.4g}, {:.4g}, {:.4g}", rounded(v.x), rounded(v.y), rounded(v.z));
}

std::string triple(const Vec3& v, const char* between) {
    return fmt::format("{:.6g}{}{:.6g}{}{:.6g}", v.x, between, v.y, between, v.z);
}

/// Formats a number of a table; empty if it is not finite.
std::string cell(double value) {
    return std::isfinite(value) ? figure(value) : "";
}

/// Formats a text as a quoted field of CSV.
std::string csv_field(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
}

std::string planes_csv(const ReportContent& content, const ReportFigures& figures) {
    std::string text =
        "plane,name,kind,unit,x,y,z,nx,ny,nz,border,columns,rows,spacing_u,spacing_v,points,hidden,Em,Emin,Emax,U0,Ud,"
        "maintenance,zone\n";
    for (std::size_t i = 0; i < figures.grids.size(); ++i) {
        const ReportFigures::Grid& grid = figures.grids[i];
        const GridLight& light = *grid.light;
        const Levels& l = grid.levels;
        const bool known = l.count > 0;
        text += fmt::format("{},{},{},{},{},{},{:.6g},{},{},{:.6g},{:.6g},{},{},", i + 1, csv_field(light.name),
                            light.is_cylindrical ? "cylindrical" : "plane", content.unit.is_lux() ? "lx" : "W/m^2",
                            triple(light.plane.origin, ","), triple(light.n, ","), light.plane.margin, light.columns,
                            light.rows, light.step_u, light.step_v, l.count, grid.hidden);
        text += known ? fmt::format("{},{},{},{},{}", figure(l.mean), figure(l.least), figure(l.most),
                                    figure(l.uniformity()), figure(l.diversity()))
                      : ",,,,";
        text += fmt::format(",{:.6g},{}\n", content.maintenance, name_of(light.zone));
    }
    return text;
}

std::string points_csv(const ReportFigures::Grid& grid, const LightUnit& unit) {
    std::string text = fmt::format("x,y,z,nx,ny,nz,{}\n", unit.is_lux() ? "lux" : "watt");
    const GridLight& light = *grid.light;
    for (std::size_t i = 0; i < light.points.size(); ++i) {
        if (!light.counts.empty() && !light.counts[i]) continue;
        text += fmt::format("{},{},{}\n", triple(light.points[i], ","), triple(light.n, ","),
                            light.is_open[i] ? figure(grid.values[i]) : "");
    }
    return text;
}

std::string observers_csv(const ReportContent& content) {
    std::string text = "name,x,y,z,dx,dy,dz,UGR,background,sources,large_source,left_out\n";
    for (const auto& [observer, glare] : content.observers)
        text += fmt::format("{},{},{},{},{},{},{},{}\n", csv_field(observer.name), triple(observer.eye, ","),
                            triple(observer.view, ","), cell(glare.rating()), figure(glare.background),
                            glare.sources.size(), glare.has_large_source() ? 1 : 0, glare.left_out.size());
    return text;
}

std::string requirements_csv(const std::vector<Judgement>& judged) {
    std::string text = "where,quantity,required,reached,verdict\n";
    for (const Judgement& j : judged)
        text += fmt::format("{},{},{:.6g},{},{}\n", csv_field(j.where), j.quantity, j.required, cell(j.reached),
                            words_of(j.verdict));
    return text;
}

std::string surfaces_csv(const ReportFigures& figures) {
    std::string text = "surface,line,group,material,area,points,mean,minimum,maximum,uniformity,radiosity\n";
    for (const ReportFigures::Face& face : figures.faces) {
        const Levels& l = face.irradiance;
        text += fmt::format("{},{},{},{},{},{},", face.surface.value, face.line, csv_field(face.group),
                            csv_field(face.material), figure(face.area), l.count);
        text += l.count == 0 ? ",,,,\n"
                             : fmt::format("{},{},{},{},{}\n", figure(l.mean), figure(l.least), figure(l.most),
                                           figure(l.uniformity()), figure(face.radiosity));
    }
    return text;
}

/// Formats a UGR for the page: below 10 as "< 10" [CIE117], "-" if no source counts.
std::string rating_words(double rating) {
    return !std::isfinite(rating) ? "-" : rating < 10 ? "&lt; 10" : fmt::format("{:.1f}", rating);
}

}  // namespace

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '&')
            out += "&amp;";
        else if (c == '"')
            out += "&quot;";
        else if (static_cast<unsigned char>(c) < 0x20)
            out += ' ';
        else
            out += c;
    }
    return out;
}

std::string observer_json(const ObserverGlare& o) {
    std::string sources;
    for (const GlareSource& s : o.glare.sources)
        sources += fmt::format("{}{{\"name\": {}, \"luminance\": {}, \"solid_angle\": {}, \"position\": {}}}",
                               sources.empty() ? "" : ", ", json_text(s.name), figure(s.luminance),
                               figure(s.solid_angle), figure(s.position));
    std::string left_out;
    for (const GlareSource& s : o.glare.left_out)
        left_out += fmt::format("{}{{\"name\": {}, \"reason\": {}}}", left_out.empty() ? "" : ", ", json_text(s.name),
                                json_text(name_of(s.limit)));
    return fmt::format(
        "{{\"name\": {}, \"room\": {}, \"eye\": [{}], \"view\": [{}], \"ugr\": {}, \"background\": {}, "
        "\"large_source\": {},\n     "
        "\"sources\": [{}],\n     \"left_out\": [{}]}}",
        json_text(o.observer.name), o.observer.room ? std::to_string(*o.observer.room + 1) : "null",
        triple(o.observer.eye, ", "), triple(o.observer.view, ", "), figure(o.glare.rating()),
        figure(o.glare.background), o.glare.has_large_source(), sources, left_out);
}

std::string observers_html(const ReportContent& content) {
    if (content.observers.empty()) return "";
    std::string html =
        "<div class=\"wide\"><table>\n<thead><tr><th class=\"text\">Observer</th><th>Eye m</th><th>Line of "
        "sight</th><th>UGR</th><th>Background cd/m²</th><th>Sources (left out)</th><th class=\"text\">Worst source"
        "</th></tr></thead>\n";
    constexpr std::size_t longest_line = 40;  // characters; longer names may wrap
    bool large = false;
    for (const auto& [observer, glare] : content.observers) {
        const GlareSource* worst = glare.sources.empty() ? nullptr : &glare.sources.front();
        large |= glare.has_large_source();
        html += fmt::format(
            "<tr><td class=\"{}\">{}</td><td class=\"name\">{}</td><td class=\"name\">{}</td><td>{}</td><td>{}"
            "</td><td>{} ({})</td><td class=\"text\">{}</td></tr>\n",
            observer.name.size() <= longest_line ? "text name" : "text", escaped(observer.name), place(observer.eye),
            place(observer.view), rating_words(glare.rating()), short_figure(glare.background), glare.sources.size(),
            glare.left_out.size(),
            worst ? fmt::format("{}: {} cd/m²", escaped(worst->name), short_figure(worst->luminance)) : "none");
    }
    html +=
        "</table></div>\n<p class=\"note\">Unified glare rating by CIE 117; light as it is new. Luminaires in front of "
        "the observer that CIE 117 does not count are left out: those overhead (H/R beyond Guth's table, 1.7 to 1.9), "
        "those far to the side (T/R above 3), and those above the eye that see it from more than 85 degrees from the "
        "nadir.</p>\n";
    if (large)
        html +=
            "<p class=\"note\">A source of more than 0.1 sr is in view: that is beyond what the rating was made "
            "for.</p>\n";
    return html;
}

Result<void> write_report_tables(const ReportContent& content, const std::string& folder) {
    if (const Result<void> made = make_folder(folder); !made) return made.error();
    const auto in = [&](const std::string& name) { return (std::filesystem::path(folder) / name).string(); };
    const ReportFigures figures = find_figures(content);
    if (const Result<void> written = write_file(in("planes.csv"), planes_csv(content, figures)); !written)
        return written;
    for (std::size_t i = 0; i < figures.grids.size(); ++i) {
        const ReportFigures::Grid& grid = figures.grids[i];
        const Drawing plan = isolux_plan(grid, content.unit, content.solution->scene);
        const std::string name = fmt::format("plane_{}", i + 1);
        for (const Result<void>& written :
             {write_file(in(name + ".csv"), points_csv(grid, content.unit)),
              write_file(in(name + ".svg"), svg_of(plan)), write_file(in(name + ".pdf"), pdf_of(plan))})
            if (!written) return written;
    }
    if (!figures.luminaires.items.empty())
        if (const Result<void> written = write_file(in("luminaires.csv"), luminaires_csv(content, figures.luminaires));
            !written)
            return written;
    if (!content.requirements.empty())
        if (const Result<void> written = write_file(in("requirements.csv"), requirements_csv(judge(content, figures)));
            !written)
            return written;
    if (!figures.faces.empty())
        if (const Result<void> written = write_file(in("surfaces.csv"), surfaces_csv(figures)); !written)
            return written;
    return content.observers.empty() ? Result<void>() : write_file(in("observers.csv"), observers_csv(content));
}

}  // namespace exitance
