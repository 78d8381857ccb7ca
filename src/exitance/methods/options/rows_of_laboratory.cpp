#include "exitance/methods/options/option_rows.hpp"

#include <fmt/format.h>

#include "exitance/methods/options/recipes.hpp"
#include "exitance/methods/options/value_kinds.hpp"

namespace exitance::option_rows {
namespace {

namespace group = option_groups;
using namespace option_values;

/// Value of --threshold. Published forms and the task engine store it in different members.
OptionValue threshold() {
    OptionValue out = positive("X", at(&ClassicalOptions::threshold));
    const auto value = [](const SolveRequest& r) {
        return r.options.classical.threshold ? r.options.classical.threshold : r.options.threshold;
    };
    out.word = [value](const SolveRequest& r) {
        const auto set = value(r);
        return set ? std::optional(text_of(*set)) : std::nullopt;
    };
    out.json = [value](const SolveRequest& r) {
        const auto set = value(r);
        return set ? text_of(*set) : "null";
    };
    return out;
}

OptionValue multigrid() {
    static constexpr double max_rounds = 40;
    OptionValue out = count(at(&ClassicalOptions::multigrid), 1);
    out.type = "N|off";
    out.read = [](const std::string& word, SolveRequest& r) -> std::string {
        if (word == "off") return r.options.classical.multigrid.reset(), "";
        const std::optional<double> value = number_in(word);
        if (!value || *value != std::floor(*value) || *value < 1 || *value > max_rounds)
            return fmt::format("must be 'off' or a whole number from 1 to {}, not '{}'", max_rounds, word);
        r.options.classical.multigrid = static_cast<std::size_t>(*value);
        return "";
    };
    return out;
}

/// Reads --snapshots: "rounds", "shots=100,1000" or "t=0.5,1,2" (seconds). Returns the message of an error.
std::string read_snapshots(const std::string& word, SnapshotPlan& plan) {
    if (word == "rounds") return plan.rounds = true, "";
    const bool shots = word.starts_with("shots="), times = word.starts_with("t=");
    const std::string wrong = fmt::format("'{}' is not 'rounds', 'shots=N,...' or 't=SECONDS,...'", word);
    if (!shots && !times) return wrong;
    std::string rest = word.substr(word.find('=') + 1);
    while (!rest.empty()) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        const std::optional<double> value = number_in(rest.substr(0, comma));
        if (!value || !(*value > 0) || *value > 1e15 || (shots && *value != std::floor(*value))) return wrong;
        if (shots)
            plan.shots.push_back(static_cast<std::size_t>(*value));
        else
            plan.seconds.push_back(*value);
        rest.erase(0, comma + 1);
    }
    return plan.any() ? "" : wrong;
}

OptionValue snapshots() {
    OptionValue out;
    out.type = "WHEN";
    out.read = [](const std::string& word, SolveRequest& r) {
        r.options.snapshots = {};
        return read_snapshots(word, r.options.snapshots);
    };
    out.word = [](const SolveRequest& r) -> std::optional<std::string> {
        const SnapshotPlan& plan = r.options.snapshots;
        if (!plan.any()) return {};
        return plan.rounds ? "rounds" : plan.shots.empty() ? "t" : "shots";
    };
    out.json = [](const SolveRequest&) { return "null"; };
    return out;
}

OptionValue recipe_name() {
    OptionValue out = text("NAME", at(&SolveRequest::recipe));
    out.read = [](const std::string& word, SolveRequest& r) -> std::string {
        if (find_recipe(word)) return r.recipe = word, "";
        const std::string near = nearest_recipe(word);
        return near.empty() ? fmt::format("there is no recipe '{}'; exitance solve --help-all lists them", word)
                            : fmt::format("there is no recipe '{}'; did you mean {}?", word, near);
    };
    return out;
}

std::vector<OptionRow> rows_of_recipes() {
    using C = ClassicalOptions;
    return {
        {.name = "--recipe",
         .value = recipe_name(),
         .does =
             "Set the options that reproduce a published method (list below); options given in addition replace these",
         .group = group::published},
        {.name = "--direct",
         .value = choice(classical_direct_names, at(&C::direct)),
         .does = "Direct light of emitters: computed exactly and separately, or carried by the method's own transport",
         .initial = "apart",
         .group = group::published,
         .support = {{every_published}},
         .section = "classical"},
        {.name = "--mesh",
         .value = choice(mesh_kind_names, at(&C::mesh)),
         .does = "Elements that follow contacts, edges and shadows, or elements by --mesh-size alone",
         .initial = "aligned; links make their own mesh",
         .group = group::published,
         .support = {{every_published, "uniform"}, {published({matrix, progressive, substructuring}), "aligned"}},
         .section = "classical"},
        {.name = "--certify",
         .value = on_off(at(&C::certify)),
         .does = "on: estimate the error; off: one attempt without an estimate, which selects the published form",
         .initial = "on",
         .group = group::published,
         .support = {{every_standard | local_passes, "on"}, {every_published, "off"}},
         .section = "classical"},
        {.name = "--threshold",
         .value = threshold(),
         .does = "Refine links above this form factor (--oracle ff) or power in W (--oracle bf, kernel)",
         .group = group::published,
         .support = {{published_links | tasks}},
         .needs = {{"--oracle ff|bf|kernel", "", Form::published}}},
        {.name = "--multigrid",
         .value = multigrid(),
         .does = "Rounds of refinement and solution, in each of which the threshold is halved",
         .initial = "off",
         .group = group::published,
         .support = {{published_links}},
         .needs = {{"--threshold"}},
         .section = "classical"},
        {.name = "--kernel",
         .value = choice(transfer_kernel_names, at(&C::kernel)),
         .does = "Form factor of a link: from point to point, to a disc, or exact",
         .initial = "exact",
         .group = group::published,
         .support = {{published_links}},
         .section = "classical"},
        {.name = "--refine-gradient",
         .value = positive("G", at(&C::refine_gradient)),
         .does = "Split elements across which radiosity changes by more than G, W/m^2",
         .group = group::published,
         .support = {{published({substructuring})}},
         .section = "classical"},
    };
}

std::vector<OptionRow> rows_of_published_solvers() {
    using C = ClassicalOptions;
    return {
        {.name = "--refine",
         .value = choice(refine_when_names, at(&C::refine)),
         .does = "Split elements during shooting, or after it",
         .initial = "during",
         .group = group::published,
         .support = {{published({substructuring})}},
         .needs = {{"--refine-gradient"}},
         .section = "classical"},
        {.name = "--sor-factor",
         .value = positive("W", at(&C::sor_factor), 2),
         .does = "Over-relaxation factor of --relaxation sor, between 0 and 2",
         .initial = "1.15",
         .group = group::published,
         .support = {{published({matrix})}},
         .needs = {{"--relaxation sor"}},
         .section = "classical"},
        {.name = "--ambient",
         .value = flag(at(&C::ambient)),
         .does = "Add an estimate of the unshot light to the result [Cohen88]",
         .group = group::published,
         .support = {{published({progressive, substructuring})}},
         .section = "classical"},
        {.name = "--snapshots",
         .value = snapshots(),
         .does =
             "Write intermediate solutions S.0001.h5, ...: t=0.5,1 (seconds), shots=10,100 or rounds (with --layers "
             "on: after each source)",
         .group = group::published,
         .support = {{every_published | tasks | local_passes, "t"},
                     {published({progressive, substructuring}), "shots"},
                     {published({matrix, hierarchical, wavelet}) | tasks | local_passes, "rounds"},
                     {standard({discontinuity}), "rounds", has_layers, with_layers}},
         .excludes = {{"--relaxation cg|gmres|chebyshev|direct"}, {"--resume"}},
         .section = "-"},
    };
}

std::vector<OptionRow> rows_of_structures() {
    using O = SolveOptions;
    return {
        {.name = "--task-engine",
         .value = flag(at(&O::task_engine)),
         .does = "Hierarchical radiosity as tasks that create tasks [Vinod95]; links also carry the emitters' light",
         .group = group::structures,
         .support = {{tasks}},
         .one_process = "*"},
        {.name = "--gcs",
         .value = choice(cells_names, at(&O::gcs)),
         .does = "Growing cells as published, with all light through the networks, or improved",
         .initial = "improved",
         .group = group::structures,
         .support = {{standard({growing_cells})}}},
        {.name = "--local-pass",
         .value = choice(local_pass_names, at(&O::local_pass)),
         .does =
             "Light at the nodes of a discontinuity mesh: a, that of the linked elements; b, by the links, with form "
             "factors at the node; c, also with visibility there; d, with visibility of primary sources only; e, with "
             "exact direct light",
         .initial = "e",
         .group = group::structures,
         .support = {{standard({discontinuity}), "e"}, {local_passes, "a|b|c|d"}}},
        {.name = "--triangulation",
         .value = choice(triangulation_choices, at(&DiscontinuityChoice::triangulation)),
         .does = "Triangulation of the faces between curves: Delaunay's, or the thesis's on convex receivers",
         .initial = "delaunay",
         .group = group::structures,
         .support = {{discontinuities}},
         .section = "discontinuity"},
        {.name = "--premesh",
         .value = choice(premesh_names, at(&DiscontinuityChoice::premesh)),
         .does = "Lines that are inserted first: none, those that bound penumbrae, or a coarse grid",
         .initial = "off",
         .group = group::structures,
         .support = {{discontinuities}},
         .needs = {{"--triangulation longest|shortest|heuristic", "penumbra-first|coarse"}},
         .section = "discontinuity"},
        {.name = "--dm-structure",
         .value = choice(structure_names, at(&DiscontinuityChoice::structure)),
         .does = "Search for blockers: shafts and a tree of boxes, or a BSP tree with shadow volumes, one by one or "
                 "merged into one tree per source",
         .initial = "bvh",
         .group = group::structures,
         .support = {{discontinuities}},
         .section = "discontinuity"},
        {.name = "--layers",
         .value = on_off(at(&DiscontinuityChoice::layers)),
         .does = "Make one compressed mesh per source, whose light is added up, in place of one mesh for all",
         .initial = "off",
         .when = "Solutions are then several times smaller; export, view and bake make the mesh for all when they need "
                 "it",
         .group = group::structures,
         .support = {{standard({discontinuity})}},
         .excludes = {{"--dm-element clough-tocher", "on"}},
         .section = "discontinuity"},
    };
}

std::vector<OptionRow> rows_of_old_names() {
    using C = ClassicalOptions;
    using O = SolveOptions;
    return {
        {.name = "--smoothing",
         .value = on_off(at(&O::smoothing)),
         .does = "Old name of --output-light elements (off) and smoothed-elements (on); will be removed in 0.4",
         .group = group::old_names,
         .support = {{every_standard | every_published | tasks}}},
        {.name = "--gather",
         .value = on_off(at(&C::gather)),
         .does = "Old name of --recipe classical-METHOD (off) and --output-light gathered (on); will be removed in 0.4",
         .group = group::old_names,
         .support = {{every_published}},
         .section = "classical"},
    };
}

}  // namespace

std::vector<OptionRow> of_laboratory() {
    return joined({rows_of_recipes(), rows_of_published_solvers(), rows_of_structures(), rows_of_old_names()});
}

}  // namespace exitance::option_rows
