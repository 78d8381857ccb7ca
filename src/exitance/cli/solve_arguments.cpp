#include "exitance/cli/classical_arguments.hpp"
#include "exitance/cli/discontinuity_arguments.hpp"
#include "exitance/cli/option_kinds.hpp"

namespace exitance {
namespace {

int read_bounces(const std::string& word) {
    if (word == "all") return all_bounces;
    const double value = read_number("--bounces", word);
    if (value != std::floor(value) || value < 0 || value > 1e9)
        throw CLI::ValidationError("--bounces", fmt::format("must be 'all' or a whole number from 0, not {}", word));
    return static_cast<int>(value);
}

constexpr std::array<std::pair<bool, std::string_view>, 2> quantity_kinds{
    {{false, "radiometric"}, {true, "photometric"}}};

void declare_accuracy(CLI::App& app, SolveOptions& o) {
    add_positive(app, "--error", o.error, "R", "Relative RMS error asked for; default 0.02")->group("Accuracy");
    add_positive(app, "--error-interpolant", o.error_interpolant, "R", "Relative RMS error asked of what export writes")
        ->group("Accuracy");
    add_positive(app, "--mesh-size", o.mesh_size, "METRES", "Longest edge of an element")->group("Accuracy");
    add_positive(app, "--min-area", o.min_area, "M2", "No element is cut smaller, m^2")->group("Accuracy");
    add_positive(app, "--residual", o.residual, "R", "Of the system, relative to its right side")->group("Accuracy");
    add_count(app, "--max-iterations", o.max_iterations, 1, "Sweeps, Krylov steps or shots")->group("Accuracy");
    add_positive(app, "--epsilon", o.epsilon, "R",
                 "Error of all links of a hierarchy together, relative RMS; has pairs judged")
        ->group("Accuracy");
}

void declare_method(CLI::App& app, SolveArguments& arguments) {
    SolveOptions& o = arguments.options;
    app.add_flag("--overshooting", o.overshooting, "Shoot ahead what will come back")->group("Method");
    add_choice(app, "--visibility", visibility_names, o.visibility, "Default auto")->group("Method");
    add_count(app, "--visibility-samples", o.visibility_samples, 1, "Rays a pair of elements")->group("Method");
    add_switch(app, "--triage", o.triage, "Links look for certain visibility before they cast rays; default on")
        ->group("Method");
    app.add_option_function<std::string>(
           "--clusters",
           [&o](const std::string& w) {
               o.clusters = w == "auto" ? std::nullopt : std::optional(read_switch("--clusters", w));
           },
           "Links between clusters of polygons, too; default auto: where they are many")
        ->type_name("auto|on|off")
        ->group("Method");
    add_switch(app, "--smoothing", o.smoothing,
               "Deliver the method's elements in place of gathering their light: smoothed, or (off) as they are, of "
               "hierarchies as links alone have them")
        ->group("Method");
    app.add_option("--importance", arguments.importance,
                   "Refine links for the light at these points (.csv or .pts, as of probe)")
        ->type_name("FILE")
        ->group("Method");
    app.add_flag("--keep-links", o.keep_links, "Put a hierarchy's links into the solution, for export --links")
        ->group("Method");
    app.add_flag(
           "--light-groups", arguments.light_groups,
           "Solve every group of emitters (g) by itself, too, and keep that for mix and view; takes as long as all "
           "these solves")
        ->group("Method");
    add_choice(app, "--oracle", oracle_names, o.oracle,
               "By what links are cut: error of what they bring (default), form factor, or power")
        ->group("Method");
    app.add_flag("--task-engine", o.task_engine,
                 "With --method hierarchical: as tasks that make tasks, the light of emitters through links, too")
        ->group("Method");
    add_choice(app, "--gcs", cells_names, o.gcs,
               "Growing cells as published, all light through the networks, or improved (default)")
        ->group("Method");
    add_count(app, "--max-units", o.max_units, 8, "Of each network of growing cells")->group("Method");
    add_choice(app, "--local-pass", local_pass_names, o.local_pass,
               "Of discontinuity meshing, at nodes: a leaves' light, b form factors anew, c visibility too, d that of "
               "primary sources alone, or e (default) those exactly")
        ->group("Method");
    add_count(app, "--hemicube-cells", o.hemicube_cells, 2, "Along an edge of a hemicube's top, even")->group("Method");
    add_count(app, "--seed", o.seed, 0, "Of the random numbers; default 1")->group("Method");
}

/// Options of methods in the form of their papers, which `classical_arguments` reads.
void declare_classical(CLI::App& app, SolveArguments& arguments) {
    for (const ClassicalArgument& option : classical_arguments()) {
        const auto read = [&arguments, &option](const std::string& word) {
            if (const std::string wrong = option.read(word, arguments); !wrong.empty())
                throw CLI::ValidationError(option.name, wrong);
        };
        CLI::Option* const declared =
            option.type.empty()
                ? app.add_flag_callback(
                      option.name, [read] { read(""); }, option.help)
                : app.add_option_function<std::string>(option.name, read, option.help)->type_name(option.type);
        declared->group(option.group);
    }
}

/// Options by which a long solve is planned, interrupted and resumed.
void declare_checkpoints(CLI::App& app, SolveArguments& arguments) {
    add_positive(app, "--checkpoint-every", arguments.checkpoint_every, "SECONDS",
                 "Keep the state in FILE.checkpoint beside the output")
        ->group("Limits");
    app.add_flag("--resume", arguments.resume, "Go on from that state, if there is one")->group("Limits");
    app.add_flag("--dry-run", arguments.dry_run, "Counts and a forecast; nothing is solved or written")
        ->group("Limits");
}

}  // namespace

void declare(CLI::App& app, SolveArguments& arguments) {
    SolveOptions& o = arguments.options;
    declare_scene(app, arguments.scene);
    app.add_option("-o,--output", arguments.output, "Solution to write (.h5)")->type_name("FILE");
    add_choice(app, "--method", method_names, o.method, "Default auto: what is best for the scene");
    add_choice(app, "--basis", basis_names, o.basis,
               "Of matrix: constant, linear, galerkin1 to 3; of wavelet: the others");
    app.callback([&o] {
        if (o.basis && !fits(*o.basis, o.method))
            throw CLI::ValidationError("--basis",
                                       fmt::format("method {} has no basis {}", name_in(method_names, o.method),
                                                   name_in(basis_names, *o.basis)));
        if ((o.gcs || o.max_units) && o.method != Method::growing_cells)
            throw CLI::ValidationError(o.gcs ? "--gcs" : "--max-units", "is obeyed by --method growing-cells alone");
        if (o.local_pass && o.method != Method::discontinuity)
            throw CLI::ValidationError("--local-pass", "is obeyed by --method discontinuity alone");
    });
    app.add_option_function<std::string>(
           "--bounces", [&o](const std::string& w) { o.bounces = read_bounces(w); },
           "0: direct light alone; default all")
        ->type_name("N|all");
    declare_accuracy(app, o);
    declare_method(app, arguments);
    declare_classical(app, arguments);
    declare_discontinuity(app, o);
    declare_checkpoints(app, arguments);
    declare_json(app, arguments);
    declare_work(app, arguments, o.threads);
    add_choice(app, "--quantity", quantity_kinds, arguments.photometric,
               "Is light given in watts or in lumens? Default by the file: photometric where glTF has lights");
    app.add_option("--sky", arguments.sky,
                   "Light from outside, such as 'perez,lat=47.4,lon=8.5,time=06-21T12:00,dni=700,dhi=120'; uniform, "
                   "overcast, clear, cie1 to cie15 and perez, see docs/daylight.md")
        ->type_name("SKY");
    app.add_option("--epw", arguments.epw, "Weather file: place and irradiances of the sky that --sky names")
        ->type_name("FILE");
    add_choice(app, "--schedule", schedule_names, o.schedule,
               "How work comes to threads; default stealing. The result does not depend on it");
    app.add_option("--trace", arguments.trace, "Write every task's time, thread and data (Chrome trace format, .json)")
        ->type_name("FILE");
}

}  // namespace exitance
