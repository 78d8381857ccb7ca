#include <fmt/format.h>

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/cli/verbs/factor_facts.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/view_factors/node_table.hpp"
#include "exitance/io/view_factors/view3d_output.hpp"
#include "exitance/view_factors/entry_factors.hpp"
#include "exitance/view_factors/gray_exchange.hpp"
#include "exitance/view_factors/row_factors.hpp"

namespace exitance {
namespace {

/// Smallest error of rows that rays reach at about the cost of View3D's default eps: measured by `exitance viewfactors
/// chair.obj --error R`, 65 faces take 0.4 s at 1e-3 and 11 s at 1e-4.
constexpr double finest_rows = 1e-3;
/// Up to this number of faces, entries to a tolerance take seconds at any eps.
constexpr std::size_t few_faces = 40;
constexpr double default_eps = 1e-4;
constexpr double min_tolerance = 1e-7;  ///< derived from the 24 bits of a number in a binary result
constexpr double max_tolerance = 1e-2;

/// True if rows by rays would miss eps, View3D's limit on the error of a factor, and entries to a tolerance are
/// affordable or a finer eps than View3D's default demands them.
bool needs_entries(double eps, std::size_t faces) {
    return eps < finest_rows && (eps < default_eps || faces <= few_faces);
}

/// Computes the factors of all faces: rows with the error of `--error`, or factors as accurate as the file's eps
/// requires.
SparseFactors compute_factors(const View3dArguments& arguments, double eps, const Scene& scene, Terminal& terminal,
                              const StopRequest& stop) {
    const std::size_t faces = scene.surfaces().size();
    if (!arguments.error && needs_entries(eps, faces)) {
        if (faces > few_faces)
            terminal.note(fmt::format(
                "eps={:g}: each factor is computed to this tolerance; --error R, such as 1e-3, is faster", eps));
        EntryFactorOptions options;
        options.tolerance = std::max(eps, min_tolerance);
        SparseFactors table = compute_entry_factors(scene, options, nullptr, terminal.progress(), stop);
        if (table.unsettled > 0)
            terminal.note(fmt::format("warning: the factors of {} pairs of faces are known to less than eps={:g}",
                                      table.unsettled, eps));
        return table;
    }
    const double error = arguments.error.value_or(std::clamp(eps, finest_rows, max_tolerance));
    if (!arguments.error && error > eps)
        terminal.note(
            fmt::format("eps={:g} with {} faces: the error of rows is {:g}; --error R sets it", eps, faces, error));
    RowFactorOptions options;
    options.error = error;
    return compute_row_factors(scene, options, nullptr, terminal.progress(), stop);
}

/// Beginnings of warnings that do not concern this verb: it needs no light, and takes encl and emit into account.
constexpr std::string_view unneeded_warnings[]{missing_light[0], "'encl=", "'emit="};

/// Replaces view factors by exchange factors of the gray surfaces.
Result<void> take_exchange_factors(SparseFactors& table, const StopRequest& stop) {
    std::vector<ThermalSurface> surfaces(table.size());
    constexpr double any_temperature = 300;  // K; exchange factors do not depend on it
    for (std::size_t i = 0; i < table.size(); ++i)
        surfaces[i].emissivity = table.emittances[i], surfaces[i].temperature = any_temperature;
    const std::optional<double> surroundings = is_enclosure(table) ? std::nullopt : std::optional(0.0);
    const Result<std::vector<std::vector<double>>> factors = exchange_factors(table, surfaces, surroundings, stop);
    if (!factors) return factors.error();
    table.starts = {0}, table.columns.clear(), table.values.clear();
    for (const std::vector<double>& row : *factors) {
        for (std::uint32_t j = 0; j < row.size(); ++j) table.columns.push_back(j), table.values.push_back(row[j]);
        table.starts.push_back(table.values.size());
    }
    return {};
}

}  // namespace

/// Runs `exitance view3d IN OUT`.
ExitCode run(const View3dArguments& arguments, Terminal& terminal) {
    const StopRequest& stop = terminal.limits().keep();
    set_threads(arguments.threads);
    if (ending(arguments.input) != ".vs3")
        return terminal.fail({ErrorCode::usage, "is not a View3D input file (.vs3)", arguments.input,
                              "use `exitance viewfactors` for other scenes"});
    const Result<View3dControls> controls = read_view3d_controls(arguments.input);
    if (!controls) return terminal.fail(controls.error());
    if (const auto format = view3d_output({}, *controls); !format) {
        Error error = format.error();
        error.where = arguments.input;
        return terminal.fail(error);
    }
    LoadOptions load;
    load.stop = &stop;
    const LoadedScene loaded = load_scene(std::vector<std::string>{arguments.input}, load);
    show_findings_without(unneeded_warnings, loaded.findings, terminal);
    if (!loaded.scene) return terminal.fail(loaded);
    SparseFactors table = compute_factors(arguments, controls->eps, *loaded.scene, terminal, stop);
    if (stop.requested())
        return terminal.fail_stopped("the file would not be whole; `exitance viewfactors` keeps finished rows");
    table = merge_nodes(table, view3d_rows(*loaded.scene, arguments.input));
    if (controls->is_enclosure) close_rows(table);
    if (controls->has_emittances)
        if (const Result<void> taken = take_exchange_factors(table, stop); !taken) return terminal.fail(taken.error());
    const Result<std::string> text = view3d_output(table, *controls);
    if (const Result<void> written = write_file(arguments.output, *text); !written)
        return terminal.fail(written.error());
    return ExitCode::done;
}

}  // namespace exitance
