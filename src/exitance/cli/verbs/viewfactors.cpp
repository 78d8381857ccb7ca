#include <fmt/format.h>

#include <algorithm>

#include "exitance/cli/json_output.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/view_factor_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/scenes/view3d.hpp"
#include "exitance/view_factors/ray_check.hpp"

namespace exitance {
namespace {

ViewFactorFacts facts_of(const ViewFactors& table, double tolerance, const RayCheck& check, double seconds) {
    ViewFactorFacts facts;
    facts.surfaces = table.size(), facts.seconds = seconds;
    facts.reciprocity_defect = table.reciprocity_defect;
    facts.tolerance = tolerance, facts.entry_defect = table.entry_defect;
    facts.mended = table.mended, facts.unsettled = table.unsettled;
    facts.check = check;
    if (table.size() > 0) {
        const auto [least, most] = std::minmax_element(table.row_sums.begin(), table.row_sums.end());
        facts.least_row_sum = *least;
        facts.most_row_sum = *most;
    }
    return facts;
}

std::string words_of(const ViewFactorFacts& facts) {
    std::string text = fmt::format(
        "{} surfaces, row sums from {:.6f} to {:.6f}, {:.3g} s\n"
        "reciprocity: entries above 1e-6 agree to {:.2g}, {:.2g} of their rows' largest; {} pairs computed again\n",
        facts.surfaces, facts.least_row_sum, facts.most_row_sum, facts.seconds, facts.entry_defect,
        facts.reciprocity_defect, facts.mended);
    const RayCheck& check = facts.check;
    if (check.entries > 0)
        text += fmt::format(
            "rays: {} entries drawn by lot, {} off by more than the tolerance and six standard errors of {} "
            "rays each; farthest off by {:.2g} of the entry, where rays may err by {:.2g} (usually {:.2g})\n",
            check.entries, check.wrong, check.rays / check.entries, check.largest_relative, check.relative_error_there,
            check.usual_relative_error);
    return text;
}

/// What a file of View3D calls surfaces: groups of faces, and some that only block.
ViewFactors rows_of_view3d(const Scene& scene, const ViewFactors& table) {
    std::vector<std::uint32_t> rows;
    std::size_t count = scene.groups().size();
    for (GroupId g : scene.groups().ids())
        if (scene.groups()[g] == view3d_obstructions) --count;
    for (const Surface& surface : scene.surfaces())
        rows.push_back(scene.groups()[surface.group] == view3d_obstructions ? no_row : surface.group.value);
    return merge_rows(table, rows, count);
}

/// That nothing shines does not matter here.
void show_findings(const CheckedScene& checked, Terminal& terminal) {
    std::vector<Finding> findings = checked.findings;
    std::erase_if(findings, [](const Finding& f) {
        return f.kind == Finding::Kind::warning && f.message.starts_with("nothing emits light");
    });
    terminal.show(findings);
}

}  // namespace

/// exitance viewfactors SCENE -o MATRIX
ExitCode run(const ViewFactorArguments& arguments, Terminal& terminal) {
    RunLimits& limits = terminal.limits();
    const StopRequest& stop = limits.keep();
    set_threads(arguments.threads);
    if (const Result<AtomicFile> file = AtomicFile::create(arguments.output); !file) return terminal.fail(file.error());
    const auto fail = [&](const Error& error) { return limits.signal() ? *limits.signal() : terminal.fail(error); };

    LoadOptions load = arguments.scene.load;
    load.stop = &stop;
    const CheckedScene checked = load_scene(arguments.scene.files, load);
    show_findings(checked, terminal);
    if (!checked.scene) return terminal.fail(checked);
    const Scene& scene = *checked.scene;

    const Stopwatch time;
    Result<ViewFactors> table = compute_view_factors(scene, arguments.tolerance, terminal.progress(), stop);
    if (!table) return fail(table.error());
    const double seconds = time.seconds();
    terminal.progress().phase("check by rays");
    const RayCheck check = check_by_rays(
        scene, *table, {arguments.check, arguments.check_rays, arguments.seed, arguments.tolerance}, stop);
    if (!check.is_complete)
        return fail(
            {ErrorCode::limit, "stopped while entries were checked by rays", "", "allow more time, or --check 0"});
    if (ending(arguments.scene.files.front()) == ".vs3") *table = rows_of_view3d(scene, *table);
    const ViewFactorFacts facts = facts_of(*table, arguments.tolerance, check, seconds);
    if (const Result<void> written = write_view_factors(arguments.output, *table, stop); !written)
        return fail(written.error());

    if (arguments.json)
        terminal.print(view_factors_json(facts));
    else if (!arguments.quiet)
        terminal.print(words_of(facts));
    if (facts.unsettled > 0)
        terminal.note(fmt::format("warning: the entries of {} pairs of faces still disagree by more than {:g}",
                                  facts.unsettled, arguments.tolerance));
    if (check.wrong > 0)
        terminal.note(fmt::format("warning: {} of {} entries that rays checked are off by more than {:g}", check.wrong,
                                  check.entries, arguments.tolerance));
    return facts.unsettled + check.wrong == 0 ? ExitCode::done : ExitCode::demand_not_reached;
}

}  // namespace exitance
