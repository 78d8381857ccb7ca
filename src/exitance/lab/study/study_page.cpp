#include "exitance/lab/study/study_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <thread>

#include "exitance/base/version.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/base64.hpp"
#include "exitance/io/files/child_process.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/lab/study/study_items.hpp"
#include "exitance/lab/study/study_scene.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr double render_seconds = 300;
constexpr std::size_t max_rows_shown = 600;

constexpr const char* style = R"css(
:root { color-scheme: light; }
body { font: 15px/1.5 system-ui, sans-serif; color: #1b1b1f; max-width: 66rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.7rem; } h2 { font-size: 1.25rem; margin-top: 2.2rem; border-bottom: 1px solid #ccc; }
figure { margin: 1rem 0; } figcaption { color: #555; font-size: .85rem; } img { max-width: 100%; height: auto; }
.pictures { display: flex; flex-wrap: wrap; gap: 1rem; } .pictures figure { flex: 1 1 20rem; }
.halves { position: relative; } .halves img + img { position: absolute; left: 0; top: 0; clip-path: inset(0 0 0 50%); }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .8rem; }
th, td { padding: .15rem .7rem .15rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid #eee; }
.wide { overflow-x: auto; max-height: 30rem; } pre { overflow-x: auto; font-size: .8rem; background: #f6f6f6; padding: .6rem; }
.yes { color: #00693e; font-weight: 600; } .no { color: #a33000; font-weight: 600; } .unknown { color: #666; }
)css";

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) switch (c) {
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '&':
                out += "&amp;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    return out;
}

/// Returns a data URL with the contents of a file.
std::string data_address(const std::string& path, const char* kind) {
    const Result<std::string> content = read_whole_file(path);
    if (!content) return "";
    return fmt::format("data:{};base64,{}", kind, base64(std::as_bytes(std::span(content->data(), content->size()))));
}

std::string section(const std::string& title, const std::string& body) {
    return body.empty() ? "" : fmt::format("<h2>{}</h2>\n{}", escaped(title), body);
}

std::string conclusions(const StudyPage& page) {
    if (page.verdicts.empty()) return "";
    std::string html =
        "<table>\n<tr><th>statement</th><th>source</th><th>here</th><th>measured (asked)</th><th>plot</th></tr>\n";
    for (const Verdict& v : page.verdicts) {
        const char* kind = v.holds == Verdict::Holds::yes ? "yes" : v.holds == Verdict::Holds::no ? "no" : "unknown";
        const char* word = v.holds == Verdict::Holds::yes          ? "holds"
                           : v.holds == Verdict::Holds::no         ? "does not hold"
                           : v.holds == Verdict::Holds::not_judged ? "quick run, not judged"
                                                                   : "not measured";
        const std::string& plot = v.conclusion->plot;
        html += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"{}\">{}</td><td>{}</td><td>{}</td></tr>\n",
                            escaped(v.conclusion->says), escaped(v.conclusion->paper), kind, word, escaped(v.detail),
                            plot.empty() ? "" : fmt::format("<a href=\"#{}\">{}</a>", escaped(plot), escaped(plot)));
    }
    return html + "</table>\n";
}

std::string plots(const StudyPage& page) {
    std::string html;
    std::set<std::string> named;
    for (const DrawnPlot& drawn : page.plots) {
        const std::string title = drawn.panel.empty() ? drawn.plot->title : drawn.plot->title + ": " + drawn.panel;
        const bool first = named.insert(drawn.plot->name).second;
        html += fmt::format("<figure{}><img src=\"{}\" alt=\"{}\" width=\"820\" height=\"480\"></figure>\n",
                            first ? fmt::format(" id=\"{}\"", escaped(drawn.plot->name)) : "",
                            data_address(drawn.svg, "image/svg+xml"), escaped(title));
    }
    return html;
}

std::string drawings(const StudyPage& page) {
    if (page.drawings.empty()) return "";
    std::string html = "<div class=\"pictures\">\n";
    for (const DrawnShapes& drawn : page.drawings) {
        const std::string title = escaped(fmt::format("{}: {}", drawn.drawing->title, drawn.name));
        html += fmt::format("<figure><img src=\"{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>\n",
                            data_address(drawn.svg, "image/svg+xml"), title, title);
    }
    return html + "</div>\n";
}

/// Plots of the studies that the items name, a section per study.
std::string parts(const StudyPage& page, const std::string& folder) {
    std::string html;
    std::set<std::string> known;
    for (const StudyItem& item : page.study.items) {
        if (item.study.empty() || !known.insert(item.study).second) continue;
        std::string body =
            fmt::format("<p><a href=\"{0}/index.html\">All tables and pictures of {0}</a></p>\n", escaped(item.study));
        for (const std::string& path : plots_of_part(folder, item.study))
            body += fmt::format("<figure><img src=\"{}\" alt=\"{}\"></figure>\n", data_address(path, "image/svg+xml"),
                                escaped(fs::path(path).stem().string()));
        html += section("Study: " + item.study, body);
    }
    return html;
}

std::string pictures(const StudyPage& page) {
    if (page.pictures.empty()) return "";
    std::string html = "<div class=\"pictures\">\n";
    for (const DrawnPicture& drawn : page.pictures) {
        html += fmt::format("<figure><div{}>", drawn.files.size() > 1 ? " class=\"halves\"" : "");
        for (const std::string& file : drawn.files)
            html += fmt::format("<img src=\"{}\" alt=\"{}\">", data_address(file, "image/png"), escaped(drawn.caption));
        html += fmt::format("</div><figcaption>{}</figcaption></figure>\n", escaped(drawn.caption));
    }
    return html + "</div>\n";
}

std::string table_html(const Table& table) {
    std::string html = "<div class=\"wide\"><table>\n<tr>";
    std::vector<std::string> shown;
    for (const std::string& column : table.columns)
        if (column != "command" && column != "study") shown.push_back(column);
    for (const std::string& column : shown) html += "<th>" + escaped(column) + "</th>";
    html += "</tr>\n";
    std::size_t count = 0;
    for (const std::size_t row : chosen_rows(table, {}, true)) {
        if (++count > max_rows_shown) break;
        html += "<tr>";
        for (const std::string& column : shown) {
            const std::string& text = table.text(row, column);
            const std::optional<double> number = parse_number(text);
            html += "<td>" + (number ? fmt::format("{:.4g}", *number) : escaped(text)) + "</td>";
        }
        html += "</tr>\n";
    }
    return html + "</table></div>\n";
}

std::string commands(const Table& results) {
    std::string text;
    std::set<std::string> known;
    for (std::size_t row = 0; row < results.rows.size(); ++row)
        if (const std::string& command = results.text(row, "command"); !command.empty() && known.insert(command).second)
            text += command + "\n";
    return text.empty() ? "" : "<pre>" + escaped(text) + "</pre>\n";
}

std::string processor_name() {
    const Result<std::string> text = read_whole_file("/proc/cpuinfo");
    const std::size_t at = text ? text->find("model name") : std::string::npos;
    if (at == std::string::npos) return "unknown processor";
    const std::size_t begin = text->find(": ", at) + 2;
    return text->substr(begin, text->find('\n', begin) - begin);
}

std::string machine(const StudyPage& page) {
    return fmt::format("<p>exitance {}; {}, {} threads; {} in {:.0f} s (finished runs are not repeated).</p>\n",
                       program_version, escaped(processor_name()), std::thread::hardware_concurrency(),
                       page.quick ? "quick" : "in full", page.seconds);
}

}  // namespace

std::vector<DrawnPicture> draw_pictures(const Study& study, const StudyOptions& options, const Table& results,
                                        const StopRequest& stop) {
    std::vector<DrawnPicture> drawn;
    if (results.rows.empty()) return drawn;
    const fs::path folder = fs::path(options.folder) / "pictures";
    std::error_code failed;
    fs::create_directories(folder, failed);
    for (std::size_t i = 0; i < study.pictures.size() && !stop.requested(); ++i) {
        const StudyPicture& p = study.pictures[i];
        const std::string solution = kept_solution(p.of, options.folder);
        if (solution.empty()) continue;
        DrawnPicture out{&p, p.caption.empty() ? p.of.row : p.caption, {}};
        for (const bool mesh : {false, true}) {
            if (mesh ? p.shows == StudyPicture::Shows::light : p.shows == StudyPicture::Shows::mesh) continue;
            const std::string file = (folder / fmt::format("{}_{}.png", i + 1, mesh ? "mesh" : "light")).string();
            std::vector<std::string> words{options.program, "render", solution, "-o", file, "-q"};
            for (const std::string& word : split_words(p.options)) words.push_back(word);
            if (mesh) words.push_back("--mesh");
            if (run_program(words, "", render_seconds, stop).status == 0) out.files.push_back(file);
        }
        if (!out.files.empty()) drawn.push_back(std::move(out));
    }
    return drawn;
}

Result<void> write_study_page(const StudyPage& page, const std::string& path) {
    const Study& study = page.study;
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title><style>{1}</style></head>"
        "<body>\n<h1>{0}</h1>\n<p>{2}</p>\n",
        escaped(study.title), style, escaped(study.about));
    html += machine(page);
    html += section("What is concluded", conclusions(page));
    html += section("Plots", plots(page));
    html += section("Drawings", drawings(page));
    html += section("Pictures", pictures(page));
    const auto is_drawn = [&](const std::string& name) {
        return std::any_of(study.drawings.begin(), study.drawings.end(),
                           [&](const StudyDrawing& drawing) { return drawing.table == name; });
    };
    for (const auto& [name, table] : page.tables)
        if (!table.rows.empty() && !is_drawn(name)) html += section("Table: " + name, table_html(table));
    html += parts(page, fs::path(path).parent_path().string());
    if (const auto results = page.tables.find("results"); results != page.tables.end())
        html += section("Commands", commands(results->second));
    html += section("The study", "<pre>" + escaped(study.text) + "</pre>\n");
    return write_file(path, html + "</body></html>\n");
}

}  // namespace exitance
