#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "exitance/base/distinct_numbers.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/cli/common_stop.hpp"
#include "exitance/cli/json_output.hpp"
#include "exitance/cli/processes.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/cli/verbs/factor_facts.hpp"
#include "exitance/cli/verbs/factor_output.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/solution/checkpoint_file.hpp"
#include "exitance/io/view_factors/operator_file.hpp"
#include "exitance/io/view_factors/raw_row_file.hpp"
#include "exitance/processes/result_of_all.hpp"
#include "exitance/view_factors/entry_factors.hpp"
#include "exitance/view_factors/ray_check.hpp"
#include "exitance/view_factors/row_check.hpp"
#include "exitance/view_factors/row_factors.hpp"

namespace exitance {
namespace {

constexpr std::size_t default_checked_rows = 4, default_checked_entries = 100, default_rays_an_entry = 1u << 14;

/// Rays per checked row. The noise of the squared error of a row is 2 sqrt(sum F^2) / n. With n = 0.2 / R^2 and sum F^2
/// = 0.1 it is 3 R^2, so that four rows together distinguish an error of 2 R from one of R.
std::size_t default_rays_a_row(double error) {
    return static_cast<std::size_t>(std::clamp(0.2 / (error * error), 8192.0, 524288.0));
}

/// Options for computing the rows. For an operator they are more accurate, since merging their entries adds an error.
RowFactorOptions table_options(const ViewFactorArguments& arguments) {
    const double error = arguments.error.value_or(default_row_error);
    RowFactorOptions options{.error = error, .smallest = arguments.smallest, .seed = arguments.seed};
    if (!arguments.operator_file.empty()) options = operator_table_options(error, arguments.smallest, arguments.seed);
    options.memory_limit_bytes = arguments.limits.memory_limit.value_or(SIZE_MAX);
    return options;
}

/// Identifies the computation to which the rows in a work file belong: scene, accuracy and seed.
std::string work_of(const ViewFactorArguments& arguments, const Scene& scene) {
    const RowFactorOptions options = table_options(arguments);
    std::string text = fmt::format("{} error {} tolerance {} seed {}", scene_fingerprint(scene), options.error,
                                   arguments.tolerance.value_or(0), arguments.seed);
    if (options.missed_error) text += fmt::format(" sky {}", *options.missed_error);
    return text;
}

/// One run of the verb, after the scene was read.
class ViewFactorRun {
  public:
    ViewFactorRun(const ViewFactorArguments& arguments, const LoadedScene& checked, const CommonStop& stop,
                  Terminal& terminal)
        : arguments_(arguments),
          scene_(*checked.scene),
          origin_(checked.origin),
          common_stop_(stop),
          stop_(stop.request()),
          terminal_(terminal) {}

    ExitCode operator()() {
        std::optional<FactorNodes> nodes;  // only set in the first process, which writes the matrix
        const Result<void> ready = by_first([&]() -> Result<void> {
            Result<std::optional<FactorNodes>> found =
                arguments_.output.empty() ? std::optional<FactorNodes>() : nodes_of(arguments_, scene_);
            if (!found) return found.error();
            nodes = std::move(*found);
            const Result<void> known = check_emissivities(arguments_, scene_, nodes);
            return known ? open_work_file() : known;
        });
        if (!ready) return terminal_.fail(ready.error());
        const Stopwatch time;
        SparseFactors table = compute();
        ViewFactorFacts facts = facts_of(table, time.seconds());
        facts.error = error(), facts.tolerance = arguments_.tolerance, facts.smallest = arguments_.smallest;
        if (facts.finished_rows == 0 && table.size() > 0) return no_rows();
        const bool is_finished = facts.finished_rows == table.size() && table.is_settled;
        std::optional<FactorOperator> transport;
        if (!arguments_.operator_file.empty()) {
            transport = make_operator(table);
            facts.transport = facts_of(*transport);
        }
        if (is_finished) check(table, transport, facts);
        const Result<void> written = by_first([&] { return write(std::move(table), transport, nodes); });
        if (!written) return terminal_.fail(written.error());
        if (is_finished && rows_) rows_->remove();
        show(facts);
        return is_finished ? outcome(facts) : stopped(facts);
    }

  private:
    double error() const { return arguments_.error.value_or(default_row_error); }

    /// Opens OUTPUT.rows, in the first process, for finished rows, unless the output exists and is not a regular file.
    Result<void> open_work_file() {
        std::error_code ignored;
        const std::string& output = arguments_.output.empty() ? arguments_.operator_file : arguments_.output;
        const std::filesystem::file_status status = std::filesystem::status(output, ignored);
        if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) return {};
        Result<RawRowFile> file = RawRowFile::open(output + ".rows", work_of(arguments_, scene_), arguments_.resume,
                                                   scene_.surfaces().size());
        if (!file) return file.error();
        rows_.emplace(std::move(*file));
        if (rows_->set_aside() > 0)
            terminal_.note(fmt::format(
                "warning: {} has {} finished rows of a stopped run, and this run starts again; to continue from them, "
                "stop it, rename {} to {} and add --resume",
                rows_->path(), rows_->set_aside(), rows_->set_aside_path(), rows_->path()));
        return {};
    }

    SparseFactors compute() {
        RawRowStore* const store = rows_ ? &*rows_ : nullptr;
        const std::size_t memory = arguments_.limits.memory_limit.value_or(SIZE_MAX);
        if (arguments_.tolerance) {
            const EntryFactorOptions options{*arguments_.tolerance, arguments_.smallest, memory};
            return compute_entry_factors(scene_, options, store, terminal_.progress(), stop_);
        }
        return compute_row_factors(scene_, table_options(arguments_), store, terminal_.progress(), stop_);
    }

    /// The operator of a table, which is moved into it unless the table is an output as well.
    FactorOperator make_operator(SparseFactors& table) const {
        terminal_.progress().phase("operator");
        const std::vector<ViewFace> faces = make_view_faces(scene_);
        const double node_error = node_share * error();
        return arguments_.output.empty() ? make_factor_operator(faces, std::move(table), node_error)
                                         : make_factor_operator(faces, table, node_error);
    }

    /// Writes the outputs. Finished rows are written even after a stop, hence the new StopRequest.
    Result<void> write(SparseFactors table, const std::optional<FactorOperator>& transport,
                       const std::optional<FactorNodes>& nodes) const {
        if (!arguments_.output.empty())
            if (const Result<void> written =
                    write_factor_output(arguments_, scene_, origin_, nodes, std::move(table), StopRequest());
                !written)
                return written;
        return transport ? write_factor_operator(arguments_.operator_file, *transport, StopRequest()) : Result<void>();
    }

    void check(const SparseFactors& table, const std::optional<FactorOperator>& transport, ViewFactorFacts& facts) {
        terminal_.progress().phase("check by rays");
        if (arguments_.tolerance)
            facts.check = check_by_rays(
                scene_, table,
                {arguments_.check.value_or(default_checked_entries),
                 arguments_.check_rays.value_or(default_rays_an_entry), arguments_.seed, *arguments_.tolerance},
                stop_);
        else
            facts.row_check = check_rows(table, transport);
    }

    RowCheck check_rows(const SparseFactors& table, const std::optional<FactorOperator>& transport) const {
        const RowCheckOptions options{.rows = arguments_.check.value_or(default_checked_rows),
                                      .rays = arguments_.check_rays.value_or(default_rays_a_row(error())) / 2,
                                      .seed = arguments_.seed,
                                      .error = error()};
        if (!transport) return check_rows_by_rays(scene_, table, options, stop_);
        return check_rows_by_rays(
            scene_, transport->rows.finished, [&](std::size_t i) { return transport->dense_row(i); }, options, stop_);
    }

    ExitCode no_rows() {
        if (rows_) rows_->withdraw();
        if (const std::optional<ExitCode> signal = common_stop_.signal()) return *signal;
        return terminal_.fail({ErrorCode::limit, "stopped before the first row of view factors was finished", "",
                               "allow more time or memory, or a larger error"});
    }

    void show(const ViewFactorFacts& facts) {
        if (arguments_.json)
            terminal_.print(view_factors_json(facts));
        else if (!arguments_.quiet)
            terminal_.print(words_of(facts));
    }

    ExitCode stopped(const ViewFactorFacts& facts) {
        terminal_.note(
            fmt::format("stopped after {} of {} rows, which are written without adjustment; --resume continues",
                        facts.finished_rows, facts.surfaces));
        if (rows_ && !rows_->is_whole())
            terminal_.note(fmt::format("warning: {} could not be written completely", rows_->path()));
        return common_stop_.signal() == ExitCode::interrupted ? ExitCode::interrupted : ExitCode::demand_not_reached;
    }

    ExitCode outcome(const ViewFactorFacts& facts) {
        bool reached = true;
        const auto warn = [&](bool condition, const std::string& text) {
            if (condition) terminal_.note("warning: " + text), reached = false;
        };
        if (arguments_.tolerance) {
            warn(facts.unsettled > 0, fmt::format("the entries of {} pairs of faces still disagree by more than {:g}",
                                                  facts.unsettled, *arguments_.tolerance));
            const double excess = facts.max_row_sum - 1;
            const NumberTexts sums = distinct_texts(excess, *arguments_.tolerance);
            warn(excess > *arguments_.tolerance,
                 fmt::format("the sum of a row exceeds 1 by {}, more than {}", sums.first, sums.second));
            warn(facts.check.wrong > 0, fmt::format("{} of {} entries that rays checked are off by more than {:g}",
                                                    facts.check.wrong, facts.check.entries, *arguments_.tolerance));
            return reached ? ExitCode::done : ExitCode::demand_not_reached;
        }
        const double row_error = facts.transport ? facts.transport->row_error : facts.row_error;
        const NumberTexts errors = distinct_texts(row_error, error());
        warn(row_error > error(), fmt::format("the error of some row is {}, above {}", errors.first, errors.second));
        if (facts.transport) {
            const NumberTexts defects = distinct_texts(facts.transport->closure_defect, error());
            warn(facts.transport->closure_defect > error(),
                 fmt::format("a row of the operator, with the sky and backs of faces, differs from 1 by {}, more than "
                             "{}",
                             defects.first, defects.second));
        }
        warn(wrong_rows(facts) > 0, fmt::format("{} of {} rows that rays checked are off by more than {:g}",
                                                wrong_rows(facts), facts.row_check.rows.size(), error()));
        if (facts.unclosed > 0)
            terminal_.note(
                fmt::format("warning: {} rows do not add up to 1 with the sky and backs of faces, by more than "
                            "3.5 standard deviations; they are not adjusted",
                            facts.unclosed));
        return reached ? ExitCode::done : ExitCode::demand_not_reached;
    }

    const ViewFactorArguments& arguments_;
    const Scene& scene_;
    const Point origin_;
    const CommonStop& common_stop_;
    const StopRequest& stop_;
    Terminal& terminal_;
    std::optional<RawRowFile> rows_;  ///< Set only in the first process.
};

/// Error if the files to write cannot be written, or have options or endings that do not fit.
Result<void> check_outputs(const ViewFactorArguments& arguments) {
    if (arguments.output.empty() && arguments.operator_file.empty())
        return Error{ErrorCode::usage, "is required", "--output", "give -o FILE, or --operator FILE.h5"};
    for (const std::string& output : {arguments.output, arguments.operator_file}) {
        if (output.empty()) continue;
        for (const char* of_scenes : {".mtl", ".obj", ".gltf", ".glb", ".rad", ".stl", ".ply", ".vs3", ".hbjson"})
            if (ending(output) == of_scenes)
                return Error{ErrorCode::usage, "has the ending of a scene's files", output,
                             "view factors are written as " + endings_of_factor_files()};
    }
    if (const Result<void> fit = check_output_options(arguments); !fit) return fit;
    if (!arguments.output.empty() && !traits_of(format_of(arguments)).is_folder)
        if (const auto file = AtomicFile::create(arguments.output); !file) return file.error();
    if (!arguments.operator_file.empty())
        if (const auto file = AtomicFile::create(arguments.operator_file); !file) return file.error();
    return {};
}

}  // namespace

/// Runs `exitance viewfactors SCENE -o MATRIX`, or with `--operator FILE`.
ExitCode run(const ViewFactorArguments& arguments, Terminal& terminal) {
    StopRequest& asked = terminal.limits().keep();
    const CommonStop stop(terminal, asked);
    set_threads(arguments.threads);
    const Result<void> fit = by_first([&] { return check_outputs(arguments); });
    if (!fit) return terminal.fail(fit.error());
    SceneArguments scene = arguments.scene;
    scene.load.stop = &asked, scene.load.without_panes = true, scene.load.needs_light = false;
    // View factors do not depend on colours: rows are faces of the file unless parts are requested.
    if (!scene.load.texture_parts) scene.load.texture_parts = 0;
    const LoadedScene checked = load_for_all(scene);
    show_findings_without(missing_light, checked.findings, terminal);
    if (!checked.scene) return terminal.fail(checked);
    return ViewFactorRun(arguments, checked, stop, terminal)();
}

}  // namespace exitance
