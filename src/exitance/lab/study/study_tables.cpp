#include "exitance/lab/study/study_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "exitance/base/random.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/lab/flatland/growing_lines.hpp"
#include "exitance/lab/flatland/kernel_terms.hpp"
#include "exitance/lab/local_passes/local_pass_study.hpp"
#include "exitance/lab/studies/cell_growth.hpp"
#include "exitance/lab/studies/cie171.hpp"
#include "exitance/lab/studies/kernel_error.hpp"
#include "exitance/lab/studies/sample_distribution.hpp"
#include "exitance/lab/studies/task_schedules.hpp"
#include "exitance/lab/studies/view_factor_programs.hpp"
#include "exitance/lab/study/study_items.hpp"
#include "exitance/lab/study/study_scene.hpp"
#include "exitance/lab/thesis/thesis_studies.hpp"

namespace exitance {
namespace {

/// A kernel of two-dimensional transport (flatland), with or without a step at x = y.
struct FlatKernel {
    bool step;
    double h;

    double operator()(double x, double y) const { return step && x <= y ? 0.0 : 1 / ((x - y) * (x - y) + h * h); }
    std::string name() const { return fmt::format("{}, h = {:g}", step ? "step" : "smooth", h); }
};

void add_flatland_row(Table& table, const FlatKernel& kernel, const std::string& basis, const std::string& way,
                      std::size_t m, double error) {
    table.add_row();
    table.set("kernel", kernel.name()), table.set("h", field(kernel.h)), table.set("basis", basis);
    table.set("decomposition", way), table.set("m", std::to_string(m)), table.set("relative_l2_error", field(error));
}

/// Adds means over seeds, with half of the range between the smallest and the largest as `spread`.
void add_growing_rows(Table& table, const FlatKernel& kernel, std::span<const std::size_t> counts, int seeds) {
    using namespace flatland;
    static constexpr std::pair<CellWeights, const char*> ways[] = {
        {CellWeights::delta_rule, "growing cells, delta rule"},
        {CellWeights::least_squares, "growing cells, least squares"},
        {CellWeights::normalised_least_squares, "growing cells, normalised"}};
    for (const auto& [weights, name] : ways) {
        std::vector<std::vector<double>> of_seed;
        for (int seed = 1; seed <= seeds; ++seed)
            of_seed.push_back(errors_of_growing_kernel(kernel, kernel.h, counts,
                                                       {.weights = weights, .seed = static_cast<std::uint64_t>(seed)}));
        for (std::size_t i = 0; i < counts.size(); ++i) {
            double sum = 0, least = of_seed[0][i], most = least;
            for (const auto& errors : of_seed)
                sum += errors[i], least = std::min(least, errors[i]), most = std::max(most, errors[i]);
            // a row for each decomposition, so that plots of both have it
            for (const char* way : {"standard", "non-standard"}) {
                add_flatland_row(table, kernel, name, way, counts[i], sum / seeds);
                table.set("spread", field((most - least) / 2));
            }
        }
    }
}

Result<StudyTables> flatland_tables(const Study&, const StudyOptions& options, Progress& progress,
                                    const StopRequest& stop) {
    using namespace flatland;
    const int levels = options.quick ? 6 : 8;
    std::vector<std::size_t> counts;
    for (std::size_t m = 1; m <= std::size_t(1) << (2 * levels); m *= 2) counts.push_back(m);
    const std::vector<std::size_t> units =
        options.quick ? std::vector<std::size_t>{16, 64} : std::vector<std::size_t>{16, 32, 64, 128, 256, 512};
    Table table;
    progress.phase("flatland");
    for (const bool step : {false, true})
        for (const double h : {1.0, 0.2, 0.1, 0.05, 0.02}) {
            const FlatKernel kernel{step, h};
            for (const LineBasis basis : line_bases)
                for (const Decomposition way : {Decomposition::standard, Decomposition::non_standard}) {
                    if (stop.requested()) break;
                    const KernelTerms terms(basis, way, levels, kernel);
                    const std::vector<double> errors = terms.errors(counts);
                    for (std::size_t i = 0; i < counts.size(); ++i) {
                        add_flatland_row(table, kernel, std::string(name_of(basis)),
                                         way == Decomposition::standard ? "standard" : "non-standard", counts[i],
                                         errors[i]);
                        table.set("terms", std::to_string(terms.size()));
                    }
                }
            if (!stop.requested()) add_growing_rows(table, kernel, units, options.quick ? 2 : 5);
            progress.advance(step ? 0.5 : 0, kernel.name());
        }
    return StudyTables{{"results", std::move(table)}};
}

Result<StudyTables> cie171_tables(const Study&, const StudyOptions& options, Progress& progress,
                                  const StopRequest& stop) {
    Cie171Options asked;
    asked.quick = options.quick, asked.threads = options.threads;
    const Result<std::vector<Cie171Row>> rows = run_cie171(asked, progress, stop);
    if (!rows) return rows.error();
    Table table, summary;
    for (const Cie171Row& row : *rows) {
        table.add_row();
        table.set("study", row.study), table.set("scene", row.scene), table.set("parameter", row.parameter);
        table.set("point", row.point);
        for (const auto& [name, value] : {std::pair("x", row.x.x), std::pair("y", row.x.y), std::pair("z", row.x.z),
                                          std::pair("nx", row.n.x), std::pair("ny", row.n.y), std::pair("nz", row.n.z)})
            table.set(name, field(value));
        table.set("exact", field(row.exact)), table.set("computed", field(row.computed));
        table.set("relative_error", field(row.relative_error));
    }
    for (const Cie171Summary& entry : summarize(*rows)) {
        summary.add_row();
        summary.set("study", entry.study), summary.set("points", std::to_string(entry.points));
        summary.set("mean", field(entry.mean)), summary.set("largest", field(entry.largest));
        summary.set("worst", entry.worst);
    }
    return StudyTables{{"results", std::move(table)}, {"summary", std::move(summary)}};
}

/// Calls use(name, scene, its stage) for the scenes of a study and the values in their order. Names include the value
/// if a scene has one.
template <class Use>
Result<void> for_scenes(const Study& study, const StudyOptions& options, Progress& progress, const StopRequest& stop,
                        const Use& use) {
    std::error_code failed;
    for (const char* folder : {"scenes", "references", "runs"})
        std::filesystem::create_directories(std::filesystem::path(options.folder) / folder, failed);
    progress.phase(study.table);
    for (const StudyScene& scene : study.scenes)
        for (const double value : options.quick ? scene.quick_values : scene.values) {
            if (stop.requested()) return {};
            const Result<StudyStage> stage = prepare_scene(study, scene, value, options, progress, stop);
            if (!stage) return stage.error();
            const CheckedScene checked = load_scene({stage->path}, {});
            if (!checked.scene) return checked.scene.error();
            progress.advance(0, stage->words);
            const bool varies = scene.generate.find("{value}") != std::string::npos;
            use(varies ? fmt::format("{} {:g}", scene.name, value) : scene.name, *checked.scene, *stage);
        }
    return {};
}

/// Tables whose rows belong to scenes. The result of make(name, scene), a Result<StudyTables> with the tables `names`,
/// is kept in FOLDER/runs and reused when the study is resumed.
template <class Make>
Result<StudyTables> tables_by_scene(const Study& study, const StudyOptions& options, Progress& progress,
                                    const StopRequest& stop, const std::vector<std::string>& names, const Make& make) {
    StudyTables all;
    std::optional<Error> failure;
    std::string arguments;
    for (const auto& [name, value] : study.arguments) arguments += name + "=" + value + " ";
    const auto add_scene = [&](const std::string& name, const Scene& scene, const StudyStage& stage) {
        if (failure) return;
        const std::uint64_t key =
            hash(stage.key, key_of(fmt::format("{} {} {}", study.table, name, arguments)), options.quick);
        const auto path = [&](const std::string& table) {
            return (std::filesystem::path(options.folder) / "runs" / fmt::format("{}_{:016x}.csv", table, key))
                .string();
        };
        StudyTables parts;
        for (const std::string& table : names)
            if (Result<Table> part = read_csv(path(table))) parts[table] = std::move(*part);
        if (parts.size() < names.size()) {
            Result<StudyTables> made = make(name, scene);
            if (!made) return void(failure = made.error());
            parts = std::move(*made);
            for (const std::string& table : names)
                if (!stop.requested())
                    if (const Result<void> kept = write_csv(path(table), parts[table]); !kept) failure = kept.error();
        }
        for (const std::string& table : names) all[table].append(parts[table]);
    };
    const Result<void> done = for_scenes(study, options, progress, stop, add_scene);
    if (!done) return done.error();
    if (failure && !stop.requested()) return *failure;
    return all;
}

/// A single table of the rows that write(name, scene, text) writes under a header.
template <class Write>
Result<StudyTables> results_by_scene(const Study& study, const StudyOptions& options, Progress& progress,
                                     const StopRequest& stop, std::string_view header, const Write& write) {
    return tables_by_scene(study, options, progress, stop, {"results"},
                           [&](const std::string& name, const Scene& scene) -> Result<StudyTables> {
                               CsvText text;
                               text.print("%s\n", std::string(header).c_str());
                               write(name, scene, text);
                               Result<Table> table = parse_csv(text.text(), study.table);
                               if (!table) return table.error();
                               return StudyTables{{"results", std::move(*table)}};
                           });
}

double argument(const Study& study, const std::string& name, double otherwise) {
    const auto at = study.arguments.find(name);
    return at == study.arguments.end() ? otherwise : parse_number(at->second).value_or(otherwise);
}

/// One of the tables about the thesis's structures; scene names include their values if there are several.
Result<StudyTables> scene_tables(std::span<const SceneStudy> known, const Study& study, const StudyOptions& options,
                                 Progress& progress, const StopRequest& stop) {
    const auto part = std::find_if(known.begin(), known.end(), [&](const auto& p) { return p.name == study.table; });
    return results_by_scene(
        study, options, progress, stop, part->header,
        [&](const std::string& name, const Scene& scene, CsvText& text) { part->run(name.c_str(), scene, text); });
}

Result<StudyTables> mesh_tables(const Study& study, const StudyOptions& options, Progress& progress,
                                const StopRequest& stop) {
    return scene_tables(thesis_mesh_studies(), study, options, progress, stop);
}

Result<StudyTables> visibility_tables(const Study& study, const StudyOptions& options, Progress& progress,
                                      const StopRequest& stop) {
    return scene_tables(thesis_visibility_studies(), study, options, progress, stop);
}

Result<StudyTables> kernel_tables(const Study& study, const StudyOptions& options, Progress& progress,
                                  const StopRequest& stop) {
    KernelErrorOptions asked;
    if (options.quick) asked = {.seeds = 2, .counts = {16, 64, 256}, .pairs = 20'000};
    return results_by_scene(study, options, progress, stop, kernel_error_header,
                            [&](const std::string& name, const Scene& scene, CsvText& text) {
                                measure_kernel_error(name, scene, asked, text, stop);
                            });
}

/// Argument: `samples`. The number of units is doubled from 8 to 256.
Result<StudyTables> sample_tables(const Study& study, const StudyOptions& options, Progress& progress,
                                  const StopRequest& stop) {
    const auto samples = static_cast<std::size_t>(std::clamp(argument(study, "samples", 1000), 1.0, 1e6));
    return results_by_scene(
        study, options, progress, stop, sample_distribution_header,
        [&](const std::string& name, const Scene& scene, CsvText& text) {
            write_sample_distribution(name, scene, {8, 16, 32, 64, 128, 256}, samples, 1, text, stop);
        });
}

/// Growth of cells in scenes, and in Flatland.
Result<StudyTables> growth_tables(const Study& study, const StudyOptions& options, Progress& progress,
                                  const StopRequest& stop) {
    const std::vector<std::size_t> units =
        options.quick ? std::vector<std::size_t>{16, 64} : std::vector<std::size_t>{16, 64, 256, 1024};
    Result<StudyTables> tables =
        tables_by_scene(study, options, progress, stop, {"results", "growth", "samples"},
                        [&](const std::string& name, const Scene& scene) -> Result<StudyTables> {
                            CellGrowthTables made;
                            measure_cell_growth(name, scene, units, 1, made, stop);
                            return StudyTables{{"results", std::move(made.results)},
                                               {"growth", std::move(made.growth)},
                                               {"samples", std::move(made.samples)}};
                        });
    if (!tables || stop.requested()) return tables;
    FlatlandGrowth flat = measure_flatland_growth(units, 1);
    (*tables)["flatland"] = std::move(flat.errors);
    (*tables)["centres"] = std::move(flat.centres);
    (*tables)["approximation"] = std::move(flat.approximation);
    return tables;
}

/// Arguments: `threshold_W`, `min_area_m2`, `repeats` and `error` (of the production solve).
Result<StudyTables> schedule_tables(const Study& study, const StudyOptions& options, Progress& progress,
                                    const StopRequest& stop) {
    const auto given = [&](const char* name) {
        const double value = argument(study, name, 0);
        return value > 0 ? std::optional(value) : std::nullopt;
    };
    ScheduleStudy asked{given("threshold_W"), given("min_area_m2"), 1, argument(study, "error", 0.02)};
    if (!options.quick) asked.repeats = static_cast<int>(argument(study, "repeats", 3));
    const std::vector<std::string> names{"results", "graphs", "iterations", "calibration",
                                         "phases",  "curves", "busy",       "tree"};
    return tables_by_scene(study, options, progress, stop, names,
                           [&](const std::string& name, const Scene& scene) -> Result<StudyTables> {
                               ScheduleTables tables;
                               measure_schedules(name, scene, asked, tables, stop);
                               return StudyTables{{"results", std::move(tables.runs)},
                                                  {"graphs", std::move(tables.graphs)},
                                                  {"iterations", std::move(tables.iterations)},
                                                  {"calibration", std::move(tables.calibration)},
                                                  {"phases", std::move(tables.phases)},
                                                  {"curves", std::move(tables.curves)},
                                                  {"busy", std::move(tables.busy)},
                                                  {"tree", std::move(tables.tree)}};
                           });
}

/// View factors by several programs; `reference` is the tolerance of the matrix that all are compared with.
Result<StudyTables> view_factor_tables(const Study& study, const StudyOptions& options, Progress& progress,
                                       const StopRequest& stop) {
    const std::filesystem::path work = std::filesystem::path(options.folder) / "work";
    std::error_code failed;
    std::filesystem::create_directories(work, failed);
    if (failed) return Error{ErrorCode::cannot_write, failed.message(), work, ""};
    const ViewFactorProgramOptions asked{.program = options.program,
                                         .folder = work,
                                         .tolerances = {1e-2, 1e-3, 1e-4},
                                         .convergence = {1e-3, 1e-4, 1e-5, 1e-6},
                                         .reference_tolerance = argument(study, "reference", 1e-5),
                                         .time_limit = options.quick ? study.quick_time_limit : study.time_limit};
    Table table;
    Result<void> compared;
    const Result<void> done = for_scenes(
        study, options, progress, stop, [&](const std::string& name, const Scene& scene, const StudyStage& stage) {
            if (compared) compared = compare_view_factor_programs(name, stage.path, scene, asked, table, stop);
        });
    std::filesystem::remove_all(work, failed);
    if (!done) return done.error();
    if (!compared) return compared.error();
    return StudyTables{{"results", std::move(table)}};
}

/// Local passes after global ones, and links by the threshold of initial links.
Result<StudyTables> local_pass_tables(const Study& study, const StudyOptions& options, Progress& progress,
                                      const StopRequest& stop) {
    LocalPassStudyOptions asked;
    if (options.quick) asked.points = 200, asked.paths = 256, asked.accuracies.pop_back();
    constexpr double medium = 0.08;
    return tables_by_scene(
        study, options, progress, stop, {"results", "thresholds"},
        [&](const std::string& name, const Scene& scene) -> Result<StudyTables> {
            const auto passes = run_local_pass_study(scene, asked, progress, stop);
            if (!passes) return passes.error();
            const auto links =
                run_link_threshold_study(scene, {0, 0.01, 0.03, 0.1, 0.3, 1}, medium, asked, progress, stop);
            if (!links) return links.error();
            Result<Table> results = parse_csv(local_pass_csv(name, *passes), "results");
            Result<Table> thresholds = parse_csv(link_threshold_csv(name, *links), "thresholds");
            if (!results) return results.error();
            if (!thresholds) return thresholds.error();
            return StudyTables{{"results", std::move(*results)}, {"thresholds", std::move(*thresholds)}};
        });
}

}  // namespace

std::span<const StudyTableMaker> study_table_makers() {
    static constexpr StudyTableMaker makers[] = {
        {"growth", growth_tables},         {"items", item_tables},
        {"candidates", visibility_tables}, {"cie171", cie171_tables},
        {"flatland", flatland_tables},     {"kernel", kernel_tables},
        {"local-pass", local_pass_tables}, {"layers", mesh_tables},
        {"premesh", mesh_tables},          {"rays", visibility_tables},
        {"samples", sample_tables},        {"schedules", schedule_tables},
        {"triangulation", mesh_tables},    {"view-factors", view_factor_tables},
        {"volumes", visibility_tables},
    };
    return makers;
}

}  // namespace exitance
