#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include "exitance/io/files/toml_keys.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/lab/peers/peers.hpp"
#include "exitance/lab/study/study.hpp"

namespace exitance {
namespace {

constexpr std::array<std::pair<Measure, std::string_view>, 8> measure_names{{
    {Measure::value, "value"},
    {Measure::largest, "largest"},
    {Measure::last, "last"},
    {Measure::slope, "slope"},
    {Measure::ratio, "ratio"},
    {Measure::last_ratio, "last_ratio"},
    {Measure::crossing, "crossing"},
    {Measure::quadratic_misfit, "quadratic_misfit"},
}};
constexpr std::array<std::pair<StudyPicture::Shows, std::string_view>, 3> picture_names{{
    {StudyPicture::Shows::light, "light"},
    {StudyPicture::Shows::mesh, "mesh"},
    {StudyPicture::Shows::halves, "halves"},
}};

void read_scene(TomlKeys& keys, StudyScene& scene) {
    keys.need("name", scene.name);
    keys.take("generate", scene.generate);
    keys.take("file", scene.file);
    keys.take("values", scene.values);
    scene.quick_values = scene.values;
    keys.take("quick", scene.quick_values);
    if (scene.generate.empty() == scene.file.empty())
        keys.fail(keys.table(), "a scene needs either 'generate' or 'file'");
    if (scene.name.find_first_of("/\\ ") != std::string::npos)
        keys.fail(keys.table(), fmt::format("'{}' has blanks or slashes: files are named after scenes", scene.name));
    if (scene.values.empty()) scene.values = scene.quick_values = {0};
}

void read_row(TomlKeys& keys, StudyRow& row) {
    keys.need("label", row.label);
    keys.need("options", row.options);
    keys.take("peer", row.peer);
    if (!row.peer.empty() && find_peer(row.peer) == nullptr)
        keys.fail(*keys.find("peer"), fmt::format("'{}' is not one of {}", row.peer, fmt::join(peer_names(), ", ")));
    keys.take("settings", row.settings);
    row.quick_settings = row.settings;
    keys.take("quick_settings", row.quick_settings);
    keys.take("quick", row.quick);
    keys.take("equal_time", row.equal_time);
    keys.take("most", row.most);
    keys.take("scenes", row.scenes);
}

void read_plot(TomlKeys& keys, StudyPlot& plot) {
    keys.need("name", plot.name);
    keys.need("x", plot.x);
    keys.need("y", plot.y);
    plot.title = plot.name, plot.x_label = plot.x, plot.y_label = plot.y;
    keys.take("title", plot.title);
    keys.take("table", plot.table);
    keys.take("series", plot.series);
    keys.take("panel", plot.panel);
    keys.take("x_label", plot.x_label);
    keys.take("y_label", plot.y_label);
    keys.take("log", plot.log);
    keys.take("labels", plot.labels);
    keys.take("fit", plot.fit);
    if (!plot.fit.empty() && plot.fit != "power" && plot.fit != "quadratic")
        keys.fail(*keys.find("fit"), fmt::format("'{}' is not power or quadratic", plot.fit));
    keys.take("where", plot.where);
    keys.take("checkpoints", plot.checkpoints);
    if (plot.name.find_first_of("/\\ ") != std::string::npos)
        keys.fail(keys.table(), fmt::format("'{}' has blanks or slashes: files are named after plots", plot.name));
}

void read_chosen(TomlKeys& keys, ChosenSolution& of) {
    keys.need("row", of.row);
    keys.take("scene", of.scene);
    keys.take("setting", of.setting);
    keys.take("value", of.value);
}

void read_line(TomlKeys& keys, StudyLine& line) {
    read_chosen(keys, line.of);
    keys.need("name", line.name);
    keys.take("points", line.points);
    for (const auto& [key, target] :
         {std::pair("from", &line.from), std::pair("to", &line.to), std::pair("normal", &line.normal)}) {
        std::vector<double> numbers;
        keys.need(key, numbers);
        if (numbers.size() != 3) keys.fail(*keys.find(key), fmt::format("'{}' is not [x, y, z]", key));
        std::copy(numbers.begin(), numbers.end(), target->begin());
    }
    const auto& n = line.normal;
    if (!(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] > 0)) keys.fail(keys.table(), "the normal has no length");
    if (line.points < 2) keys.fail(keys.table(), "a line needs at least two points");
}

void read_picture(TomlKeys& keys, StudyPicture& picture) {
    read_chosen(keys, picture.of);
    keys.take("caption", picture.caption);
    keys.take("options", picture.options);
    keys.take("at", picture.of.at);
    keys.take_choice("shows", picture_names, picture.shows);
}

void read_drawing(TomlKeys& keys, StudyDrawing& drawing) {
    keys.need("name", drawing.name);
    keys.need("table", drawing.table);
    drawing.title = drawing.name;
    keys.take("title", drawing.title);
    keys.take("x_label", drawing.x_label);
    keys.take("y_label", drawing.y_label);
    keys.take("equal_axes", drawing.equal_axes);
    keys.take("where", drawing.where);
}

void read_item(TomlKeys& keys, StudyItem& item) {
    keys.need("shows", item.shows);
    keys.take("study", item.study);
    keys.take("says", item.says);
    keys.take("reason", item.reason);
    if (item.study.empty() && item.reason.empty())
        keys.fail(keys.table(), fmt::format("the item '{}' has neither a study nor a reason", item.shows));
}

void read_conclusion(TomlKeys& keys, StudyConclusion& conclusion) {
    keys.need("says", conclusion.says);
    keys.need("y", conclusion.y);
    keys.take("x", conclusion.x);
    keys.take("paper", conclusion.paper);
    keys.take("plot", conclusion.plot);
    keys.take("table", conclusion.table);
    keys.take("where", conclusion.where);
    keys.take("against", conclusion.against);
    keys.take("least", conclusion.least);
    keys.take("most", conclusion.most);
    keys.take_choice("measure", measure_names, conclusion.measure);
    const Measure m = conclusion.measure;
    const bool along = m != Measure::value && m != Measure::largest && m != Measure::ratio;
    if (along && conclusion.x.empty())
        keys.fail(keys.table(), fmt::format("'{}' needs an 'x'", measure_names[static_cast<std::size_t>(m)].second));
}

void read_reference(TomlKeys& keys, StudyReference& reference) {
    keys.take("file", reference.file);
    keys.take("options", reference.options);
    reference.quick_options = reference.options;
    keys.take("quick_options", reference.quick_options);
    keys.take("points", reference.points);
    keys.take("paths", reference.paths);
    reference.quick_points = reference.points, reference.quick_paths = reference.paths;
    keys.take("quick_points", reference.quick_points);
    keys.take("quick_paths", reference.quick_paths);
    keys.finish();
    if (reference.file.empty() && (reference.points == 0 || reference.paths == 0))
        keys.fail(keys.table(), "a reference needs 'points' and 'paths', or a 'file'");
}

Study read_study(const toml::table& table, const std::string& file) {
    Study study;
    TomlKeys keys(table, file);
    keys.need("title", study.title);
    keys.take("about", study.about);
    keys.take("parameter", study.parameter);
    keys.take("unit", study.unit);
    keys.take("table", study.table);
    keys.take("arguments", study.arguments);
    keys.take("threads", study.threads);
    keys.take("time_limit", study.time_limit);
    study.quick_time_limit = std::min(study.quick_time_limit, study.time_limit);
    keys.take("quick_time_limit", study.quick_time_limit);
    keys.take("memory_limit", study.memory_limit);
    keys.take("ascending", study.ascending);
    keys.take("equal_time", study.equal_time);
    take_list(keys, "scene", study.scenes, read_scene);
    take_list(keys, "row", study.rows, read_row);
    take_list(keys, "plot", study.plots, read_plot);
    take_list(keys, "picture", study.pictures, read_picture);
    take_list(keys, "line", study.lines, read_line);
    take_list(keys, "conclusion", study.conclusions, read_conclusion);
    take_list(keys, "drawing", study.drawings, read_drawing);
    take_list(keys, "item", study.items, read_item);
    if (const toml::node* reference = keys.find("reference")) {
        if (!reference->is_table()) keys.fail(*reference, "'reference' is not a table: [reference]");
        TomlKeys inner(*reference->as_table(), file);
        read_reference(inner, study.reference);
    }
    keys.finish();
    if (study.table.empty() && (study.scenes.empty() || study.rows.empty()))
        keys.fail(table, "a study needs at least one [[scene]] and one [[row]], or a 'table'");
    std::set<std::string> labels;
    for (const StudyRow& row : study.rows)
        if (!labels.insert(row.label).second) keys.fail(table, fmt::format("two rows are called '{}'", row.label));
    return study;
}

}  // namespace

Result<Study> parse_study(const std::string& text, const std::string& name, const std::string& file) {
    return read_toml(text, file, [&](const toml::table& table) {
        Study study = read_study(table, file);
        study.name = name, study.text = text;
        study.folder = std::filesystem::path(file).parent_path().string();
        return study;
    });
}

Result<Study> load_study(const std::string& path) {
    const Result<std::string> text = read_whole_file(path);
    if (!text) return text.error();
    return parse_study(*text, std::filesystem::path(path).stem().string(), path);
}

}  // namespace exitance
