#include "exitance/lab/study/conduct_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/folder_lock.hpp"
#include "exitance/lab/study/study_page.hpp"
#include "exitance/lab/study/study_tables.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

Result<StudyTables> make_tables(const Study& study, const StudyOptions& options, Progress& progress,
                                const StopRequest& stop) {
    if (!study.table.empty()) {
        std::vector<std::string_view> names;
        for (const StudyTableMaker& maker : study_table_makers()) {
            if (maker.name == study.table) return maker.make(study, options, progress, stop);
            names.push_back(maker.name);
        }
        return Error{ErrorCode::bad_input, fmt::format("there is no table '{}'", study.table), study.name,
                     fmt::format("there are {}", fmt::join(names, ", "))};
    }
    Result<StudyTables> tables = run_study(study, options, progress, stop);
    if (!tables) return tables.error();
    if (study.equal_time) (*tables)["equal_time"] = equal_time_table(study, (*tables)["results"]);
    if (!study.lines.empty()) {
        Result<Table> profiles = profile_table(study, options, progress, stop);
        if (!profiles) return profiles.error();
        (*tables)["profiles"] = std::move(*profiles);
    }
    return tables;
}

Result<void> write_tables(const Study& study, const StudyTables& tables, const fs::path& folder) {
    for (const auto& [name, table] : tables) {
        const bool runs = name == "results" && study.table.empty();
        const std::string path = (folder / (name + ".csv")).string();
        const Result<void> written = write_csv(path, table, runs ? result_columns : std::vector<std::string>());
        if (!written) return written.error();
        if (!runs) continue;
        if (const Result<void> all = write_csv((folder / "details.csv").string(), table); !all) return all.error();
    }
    return write_file((folder / "study.toml").string(), study.text);
}

}  // namespace

Result<StudyReport> conduct_study(const Study& study, const StudyOptions& options, Progress& progress,
                                  const StopRequest& stop) {
    const Stopwatch watch;
    const fs::path folder = options.folder;
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) return Error{ErrorCode::cannot_write, failed.message(), options.folder, ""};
    const Result<FolderLock> lock = FolderLock::take(options.folder);
    if (!lock) return lock.error();
    Result<StudyTables> tables = make_tables(study, options, progress, stop);
    if (!tables) return tables.error();
    if (const Result<void> written = write_tables(study, *tables, folder); !written) return written.error();

    StudyReport report;
    report.tables = std::move(*tables);
    report.verdicts = judge(study, report.tables, options.quick);
    const Table& results = report.tables["results"];
    const std::vector<std::size_t> last = chosen_rows(results, {}, true);
    report.runs = last.size();
    report.runs_done = static_cast<std::size_t>(std::count_if(last.begin(), last.end(), [&](std::size_t row) {
        return !results.has("status") || results.text(row, "status") == "done";
    }));
    progress.phase("draw");
    const Result<std::vector<DrawnPlot>> plots = draw_plots(study, report.tables, options.folder, stop);
    if (!plots) report.warnings.push_back("no plots: " + plots.error().message);
    const Result<std::vector<DrawnShapes>> drawings = draw_shapes(study, report.tables, options.folder);
    if (!drawings) return drawings.error();
    const std::vector<DrawnPicture> pictures = draw_pictures(study, options, results, stop);
    report.page = (folder / "index.html").string();
    const StudyPage page{study,     report.tables, report.verdicts, plots ? *plots : std::vector<DrawnPlot>(),
                         *drawings, pictures,      options.quick,   watch.seconds()};
    if (const Result<void> written = write_study_page(page, report.page); !written) return written.error();
    return report;
}

}  // namespace exitance
