#include "exitance/lab/study/study_solve.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>

#include "exitance/base/random.hpp"
#include "exitance/io/files/child_process.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/lab/study/run_facts.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr int not_reached_status = 4, no_result_status = 5;  // exit codes of `solve`
/// A process that exceeds its time limit is killed after this multiple of it plus some seconds.
constexpr double kill_factor = 1.5, kill_seconds = 10;

using Facts = std::map<std::string, std::string>;

bool has(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::string first_error(const std::string& text) {
    const std::size_t at = text.find("error: ");
    if (at == std::string::npos) return "the program ended without output";
    return text.substr(at + 7, text.find('\n', at) - at - 7);
}

std::string status_of(const StudySolve& run, const ProgramRun& program) {
    const bool late = program.seconds > 0.9 * study_time_limit(run);
    if (program.status == 0) return "done";
    if (program.out_of_time || (late && program.status == not_reached_status)) return "time limit";
    if (program.status == not_reached_status)
        return program.err.find("memory limit") != std::string::npos ? "memory limit" : "not reached";
    if (program.status == no_result_status || program.status == 1000 + SIGKILL) {
        if (program.err.find("memory") != std::string::npos) return "memory limit";
        return late ? "time limit" : "failed: " + first_error(program.err);
    }
    if (program.status > 1000) return fmt::format("failed: signal {}", program.status - 1000);
    return "failed: " + first_error(program.err);
}

bool fits(const StudySolve& run, const ChosenSolution& of) {
    return of.row == run.row.label && (of.scene.empty() || of.scene == run.scene.name) &&
           (of.setting.empty() || of.setting == run.setting) && (std::isnan(of.value) || of.value == run.value);
}

/// True if the study shows a picture of this run, or draws a line through its light.
bool is_shown(const StudySolve& run) {
    const Study& study = run.study;
    return std::any_of(study.pictures.begin(), study.pictures.end(), [&](const auto& p) { return fits(run, p.of); }) ||
           std::any_of(study.lines.begin(), study.lines.end(), [&](const auto& l) { return fits(run, l.of); });
}

/// True if a run was ended by a time limit other than the present one.
bool has_other_limit(const Table& record, const std::string& command) {
    const std::size_t last = record.rows.size() - 1;
    return record.text(last, "status") == "time limit" && record.text(last, "command") != command;
}

/// Returns the times (s) of intermediate solutions that pictures show.
std::vector<double> shown_instants(const StudySolve& run) {
    std::vector<double> instants;
    for (const StudyPicture& picture : run.study.pictures)
        if (fits(run, picture.of) && !std::isnan(picture.of.at)) instants.push_back(picture.of.at);
    return instants;
}

/// True if a solution of a record is shown in a picture but is not kept.
bool lacks_picture(const StudySolve& run, const Table& record) {
    const std::string stem = (fs::path(run.options.folder) / "runs" / run_name(run)).string();
    if (record.text(record.rows.size() - 1, "status") == "done" && is_shown(run) && !fs::exists(stem + ".h5"))
        return true;
    for (const double at : shown_instants(run))
        for (std::size_t row = 0; row + 1 < record.rows.size(); ++row)
            if (record.number(row, "processor_seconds") <= at && !fs::exists(instant_path(stem, at))) return true;
    return false;
}

std::string get(const Facts& facts, const std::string& key) {
    const auto at = facts.find(key);
    return at == facts.end() ? "" : at->second;
}

/// Share of the leaf elements that are on emitters.
double emitter_share(const Solution& solution) {
    const ElementTree& tree = solution.indirect.tree;
    const std::vector<ElementId> leaves = tree.leaves();
    const auto emits = [&](ElementId e) { return solution.scene.material(tree.region(e)).emits(); };
    const auto count = std::count_if(leaves.begin(), leaves.end(), emits);
    return leaves.empty() ? 0 : static_cast<double>(count) / static_cast<double>(leaves.size());
}

void add_measures(Table& table, const StudySolve& run, const Solution& solution) {
    table.set("emitter_share", field(emitter_share(solution)));
    if (!run.stage.reference) return;
    add_error(table, error_against(solution, *run.stage.reference));
}

/// Adds a row for an intermediate solution.
void add_checkpoint(Table& table, const StudySolve& run, std::size_t number, const Solution& solution) {
    const SolveStatistics& s = solution.statistics;
    const auto count = [&](const char* column, std::size_t value) { table.set(column, std::to_string(value)); };
    const auto figure = [&](const char* column, const char* key) {
        if (const auto at = s.figures.find(key); at != s.figures.end()) table.set(column, field(at->second));
    };
    begin_row(table, run, number);
    table.set("method", s.method), table.set("basis", s.basis);
    figure("seconds", "method_seconds"), figure("processor_seconds", "processor_seconds");
    count("elements", s.leaf_elements), count("links", s.links), count("rays", s.rays);
    count("link_bytes", s.link_memory_bytes), count("iterations", s.iterations);
    table.set("status", "on the way"), table.set("is_last", "0");
    add_measures(table, run, solution);
}

void add_last(Table& table, const StudySolve& run, std::size_t number, const ProgramRun& program, const Facts& facts,
              const std::string& command) {
    const auto copy = [&](const char* column, const char* key) { table.set(column, get(facts, key)); };
    begin_row(table, run, number);
    copy("method", "method"), copy("basis", "basis"), copy("elements", "leaf_elements"), copy("links", "links");
    copy("rays", "rays"), copy("link_bytes", "link_memory_bytes"), copy("element_bytes", "element_memory_bytes");
    copy("iterations", "iterations"), copy("initial_links", "initial_links"), copy("triangles", "triangles");
    copy("estimate", "relative_error_estimate"), copy("mesh_estimate", "relative_error_estimate_interpolant");
    if (facts.contains("initial_links")) {
        const std::size_t last = table.rows.size() - 1;
        const double added = table.number(last, "links") - table.number(last, "initial_links");
        if (std::isfinite(added)) table.set("added_links", field(added));
    }
    const bool classical = facts.contains("method_seconds");
    copy("seconds", classical ? "method_seconds" : "seconds.total");
    table.set("processor_seconds", classical ? get(facts, "processor_seconds") : field(program.processor_seconds));
    if (facts.contains("coefficient_memory_bytes")) copy("element_bytes", "coefficient_memory_bytes");
    const std::size_t row = table.rows.size() - 1;
    // Columns that shooting keeps for later shots are a cache that the papers did not have.
    const bool shoots = get(facts, "method") == "progressive" || get(facts, "method") == "substructuring";
    const double links = shoots ? 0 : table.number(row, "link_bytes");
    table.set("memory_bytes", field(links + table.number(row, "element_bytes")));
    // The system's count of a child process includes the memory of its parent.
    table.set("peak_bytes", std::to_string(program.peak_bytes));
    if (facts.contains("peak_memory_bytes")) copy("peak_bytes", "peak_memory_bytes");
    table.set("wall_seconds", field(program.seconds));
    table.set("status", status_of(run, program)), table.set("is_last", "1"), table.set("command", command);
}

std::string checkpoint_path(const std::string& stem, std::size_t number) {
    return fmt::format("{}.{:04}.h5", stem, number);
}

/// Keeps an intermediate solution for pictures at later times, or removes it.
void keep_or_remove(const StudySolve& run, const std::string& path, double seconds) {
    std::error_code ignored;
    for (const double at : shown_instants(run))
        if (seconds <= at)
            fs::copy_file(path, instant_path((fs::path(run.options.folder) / "runs" / run_name(run)).string(), at),
                          fs::copy_options::overwrite_existing, ignored);
    fs::remove(path, ignored);
}

/// Measures the solutions of a run, and removes their files.
Table measured(const StudySolve& run, const std::string& stem, const ProgramRun& program, const std::string& command) {
    Table table{result_columns, {}};
    std::error_code ignored;
    std::size_t number = 1;
    for (;; ++number) {
        const std::string path = checkpoint_path(stem, number);
        if (!fs::exists(path)) break;
        const Result<Solution> solution = load_solution(path);
        if (solution) add_checkpoint(table, run, number, *solution);
        keep_or_remove(run, path, solution ? table.number(table.rows.size() - 1, "processor_seconds") : HUGE_VAL);
    }
    add_last(table, run, number, program, facts_of_json(program.out), command);
    if (const Result<Solution> solution = load_solution(stem + ".h5")) {
        add_measures(table, run, *solution);
        if (is_shown(run))
            fs::rename(stem + ".h5", fs::path(run.options.folder) / "runs" / (run_name(run) + ".h5"), ignored);
    } else if (program.status == 0) {
        table.set("status", "failed: " + solution.error().message);
    }
    fs::remove(stem + ".h5", ignored);
    return table;
}

}  // namespace

double study_time_limit(const StudySolve& run) {
    return run.options.quick ? run.study.quick_time_limit : run.study.time_limit;
}

void add_error(Table& table, const ErrorMeasure& error) {
    table.set("relative_rms_error", field(error.relative_rms_error));
    table.set("raw_relative_rms_error", field(error.raw_relative_rms_error));
    table.set("noise", field(error.reference_noise)), table.set("bias", field(error.bias));
    table.set("points", field(static_cast<double>(error.points)));
}

void begin_row(Table& table, const StudySolve& run, std::size_t checkpoint) {
    table.add_row();
    table.set("study", run.study.name), table.set("scene", run.scene.name);
    table.set("parameter", field(run.value)), table.set("setting", setting_text(run.row, run.setting));
    table.set("checkpoint", std::to_string(checkpoint));
    table.set("row", run.row.label), table.set("level", run.setting);
    table.set("polygons", std::to_string(run.stage.polygons));
}

std::string setting_text(const StudyRow& row, const std::string& setting) {
    return setting.empty() ? row.label : row.label + " " + setting;
}

std::vector<std::string> solve_words(const StudySolve& run) {
    const std::vector<std::pair<std::string, std::string>> values{{"value", fmt::format("{:g}", run.value)},
                                                                  {"setting", run.setting}};
    std::vector<std::string> words{"solve", run.stage.path};
    for (const std::string& word : split_words(filled_in(run.row.options, values))) words.push_back(word);
    const auto add = [&](const char* option, const std::string& value) {
        if (!has(words, option)) words.push_back(option), words.push_back(value);
    };
    add("--threads", std::to_string(run.study.threads));
    add("--time-limit", fmt::format("{:g}", study_time_limit(run)));
    add("--memory-limit", run.study.memory_limit);
    return words;
}

std::string run_name(const StudySolve& run) {
    std::vector<std::string> words = solve_words(run);
    words[1] = run.scene.name;
    // The result of a run that ended in time does not depend on the study's time limit.
    const auto limit = std::find(words.begin(), words.end(), "--time-limit");
    if (!has(split_words(run.row.options), "--time-limit")) words.erase(limit, limit + 2);
    return fmt::format("{}_{:016x}", run.scene.name,
                       hash(run.stage.key, key_of(fmt::format("{}", fmt::join(words, " ")))));
}

Result<std::optional<Table>> solve_for_study(const StudySolve& run, std::mutex& files, const StopRequest& stop) {
    const fs::path folder = run.options.folder;
    const std::string name = run_name(run), record = (folder / "runs" / (name + ".csv")).string();
    std::vector<std::string> words = solve_words(run);
    const std::string stem = (folder / "work" / name).string();
    std::vector<std::string> shown = words;
    shown[1] = run.scene.file.empty() ? "scenes/" + fs::path(run.stage.path).filename().string() : run.stage.words;
    const std::string command = fmt::format("exitance {} -o S.h5", fmt::join(shown, " "));
    if (fs::exists(record)) {
        Result<Table> before = read_csv(record);
        const bool serves = before && !before->rows.empty() && !lacks_picture(run, *before);
        if (serves && !has_other_limit(*before, command)) return std::optional(std::move(*before));
    }
    words.insert(words.begin(), run.options.program);
    for (const std::string& word : {std::string("-o"), stem + ".h5", std::string("--json"), std::string("-q")})
        words.push_back(word);
    const ProgramRun program = run_program(words, "", kill_factor * study_time_limit(run) + kill_seconds, stop);
    if (stop.requested()) return std::optional<Table>();
    const std::lock_guard lock(files);
    Table table = measured(run, stem, program, command);
    if (const Result<void> written = write_csv(record, table); !written) return written.error();
    return std::optional(std::move(table));
}

}  // namespace exitance
