#include "exitance/cli/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/cli/option_kinds.hpp"
#include "exitance/core/nearest.hpp"

namespace exitance {
namespace {

using Parsed = std::variant<Command, Information>;

// -------------------------------------------------------------------------------------------------- parsing

/// The word in quotation marks or after a colon that CLI11 did not expect.
Error unexpected(const CLI::App& app, const std::vector<std::string>& words) {
    const std::string word = words.empty() ? "" : words.front();
    std::vector<std::string> known;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    const std::string near = word.starts_with("--") ? nearest(word.substr(0, word.find('=')), known) : "";
    return {ErrorCode::usage, fmt::format("'{}' is not understood", word), "",
            near.empty() ? app.get_name() + " --help lists the options" : fmt::format("did you mean {}?", near)};
}

/// CLI11's messages begin with the option's name where there is one; two of them need clearer words.
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

/// "--mesh export" as one word: what follows a flag is its value only where it says so.
std::vector<std::string> with_flag_values(const std::vector<std::string>& words) {
    std::vector<std::string> out;
    for (const std::string& word : words)
        if (word == "export" && !out.empty() && out.back() == "--mesh")
            out.back() += "=export";
        else
            out.push_back(word);
    return out;
}

template <class Arguments>
Result<Parsed> parse_verb(CLI::App& app, const std::vector<std::string>& words, const std::string& at_limit) {
    Arguments arguments;
    declare(app, arguments);
    declare_limits(app, arguments.limits, at_limit);
    declare_common(app, arguments);
    app.allow_extras();
    try {
        std::vector<std::string> backwards = with_flag_values(words);
        std::reverse(backwards.begin(), backwards.end());
        app.parse(std::move(backwards));
    } catch (const CLI::CallForHelp&) {
        return Parsed(Information{app.help()});
    } catch (const CLI::ParseError& error) {
        if (const std::vector<std::string> extras = app.remaining(); !extras.empty()) return unexpected(app, extras);
        return usage_error(app, error.what());
    }
    if (const std::vector<std::string> extras = app.remaining(); !extras.empty()) return unexpected(app, extras);
    return Parsed(Command(std::move(arguments)));
}

struct Verb {
    std::string name, does, example;
    Result<Parsed> (*read)(CLI::App&, const std::vector<std::string>&, const std::string& at_limit);
    /// What happens when a limit of time or memory is passed.
    std::string at_limit = "the run ends without a result, with status 5";

    Result<Parsed> parse(CLI::App& app, const std::vector<std::string>& words) const {
        return read(app, words, at_limit);
    }
};

const std::vector<Verb>& verbs() {
    static const std::vector<Verb> all{
        {"solve", "Computes the light in a scene.", "exitance solve room.obj -o room.h5", parse_verb<SolveArguments>,
         "the light found so far is written, with status 4"},
        {"probe", "Evaluates irradiance and radiosity at points.",
         "exitance probe room.h5 --points desks.csv -o light.csv", parse_verb<ProbeArguments>,
         "the rows finished so far are written, with status 4"},
        {"compare", "Tells how far a solution is from a reference.", "exitance compare room.h5 reference.csv",
         parse_verb<CompareArguments>},
        {"stats", "Tells what a solution took: counts, times, memory, error, energy balance.", "exitance stats room.h5",
         parse_verb<StatsArguments>},
        {"mix", "Dims groups of lamps and repaints materials of a solution, without solving it again.",
         "exitance mix room.h5 lamp=0.5 --reflectance wall=0.8,0.8,0.7 -o dimmed.h5", parse_verb<MixArguments>},
        {"export", "Writes a solution for other programs.", "exitance export room.h5 -o room.glb",
         parse_verb<ExportArguments>},
        {"render", "Makes a picture of a solution.", "exitance render room.h5 -o room.png", parse_verb<RenderArguments>,
         "the whole picture is written with fewer samples, with status 4"},
        {"bake", "Writes light maps: pictures of the light on every surface, and a model that shows them.",
         "exitance bake room.h5 -o lightmaps", parse_verb<BakeArguments>,
         "the maps of finished light groups are written, with status 4 (5 before all light is done)"},
        {"report", "Writes a page with pictures, tables, measuring planes, energy balance and error.",
         "exitance report room.h5 -o room.html", parse_verb<ReportArguments>,
         "the page is written with the parts that are finished, with status 4"},
        {"daylight", "Writes the daylight of a year at sensors: illuminances, autonomy, daylight factors.",
         "exitance daylight room.h5 --epw city.epw --points desks.pts -o year", parse_verb<DaylightArguments>},
        {"check", "Tells what is wrong with a scene and what was repaired.", "exitance check room.obj",
         parse_verb<CheckArguments>},
        {"generate", "Writes a scene of a built-in family.", "exitance generate complex m=6 -o complex.obj",
         parse_verb<GenerateArguments>},
        {"luminaire", "Tells the facts of a photometric file; draws its polar diagram and its opening.",
         "exitance luminaire downlight.ies -o downlight.svg", parse_verb<LuminaireArguments>},
        {"experiment", "Runs a study of methods: tables, plots, and a page of conclusions.",
         "exitance experiment blocker --quick -o blocker", parse_verb<ExperimentArguments>,
         "the page is written with the runs that are finished, with status 4"},
        {"viewfactors", "Writes the matrix of view factors between a scene's polygons.",
         "exitance viewfactors room.obj -o room.csv", parse_verb<ViewFactorArguments>},
        {"view", "Shows a solution in a browser, or a scene while it is solved.", "exitance view room.h5",
         parse_verb<ViewArguments>, "solving stops, and the light found so far stays on show"},
    };
    return all;
}

std::string help() {
    std::string text =
        "Example:\n  exitance solve room.obj -o room.h5\n\n"
        "Light in rooms of diffuse surfaces.\n\n"
        "Usage: exitance VERB [options] INPUT...\n\nVerbs:\n";
    for (const Verb& verb : verbs()) text += fmt::format("  {:<12} {}\n", verb.name, verb.does);
    return text +
           "\nexitance VERB --help describes a verb; exitance --version names the libraries built in.\n"
           "exitance --man is a manual page, exitance --completion bash a completion for the shell.\n";
}

/// Every option of a verb: the parser declares them before it meets --help.
std::vector<std::string> option_names(const Verb& verb) {
    CLI::App app(verb.does, "exitance " + verb.name);
    (void)verb.parse(app, {"--help"});
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

/// For bash: source <(exitance --completion bash)
std::string bash_completion() {
    std::vector<std::string> names;
    std::string cases;
    for (const Verb& verb : verbs()) {
        names.push_back(verb.name);
        cases += fmt::format("        {}) words='{}' ;;\n", verb.name, fmt::join(option_names(verb), " "));
    }
    return fmt::format(
        "_exitance() {{\n"
        "    local word=${{COMP_WORDS[COMP_CWORD]}} words=\n"
        "    if [[ $COMP_CWORD -eq 1 ]]; then\n"
        "        COMPREPLY=($(compgen -W '{} --help --version' -- \"$word\"))\n"
        "        return\n"
        "    fi\n"
        "    case ${{COMP_WORDS[1]}} in\n{}    esac\n"
        "    COMPREPLY=()\n"
        "    [[ $word == -* ]] && COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
        "}}\n"
        "complete -o default -F _exitance exitance\n",
        fmt::join(names, " "), cases);
}

/// Lines as they are, for roff.
std::string verbatim(const std::string& text) {
    std::string out = ".nf\n";
    bool begins = true;
    for (const char c : text) {
        if (begins && (c == '.' || c == '\'')) out += "\\&";
        if (c == '\\') out += '\\';
        if (c == '-') out += '\\';
        out += c, begins = c == '\n';
    }
    return out + (begins ? "" : "\n") + ".fi\n";
}

/// exitance --man | man -l -
std::string man_page() {
    std::string text = fmt::format(
        ".TH EXITANCE 1 \"\" \"exitance {}\"\n.SH NAME\nexitance \\- light in rooms of diffuse surfaces\n"
        ".SH SYNOPSIS\n.B exitance\n.I VERB\n[options]\n.I INPUT...\n",
        EXITANCE_VERSION);
    for (const Verb& verb : verbs()) {
        CLI::App app(fmt::format("{}\n\nExample: {}", verb.does, verb.example), "exitance " + verb.name);
        const Result<Parsed> parsed = verb.parse(app, {"--help"});
        text += fmt::format(".SH {}\n", verb.name) + verbatim(std::get<Information>(*parsed).text);
    }
    return text;
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

Result<Parsed> parse_arguments(const std::vector<std::string>& arguments) {
    if (arguments.empty()) return Error{ErrorCode::usage, "a verb is missing", "", "exitance --help lists the verbs"};
    const std::string& first = arguments.front();
    if (first == "--help" || first == "-h" || first == "help") return Parsed(Information{help()});
    if (first == "--version")
        return Parsed(Information{fmt::format("exitance {}\n{}\n", EXITANCE_VERSION, EXITANCE_LIBRARIES)});
    if (first == "--man") return Parsed(Information{man_page()});
    if (first == "--completion") {
        if (arguments.size() == 2 && arguments[1] == "bash") return Parsed(Information{bash_completion()});
        return Error{ErrorCode::usage, "is there for bash", "--completion", "source <(exitance --completion bash)"};
    }
    const auto verb = std::find_if(verbs().begin(), verbs().end(), [&](const Verb& v) { return v.name == first; });
    if (verb == verbs().end()) return unknown_verb(first);
    CLI::App app(fmt::format("Example:\n  {}\n\n{}", verb->example, verb->does), "exitance " + verb->name);
    return verb->parse(app, {arguments.begin() + 1, arguments.end()});
}

}  // namespace exitance
