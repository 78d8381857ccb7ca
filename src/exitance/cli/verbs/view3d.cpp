#include <fmt/format.h>

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/view_factors/node_table.hpp"
#include "exitance/io/view_factors/view3d_output.hpp"
#include "exitance/view_factors/gray_exchange.hpp"
#include "exitance/view_factors/row_factors.hpp"

namespace exitance {
namespace {

/// Error of rows, from View3D's tolerance of one integral. A row holds some ten large factors.
double error_of(double eps) {
    constexpr double integrals = 10, least = 1e-4, most = 1e-2;
    return std::clamp(integrals * eps, least, most);
}

/// Shows findings, except two kinds: that light is missing, which view factors do not need, and that encl and emit are
/// ignored, which this verb takes into account.
void show_findings(const LoadedScene& loaded, Terminal& terminal) {
    std::vector<Finding> findings = loaded.findings;
    std::erase_if(findings, [](const Finding& f) {
        const auto begins = [&](const char* words) { return f.message.starts_with(words); };
        return f.kind == Finding::Kind::warning &&
               (begins("nothing emits light") || begins("'encl=") || begins("'emit="));
    });
    terminal.show(findings);
}

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
    show_findings(loaded, terminal);
    if (!loaded.scene) return terminal.fail(loaded);
    const RowFactorOptions options{.error = arguments.error.value_or(error_of(controls->eps))};
    SparseFactors table = compute_row_factors(*loaded.scene, options, nullptr, terminal.progress(), stop);
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
