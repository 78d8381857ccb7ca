#include "exitance/cli/options/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/base/nearest.hpp"
#include "exitance/base/version.hpp"
#include "exitance/cli/libraries.hpp"
#include "exitance/cli/named_files.hpp"
#include "exitance/cli/options/option_kinds.hpp"
#include "exitance/cli/reference/pages.hpp"
#include "exitance/methods/options/solve_option_table.hpp"
#include "exitance/methods/options/support.hpp"

namespace exitance {
namespace {

using Parsed = std::variant<Command, Information>;

// -------------------------------------------------------------------------------------------------- parsing

/// Error for the first of `words`, which CLI11 did not recognize. The hint names the most similar option, or --points
/// for a file of points.
Error unexpected(const CLI::App& app, const std::vector<std::string>& words) {
    const std::string word = words.empty() ? "" : words.front();
    std::vector<std::string> known;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    const bool are_points = word.ends_with(".csv") || word.ends_with(".pts");
    if (are_points && std::find(known.begin(), known.end(), "--points") != known.end())
        return {ErrorCode::usage, fmt::format("'{}' is not a known option or argument", word), "",
                fmt::format("name a file of points by its option: --points {}", word)};
    if (word == "--threads") return {ErrorCode::usage, "this verb uses one thread only", word, "leave the option out"};
    const std::string near = word.starts_with("--") ? nearest(word.substr(0, word.find('=')), known) : "";
    return {ErrorCode::usage, fmt::format("'{}' is not a known option or argument", word), "",
            near.empty() ? app.get_name() + " --help lists the options" : fmt::format("did you mean {}?", near)};
}

/// Error from a message of CLI11, which begins with the name of an option and a colon if it concerns one. Two messages
/// are replaced by clearer ones.
Error usage_error(const CLI::App& app, const std::string& what) {
    Error error{ErrorCode::usage, what, "", app.get_name() + " --help shows how it is used"};
    if (const std::size_t colon = what.find(": "); what.starts_with("-") && colon != std::string::npos) {
        error.where = what.substr(0, colon);
        error.message = what.substr(colon + 2);
        if (error.message.ends_with(" missing")) error.message = "its value is missing";
        if (error.message.starts_with("At Most 1 required")) error.message = "is given more than once";
    }
    return error;
}

/// Joins "--mesh" and "export" to "--mesh=export". CLI11 accepts an optional value of a flag only after "=".
std::vector<std::string> with_flag_values(const std::vector<std::string>& words) {
    std::vector<std::string> out;
    for (const std::string& word : words)
        if (word == "export" && !out.empty() && out.back() == "--mesh")
            out.back() += "=export";
        else
            out.push_back(word);
    return out;
}

Audience audience_of(const std::string& group) {
    const auto* const known = std::find_if(std::begin(option_groups::all), std::end(option_groups::all),
                                           [&](const OptionGroup& g) { return g.title == group; });
    return known == std::end(option_groups::all) ? Audience::users : known->audience;
}

/// " with off" if all methods of a form support the same part of an option's values; otherwise empty.
std::string supported_values(const OptionRow& row, Form form) {
    std::optional<std::string> values;
    for (const OptionSupport& support : row.support)
        for (const auto& [method, name] : method_names) {
            if (!support.forms.contains({form, method})) continue;
            if (values && *values != support.values) return "";
            values = support.values;
        }
    if (!values || values->empty()) return "";
    std::string out = " with ";
    for (const char c : *values) out += c == '|' ? std::string(", ") : std::string(1, c);
    return out;
}

/// Names of the methods, and of the methods' published forms, that support an option of `solve`; empty: no limitation.
std::string supported_by(const std::string& option) {
    const OptionRow* const row = find_option(option);
    if (!row || row->support.empty()) return "";
    const auto methods = [&](Form form) { return supporting_methods(*row, form); };
    const auto all = [&](Form form) { return supporting_methods({}, form) == methods(form); };
    std::string out;
    const auto add = [&](const std::string& words) { out += (out.empty() ? "" : "; ") + words; };
    const auto add_form = [&](Form form, const std::string& words) { add(words + supported_values(*row, form)); };
    if (const std::string found = methods(Form::standard); !found.empty())
        all(Form::standard) ? add_form(Form::standard, "all methods") : add(found);
    if (const std::string found = methods(Form::published); !found.empty())
        all(Form::published) ? add_form(Form::published, "all published forms") : add("published: " + found);
    if (option == "--task-engine") return methods(Form::tasks);
    if (!methods(Form::tasks).empty()) add_form(Form::tasks, "--task-engine");
    if (option != "--local-pass" && !methods(Form::local_passes).empty())
        add_form(Form::local_passes, "--local-pass a to d");
    return out;
}

/// Facts about a declared option. The type of an input is its name. Additions of CLI11 to types are omitted.
OptionFacts facts_of(const CLI::Option& option) {
    OptionFacts out;
    if (!option.get_snames().empty()) out.short_name = "-" + option.get_snames().front();
    if (!option.get_lnames().empty()) out.long_name = "--" + option.get_lnames().front();
    const std::string type = option.get_items_expected_max() == 0 ? "" : option.get_type_name();
    out.type = out.is_input() ? option.get_name(true) : type.substr(0, type.find(':'));
    if (out.is_input() && option.get_items_expected_max() > 1) out.type += "...";
    out.help = option.get_description(), out.group = option.get_group();
    out.audience = audience_of(out.group), out.is_required = option.get_required();
    if (out.help.find_last_of('.') + 1 != out.help.size()) out.help += '.';
    return out;
}

template <class Arguments>
void declare_all(CLI::App& app, Arguments& arguments, const std::string& at_limit) {
    declare(app, arguments);
    declare_limits(app, arguments.limits, at_limit);
    declare_common(app, arguments);
    app.set_help_flag("-h,--help", "Show the options for users")->group("Run");
    app.set_help_all_flag("--help-all", "Show all options")->group("Run");
}

template <class Arguments>
VerbFacts facts_of_verb(const std::string& name, const std::string& does, const std::string& example,
                        const std::string& at_limit) {
    CLI::App app(does, "exitance " + name);
    Arguments arguments;
    declare_all(app, arguments, at_limit);
    VerbFacts out{name, does, example, {}};
    for (const CLI::Option* option : app.get_options()) out.options.push_back(facts_of(*option));
    std::stable_partition(out.options.begin(), out.options.end(), [](const OptionFacts& o) { return o.is_input(); });
    if constexpr (std::is_same_v<Arguments, SolveArguments>)
        for (OptionFacts& option : out.options) option.supported_by = supported_by(option.long_name);
    return out;
}

/// Error for an option or input with an empty value, such as that of an unset variable of the shell.
Result<void> check_values(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options())
        for (const std::string& value : option->results())
            if (value.empty() && option->get_items_expected_max() > 0)
                return Error{ErrorCode::usage, "its value is empty", option->get_name(),
                             "give a value, or leave the option out"};
    return {};
}

/// The values of options and inputs, which may be names of files.
std::vector<NamedFile> named_files(const CLI::App& app) {
    constexpr std::string_view outputs[]{"--output",  "OUT",      "--operator", "--exchange",
                                         "--gebhart", "--charts", "--picture",  "--trace"};
    std::vector<NamedFile> out;
    for (const CLI::Option* option : app.get_options()) {
        const std::string name = option->get_name();
        const bool is_output = std::find(std::begin(outputs), std::end(outputs), name) != std::end(outputs);
        for (const std::string& value : option->results()) out.push_back({name, value, is_output});
    }
    return out;
}

template <class Arguments>
Result<Parsed> parse_verb(CLI::App& app, const std::vector<std::string>& words, const std::string& at_limit) {
    Arguments arguments;
    declare_all(app, arguments, at_limit);
    app.allow_extras();
    try {
        std::vector<std::string> backwards = with_flag_values(words);
        std::reverse(backwards.begin(), backwards.end());
        app.parse(std::move(backwards));
    } catch (const CLI::ParseError& error) {
        if (const std::vector<std::string> extras = app.remaining(); !extras.empty()) return unexpected(app, extras);
        return usage_error(app, error.what());
    }
    if (const std::vector<std::string> extras = app.remaining(); !extras.empty()) return unexpected(app, extras);
    if (const Result<void> given = check_values(app); !given) return given.error();
    // A mixed solution keeps the groups as they were, so that it may replace its input.
    if constexpr (!std::is_same_v<Arguments, MixArguments>)
        if (const Result<void> fit = check_named_files(named_files(app)); !fit) return fit.error();
    return Parsed(Command(std::move(arguments)));
}

struct Verb {
    std::string name, does, example;
    Result<Parsed> (*read)(CLI::App&, const std::vector<std::string>&, const std::string& at_limit);
    VerbFacts (*describe)(const std::string& name, const std::string& does, const std::string& example,
                          const std::string& at_limit);
    /// Effect of an exceeded limit of time or memory, as a clause of the help.
    std::string at_limit;

    VerbFacts facts() const { return describe(name, does, example, at_limit); }
};

/// Returns the verb of a type of arguments.
template <class Arguments>
Verb verb(std::string name, std::string does, std::string example,
          std::string at_limit = "the run ends without a result, with status 5") {
    return {std::move(name),       std::move(does),          std::move(example),
            parse_verb<Arguments>, facts_of_verb<Arguments>, std::move(at_limit)};
}

const std::vector<Verb>& verbs() {
    static const std::vector<Verb> all{
        verb<SolveArguments>("solve", "Computes the light in a scene.", "exitance solve room.obj -o room.h5",
                             "the light found so far is written, with status 4"),
        verb<ProbeArguments>("probe", "Evaluates irradiance and radiosity at points.",
                             "exitance probe room.h5 --points desks.csv -o light.csv",
                             "the rows finished so far are written, with status 4"),
        verb<CompareArguments>("compare", "Measures the error of a solution against a reference.",
                               "exitance compare room.h5 reference.csv"),
        verb<StatsArguments>("stats", "Prints counts, times, memory, error and energy balance of a solution.",
                             "exitance stats room.h5"),
        verb<MixArguments>("mix", "Dims light groups and changes reflectances of a solution, without solving again.",
                           "exitance mix room.h5 lamp=0.5 --reflectance wall=0.8,0.8,0.7 -o dimmed.h5"),
        verb<ExportArguments>("export", "Writes a solution for other programs.", "exitance export room.h5 -o room.glb"),
        verb<RenderArguments>("render", "Makes a picture of a solution.", "exitance render room.h5 -o room.png",
                              "the whole picture is written with fewer samples, with status 4"),
        verb<BakeArguments>(
            "bake", "Writes light maps, and a model that shows them.", "exitance bake room.h5 -o lightmaps",
            "the maps of finished light groups are written, with status 4 (5 before all light is done)"),
        verb<LightProbeArguments>("probes",
                                  "Writes light probes for moving objects: light at points, as spherical harmonics.",
                                  "exitance probes room.h5 --grid \"0.5,0.5,0.5 1,1,1 3,2,2\" -o probes.json"),
        verb<ReportArguments>("report",
                              "Writes a page with pictures, tables, measuring planes, energy balance and error.",
                              "exitance report room.h5 -o room.html",
                              "the page is written with the parts that are finished, with status 4"),
        verb<GlareArguments>("glare", "Computes the daylight glare probability (DGP) at eye points.",
                             "exitance glare room.h5 --observers \"1,2,1.2 0,1,0\""),
        verb<DaylightArguments>("daylight",
                                "Writes a year of daylight at sensors: illuminances, autonomy, daylight factors.",
                                "exitance daylight room.h5 --epw city.epw --points desks.pts -o year"),
        verb<CheckArguments>("check", "Reports the faults of a scene, and how they are repaired.",
                             "exitance check room.obj"),
        verb<GenerateArguments>("generate", "Writes a scene of a built-in family.",
                                "exitance generate complex m=6 -o complex.obj"),
        verb<LuminaireArguments>("luminaire",
                                 "Prints the data of a photometric file; draws its polar diagram and its opening.",
                                 "exitance luminaire downlight.ies -o downlight.svg"),
        verb<ExperimentArguments>("experiment", "Runs a study of methods: tables, plots, and a page of conclusions.",
                                  "exitance experiment blocker --quick -o blocker",
                                  "the page is written with the runs that are finished, with status 4"),
        verb<ViewFactorArguments>("viewfactors", "Writes the matrix of view factors between a scene's polygons.",
                                  "exitance viewfactors room.obj -o room.csv",
                                  "finished rows are written, with status 4; --resume continues from them"),
        verb<View3dArguments>("view3d",
                              "Computes view factors in place of NIST's View3D, with the same input and output files.",
                              "exitance view3d room.vs3 room.vf", "no file is written, with status 5"),
        verb<HeatArguments>("heat", "Computes the radiative heat exchange between grey surfaces from view factors.",
                            "exitance heat room_factors.h5 --table temperatures.csv -o heat.csv"),
        verb<SweepArguments>("sweep", "Runs variants of a scene and of options, and collects their results.",
                             "exitance sweep plan.toml --local 4",
                             "running steps end, and finished ones are kept, with status 4"),
        verb<ViewArguments>("view", "Shows a solution in a browser, or a scene while it is solved.",
                            "exitance view room.h5", "solving stops, and the light found so far remains visible"),
        verb<ReferenceArguments>("reference", "Prints a manual page, a completion for the shell, or all options.",
                                 "exitance reference --format man | man -l -"),
    };
    return all;
}

std::string help() {
    std::string text =
        "Example:\n  exitance solve room.obj -o room.h5\n\n"
        "Light in rooms of diffuse surfaces.\n\n"
        "Usage: exitance VERB [options] INPUT...\n\nVerbs:\n";
    for (const Verb& verb : verbs())
        if (verb.name != "reference") text += fmt::format("  {:<12} {}\n", verb.name, verb.does);
    return text +
           "\nexitance VERB --help describes a verb; exitance --version names the libraries built in.\n"
           "exitance reference --format man|bash|zsh prints a manual page or a completion for the shell.\n";
}

Error unknown_verb(const std::string& word) {
    std::vector<std::string> names;
    for (const Verb& verb : verbs()) names.push_back(verb.name);
    const std::string near = nearest(word, names);
    return {ErrorCode::usage, fmt::format("there is no verb '{}'", word), "",
            near.empty() ? fmt::format("the verbs are {}", fmt::join(names, ", "))
                         : fmt::format("did you mean '{}'?", near)};
}

}  // namespace

std::vector<VerbFacts> facts_of_verbs() {
    std::vector<VerbFacts> out;
    for (const Verb& verb : verbs()) out.push_back(verb.facts());
    return out;
}

Result<Parsed> parse_arguments(const std::vector<std::string>& arguments) {
    if (arguments.empty()) return Error{ErrorCode::usage, "a verb is missing", "", "exitance --help lists the verbs"};
    const std::string& first = arguments.front();
    if (first == "help" && arguments.size() > 1) return parse_arguments({arguments[1], "--help"});
    if (first == "--help" || first == "-h" || first == "help") return Parsed(Information{help()});
    if (first == "--version")
        return Parsed(Information{fmt::format("exitance {}\n{}\n", program_version, program_libraries)});
    const std::vector<std::string> rest(arguments.begin() + 1, arguments.end());
    if (first == "--man") return parse_arguments({"reference", "--format", "man"});
    if (first == "--completion") return parse_arguments({"reference", "--format", rest.empty() ? "" : rest.front()});
    const auto verb = std::find_if(verbs().begin(), verbs().end(), [&](const Verb& v) { return v.name == first; });
    if (verb == verbs().end()) return unknown_verb(first);
    for (const std::string& word : rest) {
        if (word == "--") break;
        if (word == "--help" || word == "-h" || word == "--help-all")
            return Parsed(Information{help_page(verb->facts(), word == "--help-all")});
    }
    CLI::App app(verb->does, "exitance " + verb->name);
    return verb->read(app, rest, verb->at_limit);
}

}  // namespace exitance
