#include <fmt/format.h>

#include <algorithm>

#include "exitance/cli/json_output.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/view_factor_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"

namespace exitance {
namespace {

ViewFactorFacts facts_of(const ViewFactors& table, double seconds) {
    ViewFactorFacts facts{.surfaces = table.size(), .seconds = seconds, .reciprocity_defect = table.reciprocity_defect};
    if (table.size() > 0) {
        const auto [least, most] = std::minmax_element(table.row_sums.begin(), table.row_sums.end());
        facts.least_row_sum = *least;
        facts.most_row_sum = *most;
    }
    return facts;
}

}  // namespace

/// exitance viewfactors SCENE -o MATRIX
ExitCode run(const ViewFactorArguments& arguments, Terminal& terminal) {
    const StopRequest stop;  // signals end the program at once
    set_threads(arguments.threads);
    if (const Result<AtomicFile> file = AtomicFile::create(arguments.output); !file) return terminal.fail(file.error());

    const CheckedScene checked = load_scene(arguments.scene.files, arguments.scene.load);
    terminal.show(checked.findings);
    if (!checked.scene) return terminal.fail(checked);

    const Stopwatch time;
    const Result<ViewFactors> table =
        compute_view_factors(*checked.scene, arguments.tolerance, terminal.progress(), stop);
    if (!table) return terminal.fail(table.error());
    const ViewFactorFacts facts = facts_of(*table, time.seconds());
    if (const Result<void> written = write_view_factors(arguments.output, *table); !written)
        return terminal.fail(written.error());

    if (arguments.json) {
        terminal.print(view_factors_json(facts));
    } else if (!arguments.quiet) {
        terminal.print(fmt::format("{} surfaces, row sums from {:.6f} to {:.6f}, reciprocity defect {:.2g}, {:.3g} s",
                                   facts.surfaces, facts.least_row_sum, facts.most_row_sum, facts.reciprocity_defect,
                                   facts.seconds));
    }
    return ExitCode::done;
}

}  // namespace exitance
