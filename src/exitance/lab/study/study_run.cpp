#include "exitance/lab/study/study_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include "exitance/base/parallel.hpp"
#include "exitance/lab/study/study_peer.hpp"
#include "exitance/lab/study/study_scene.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/processes/result_of_all.hpp"
#include "exitance/processes/run_apart.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

/// Runs of one row on one scene with one setting, for all values of the parameter, in ascending order of cost.
struct Chain {
    const StudyScene* scene;
    const StudyRow* row;
    std::string setting;
    std::vector<double> values;
    std::vector<Table> tables;  ///< One table per value that was reached.
};

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

bool is_wanted(const StudyRow& row, const StudyOptions& options) {
    if (options.quick && !row.quick) return false;
    if (options.methods.empty()) return true;
    return std::any_of(options.methods.begin(), options.methods.end(), [&](const std::string& method) {
        const std::vector<std::string> words = split_words(row.options);
        return lower(method) == lower(row.label) || lower(method) == row.peer ||
               std::find(words.begin(), words.end(), method) != words.end();
    });
}

std::vector<Chain> chains_of(const Study& study, const StudyOptions& options) {
    std::vector<Chain> chains;
    for (const StudyScene& scene : study.scenes)
        for (const StudyRow& row : study.rows) {
            const bool elsewhere =
                !row.scenes.empty() && std::find(row.scenes.begin(), row.scenes.end(), scene.name) == row.scenes.end();
            if (elsewhere || !is_wanted(row, options)) continue;
            std::vector<std::string> settings = options.quick ? row.quick_settings : row.settings;
            if (settings.empty()) settings = {""};
            for (const std::string& setting : settings) {
                chains.push_back({&scene, &row, setting, options.quick ? scene.quick_values : scene.values, {}});
                if (study.ascending) std::sort(chains.back().values.begin(), chains.back().values.end());
            }
        }
    return chains;
}

Table row_that_did_not_run(const Study& study, const Chain& chain, double value, const std::string& status) {
    Table table{result_columns, {}};
    table.add_row();
    table.set("study", study.name), table.set("scene", chain.scene->name), table.set("parameter", field(value));
    table.set("setting", setting_text(*chain.row, chain.setting)), table.set("row", chain.row->label);
    table.set("level", chain.setting), table.set("is_last", "1"), table.set("status", status);
    return table;
}

/// Scenes by name and value, with their references.
using Prepared = std::map<std::pair<std::string, double>, StudyStage>;

Result<Prepared> prepare(const Study& study, const std::vector<Chain>& chains, const StudyOptions& options,
                         Progress& progress, const StopRequest& stop) {
    std::set<std::pair<const StudyScene*, double>> wanted;
    for (const Chain& chain : chains)
        for (const double value : chain.values) wanted.emplace(chain.scene, value);
    progress.phase("reference");
    Prepared out;
    for (const auto& [scene, value] : wanted) {
        if (stop.requested()) break;
        Result<StudyStage> stage = prepare_scene(study, *scene, value, options, progress, stop);
        if (!stage) return stage.error();
        out.emplace(std::pair(scene->name, value), std::move(*stage));
        progress.advance(static_cast<double>(out.size()) / static_cast<double>(wanted.size()), scene->name);
    }
    return out;
}

/// Distributes chains over as many simultaneous runs as there are cores.
class Runner {
  public:
    Runner(const Study& study, const StudyOptions& options, std::vector<Chain> chains, const Prepared& prepared,
           Progress& progress, const StopRequest& stop)
        : study_(study),
          options_(options),
          chains_(std::move(chains)),
          prepared_(prepared),
          progress_(progress),
          stop_(stop) {
        for (const Chain& chain : chains_) runs_ += chain.values.size();
    }

    Result<Table> run() {
        progress_.phase("solve");
        const int cores = options_.threads > 0 ? options_.threads : threads();
        const int at_once = std::max(1, cores / std::max(1, study_.threads));
        std::vector<std::thread> workers;
        for (int i = 0; i < at_once; ++i) workers.emplace_back([this] { work(); });
        for (std::thread& worker : workers) worker.join();
        if (failure_) return *failure_;
        Table all{result_columns, {}};
        for (const Chain& chain : chains_)
            for (const Table& table : chain.tables) all.append(table);
        return all;
    }

  private:
    void work() {
        for (std::size_t at = next_++; at < chains_.size(); at = next_++) follow(chains_[at]);
    }

    void follow(Chain& chain) {
        std::string hopeless;
        for (const double value : chain.values) {
            const auto stage = prepared_.find({chain.scene->name, value});
            if (stop_.requested() || stage == prepared_.end()) return;
            std::optional<Table> table;
            if (value > chain.row->most)
                table = row_that_did_not_run(study_, chain, value, fmt::format("not run: beyond {}", chain.row->most));
            else if (!hopeless.empty())
                table = row_that_did_not_run(study_, chain, value, "not run: " + hopeless);
            else
                table = solve(chain, value, stage->second);
            if (!table) return;
            const std::string& status = table->text(table->rows.size() - 1, "status");
            if (study_.ascending && (status == "time limit" || status == "memory limit"))
                hopeless = fmt::format("{} at {} = {:g}", status, study_.parameter, value);
            const std::lock_guard lock(mutex_);
            chain.tables.push_back(std::move(*table));
            progress_.advance(static_cast<double>(++done_) / static_cast<double>(runs_),
                              fmt::format("{} {} {:g}: {}", setting_text(*chain.row, chain.setting), study_.parameter,
                                          value, status));
        }
    }

    std::optional<Table> solve(const Chain& chain, double value, const StudyStage& stage) {
        const StudySolve run{study_, options_, *chain.scene, *chain.row, chain.setting, value, stage};
        Result<std::optional<Table>> table =
            chain.row->peer.empty() ? solve_for_study(run, mutex_, stop_) : peer_for_study(run, mutex_, stop_);
        if (table) return std::move(*table);
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = table.error();
        return std::nullopt;
    }

    const Study& study_;
    const StudyOptions& options_;
    std::vector<Chain> chains_;
    const Prepared& prepared_;
    Progress& progress_;
    const StopRequest& stop_;
    std::atomic<std::size_t> next_{0};
    std::mutex mutex_;  ///< Guards the members below, the progress, and files of solutions.
    std::size_t done_ = 0, runs_ = 0;
    std::optional<Error> failure_;
};

/// Differences between references that are careful solves and paths.
Table reference_table(const Prepared& prepared) {
    Table table{{"scene", "parameter", "against_paths", "noise_of_paths", "points"}, {}};
    for (const auto& [key, stage] : prepared) {
        if (!stage.check) continue;
        table.add_row();
        table.set("scene", key.first), table.set("parameter", field(key.second));
        table.set("against_paths", field(stage.check->relative_rms_error));
        table.set("noise_of_paths", field(stage.check->reference_noise));
        table.set("points", std::to_string(stage.check->points));
    }
    return table;
}

Result<void> make_folders(const StudyOptions& options) {
    std::error_code failed;
    for (const char* folder : {"scenes", "references", "runs", "work"}) {
        fs::create_directories(fs::path(options.folder) / folder, failed);
        if (failed)
            return Error{ErrorCode::cannot_write, failed.message(), (fs::path(options.folder) / folder).string(), ""};
    }
    return {};
}

}  // namespace

const std::vector<std::string> result_columns{"study",
                                              "scene",
                                              "parameter",
                                              "method",
                                              "basis",
                                              "setting",
                                              "checkpoint",
                                              "seconds",
                                              "relative_rms_error",
                                              "raw_relative_rms_error",
                                              "elements",
                                              "links",
                                              "rays",
                                              "memory_bytes",
                                              "status",
                                              "link_bytes",
                                              "element_bytes",
                                              "peak_bytes"};

Result<StudyTables> run_study(const Study& study, const StudyOptions& options, Progress& progress,
                              const StopRequest& stop) {
    std::error_code failed;
    if (Result<void> made = make_folders(options); !made) return made.error();
    std::vector<Chain> chains = chains_of(study, options);
    if (chains.empty()) {
        std::vector<std::string> labels;
        for (const StudyRow& row : study.rows) labels.push_back(row.label);
        return Error{ErrorCode::usage, fmt::format("no row of '{}' is left to run", study.name), "--methods",
                     fmt::format("its rows are {}", fmt::join(labels, ", "))};
    }
    const Result<Prepared> prepared = prepare(study, chains, options, progress, stop);
    if (!prepared) return prepared.error();
    Result<Table> results = Runner(study, options, std::move(chains), *prepared, progress, stop).run();
    fs::remove_all(fs::path(options.folder) / "work", failed);
    if (!results) return results.error();
    StudyTables tables{{"results", std::move(*results)}};
    if (Table references = reference_table(*prepared); !references.rows.empty())
        tables["references"] = std::move(references);
    return tables;
}

Result<void> run_own_share(const Study& study, const StudyOptions& options, Progress& progress,
                           const StopRequest& stop) {
    const std::vector<Chain> all = chains_of(study, options);
    if (processes() == 1 || all.empty() || !study.table.empty()) return {};
    // The first process makes scenes and references, and the others read them.
    const Result<void> made = by_first([&]() -> Result<void> {
        if (const Result<void> folders = make_folders(options); !folders) return folders;
        const Result<Prepared> prepared = prepare(study, all, options, progress, stop);
        return prepared ? Result<void>() : prepared.error();
    });
    if (!made) return made;
    std::vector<Chain> own;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (is_own(i, 1)) own.push_back(all[i]);
    Result<void> done;
    run_apart([&] {
        const Result<Prepared> prepared = prepare(study, own, options, progress, stop);
        if (!prepared) return void(done = prepared.error());
        const Result<Table> table = Runner(study, options, std::move(own), *prepared, progress, stop).run();
        if (!table) done = table.error();
    });
    return result_of_all(done);
}

}  // namespace exitance
