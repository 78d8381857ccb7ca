// Options of the verbs for view factors: viewfactors, view3d and heat.
#include "exitance/cli/options/option_kinds.hpp"
#include "exitance/view_factors/accuracy.hpp"

namespace exitance {
namespace {

constexpr auto factor_format_names = [] {
    std::array<std::pair<FactorFormat, std::string_view>, factor_formats.size()> out;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = {factor_formats[i].format, factor_formats[i].name};
    return out;
}();

/// Declares an option whose value is a number from `least` to `most`.
CLI::Option* add_range(CLI::App& app, const char* name, std::optional<double>& value, double least, double most,
                       const char* help) {
    const auto read = [=, &value](const std::string& word) {
        value = read_number(name, word);
        if (!(*value >= least && *value <= most))
            throw CLI::ValidationError(name, fmt::format("must be between {} and {}, not {}", least, most, word));
    };
    return app.add_option_function<std::string>(name, read, help)->type_name("R");
}

}  // namespace

void declare(CLI::App& app, View3dArguments& arguments) {
    app.add_option("IN", arguments.input,
                   "Input file of View3D (.vs3). Its controls out (0 text, 1 binary), encl and emit are used")
        ->type_name("IN")
        ->required();
    app.add_option("OUT", arguments.output, "File with the factors (.vf) to write")->type_name("OUT")->required();
    add_range(app, "--error", arguments.error, min_row_error, max_row_error,
              "Error of every row, found by rays. Default: the file's eps, at least 1e-3. An eps below 1e-4, or below "
              "1e-3 in scenes of up to 40 faces, is the tolerance of every factor, without rays");
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, HeatArguments& arguments) {
    app.add_option("FACTORS", arguments.factors, "View factors, written by viewfactors as .h5, or an operator")
        ->type_name("FACTORS")
        ->required();
    app.add_option(
           "--table", arguments.table,
           "CSV file with columns surface (its number, 0: all), and any of emissivity, temperature (K) and heat "
           "(net heat that leaves the surface, W)")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", arguments.output,
                   "CSV file to write: temperature, radiosity and net heat of every surface")
        ->type_name("FILE");
    app.add_option("--exchange", arguments.exchange,
                   "CSV file to write: exchange factors (script F) between all surfaces of given temperature")
        ->type_name("FILE");
    app.add_option("--gebhart", arguments.gebhart,
                   "CSV file to write: Gebhart's factors, which are exchange factors divided by the row's emissivity")
        ->type_name("FILE");
    app.add_option_function<std::string>(
           "--surroundings",
           [&arguments](const std::string& word) {
               arguments.surroundings = read_number("--surroundings", word);
               if (!(*arguments.surroundings >= 0))
                   throw CLI::ValidationError("--surroundings", fmt::format("must be at least 0, not {}", word));
           },
           "Temperature of the surroundings behind openings, K. Default: none; the surfaces must be an enclosure")
        ->type_name("K");
    declare_json(app, arguments);
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, ViewFactorArguments& arguments) {
    declare_scene(app, arguments.scene);
    app.add_option(
           "-o,--output", arguments.output,
           "Matrix to write: .csv, .vf (View3D), .idf (EnergyPlus), or sparse: .mtx (Matrix Market), .h5. A folder "
           "with --format openfoam. May be left out with --operator")
        ->type_name("FILE");
    CLI::Option* const transport =
        app.add_option("--operator", arguments.operator_file,
                       "File to write (.h5): an operator for solvers, with products F x and F^T x, in which far faces "
                       "share entries. Use it for 10^5 to 10^6 faces, with --error 1e-2 or 3e-3")
            ->type_name("FILE");
    add_choice(app, "--format", factor_format_names, arguments.format,
               "Format of the output. Default: given by the file's ending; csv for unknown endings. pairs: a line "
               "from_id,to_id,F per entry");
    app.add_flag("--sky", arguments.with_sky,
                 "Add columns for the sky and for backs of faces to csv, mtx and pairs; .h5 always has them. Not with "
                 "--tolerance");
    app.add_option("--nodes", arguments.nodes,
                   "Make one row per node: per group, per material, or per node in a table (.csv) with the columns "
                   "face,node. "
                   "Default: one row per face")
        ->type_name("group|material|FILE");
    app.add_option("--zone", arguments.zone, "Name of the zone or enclosure in EnergyPlus. Default zone")
        ->type_name("NAME");
    app.add_option(
           "--emissivity", arguments.emissivity,
           "Add exchange factors (script F) and Gebhart's factors of grey surfaces to .h5. kd: emissivities are "
           "1 - Kd; or a table (.csv) as for heat")
        ->type_name("kd|FILE");
    CLI::Option* const error =
        add_range(app, "--error", arguments.error, min_row_error, max_row_error,
                  "Limit on the error of every row, which at most one row in 100 exceeds. Default 1e-3. "
                  "Use it for heat balances");
    add_range(
        app, "--tolerance", arguments.tolerance, min_entry_error, max_entry_error,
        "Relative error of every entry above 1e-6, instead of --error. It is slower; use it if single entries matter")
        ->excludes(error)
        ->excludes(transport);
    add_positive(app, "--smallest", arguments.smallest, "F", "Leave out entries below F. Default: none");
    add_count(app, "--check", arguments.check, 0,
              "Number of random rows that are checked by ray casting. Default 4. With --tolerance: random entries, "
              "default 100");
    add_count(app, "--check-rays", arguments.check_rays, 64,
              "Rays per checked row. Default 0.2 / R^2, from 8192 to 524288. With --tolerance: rays per checked entry, "
              "default 16384");
    add_count(app, "--seed", arguments.seed, 0, "Seed of all random numbers. Default 1");
    app.add_flag("--resume", arguments.resume, "Continue from the rows in FILE.rows, which a stopped run leaves");
    declare_json(app, arguments);
    declare_work(app, arguments, arguments.threads);
}

}  // namespace exitance
