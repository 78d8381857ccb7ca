#include <cstdio>

#include "exitance/cli/options/option_kinds.hpp"
#include "exitance/io/report/requirements.hpp"

namespace exitance {
namespace {

/// Reads a plane, such as "0.75", "desk" or "desk,height=0.1,border=0.2,spacing=0.5", in metres.
PlaneRequest read_request(const std::string& option, const std::string& words) {
    PlaneRequest out;
    std::istringstream in(words);
    std::string word;
    std::getline(in, word, ',');
    if (double height = 0; CLI::detail::lexical_cast(word, height))
        out.height = read_number(option, word);
    else
        out.group = word;
    if (word.empty())
        throw CLI::ValidationError(option, "must begin with a height in metres or the name of a group of faces");
    while (std::getline(in, word, ',')) {
        const std::size_t at = word.find('=');
        const std::string key = word.substr(0, at);
        const double value = at == std::string::npos ? -1 : read_number(option, word.substr(at + 1));
        const bool is_width = key == "spacing" || key == "around" || key == "background";
        const bool known = is_width || key == "height" || key == "border";
        if (!known || !(value >= 0) || (is_width && value == 0))
            throw CLI::ValidationError(
                option, fmt::format("'{}' is not height=H, border=B, spacing=S, around=W or background=W", word));
        if (key == "height") out.height = value;
        if (key == "border") out.border = value;
        if (key == "spacing") out.spacing = value;
        if (key == "around") out.surroundings = value;
        if (key == "background") out.background = value;
    }
    if ((out.surroundings || out.background) && out.group.empty())
        throw CLI::ValidationError(option, "around=W and background=W need a task area: the name of faces");
    return out;
}

CLI::Option* add_planes(CLI::App& app, const std::string& name, std::vector<PlaneRequest>& planes, bool cylindrical,
                        const std::string& help) {
    const auto read = [name, cylindrical, &planes](const std::vector<std::string>& all) {
        for (const std::string& words : all) {
            planes.push_back(read_request(name, words));
            planes.back().is_cylindrical = cylindrical;
            if (cylindrical && !planes.back().height) throw CLI::ValidationError(name, "needs a height in metres");
        }
    };
    return app.add_option_function<std::vector<std::string>>(name, read, help)
        ->type_name("PLANE")
        ->expected(1)
        ->take_all();
}

CLI::Option* add_observers(CLI::App& app, std::vector<std::string>& observers, const std::string& help) {
    return app.add_option("--observers", observers, help)->type_name("OBSERVERS")->expected(1)->take_all();
}

/// Reads a threshold of glare, such as "2000" (cd/m^2) or "5x" (times the mean luminance).
GlareThreshold read_threshold(const std::string& word) {
    GlareThreshold out;
    out.is_multiple = word.ends_with('x');
    out.value = read_number("--threshold", out.is_multiple ? word.substr(0, word.size() - 1) : word);
    if (!(out.value > 0))
        throw CLI::ValidationError(
            "--threshold", fmt::format("'{}' is neither a luminance such as 2000 nor a multiple such as 5x", word));
    return out;
}

void add_heading(CLI::App& app, ReportHeading& heading) {
    const auto add_text = [&](const char* name, std::string& text, const char* help) {
        app.add_option(name, text, help)->type_name("TEXT");
    };
    add_text("--title", heading.title, "Title of the page. Default: 'Light in', and the scene's file");
    add_text("--project", heading.project, "Project, for the first page");
    add_text("--client", heading.client, "Client, for the first page");
    add_text("--author", heading.author, "Author, for the first page");
    add_text("--date", heading.date, "Date, for the first page");
}

}  // namespace

void declare(CLI::App& app, GlareArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution file (.h5), as solve writes it")->required();
    add_observers(app, arguments.observers,
                  "Observers: 'x,y,z dx,dy,dz' (eye and line of sight), a table (CSV x,y,z,dx,dy,dz), a Honeybee model "
                  "with views, or auto: at 1.2 m in the middle of each wall. May be given several times")
        ->required();
    app.add_option_function<std::string>(
           "--threshold", [&arguments](const std::string& word) { arguments.threshold = read_threshold(word); },
           "Luminance above which a part of the view is a source of glare: cd/m^2, or 5x for 5 times the mean "
           "luminance in view. Default 2000")
        ->type_name("LUMINANCE");
    add_positive(app, "--efficacy", arguments.efficacy, "LM/W",
                 "Luminous efficacy of light in watts. Default 179 lm/W");
    declare_json(app, arguments);
    declare_work(app, arguments, arguments.threads);
}

void declare_standards(CLI::App& app, ReportArguments& arguments) {
    add_planes(
        app, "--plane", arguments.working_planes, false,
        "Working plane of EN 12464-1: a height above the floor, '0.75', or named faces: 'desk' (light on them) or "
        "'hall,height=0.75' (above them). After commas, all in metres: border=B, the strip along walls that does "
        "not count (default 0.5 above floors); spacing=S, the distance of points (default that of the standard); "
        "around=W and background=W, widths of the surroundings of named faces and of the background around "
        "these, which are then measured, too. May be given several times");
    add_planes(app, "--cylindrical", arguments.working_planes, true,
               "Plane on which cylindrical illuminance is measured, such as '1.2' (metres above the floor) or "
               "'hall,height=1.6'. May be given several times");
    add_positive(app, "--maintenance", arguments.maintenance, "FACTOR",
                 "Maintenance factor, at most 1, by which light on planes is multiplied. Default 1")
        ->check(CLI::Range(0.0, 1.0));
    add_observers(
        app, arguments.observers,
        "Observers for glare (UGR): 'x,y,z dx,dy,dz' (eye and line of sight), a table (CSV x,y,z,dx,dy,dz), "
        "a Honeybee model with views, or auto: at 1.2 m in the middle of each wall. May be given several times");
    app.add_option(
           "--tables", arguments.tables,
           "Folder for planes.csv, plane_1.csv, plans with isolux lines (plane_1.svg, .pdf), ..., observers.csv")
        ->type_name("FOLDER");
    app.add_option_function<std::vector<std::string>>(
           "--require",
           [&arguments](const std::vector<std::string>& all) {
               for (const std::string& words : all) {
                   Result<Requirement> read = read_requirement(words);
                   if (!read) throw CLI::ValidationError("--require", read.error().message + " in '" + words + "'");
                   arguments.requirements.push_back(std::move(*read));
               }
           },
           "Required values, which the page compares with the computed ones and their error: 'desk: Em 500, U0 0.6' "
           "for planes of a name (without a name: all), Ez for cylindrical planes, 'UGR 19' for observers. May be "
           "given several times")
        ->type_name("NUMBERS")
        ->expected(1)
        ->take_all();
    app.add_option(
           "--task", arguments.tasks,
           "Task of all rooms, 'office', or of one room, by number or name: '2=corridor'. The page then compares "
           "what the standard requires with what is reached; without planes and observers, adds those that "
           "the task needs. May be given several times")
        ->type_name("TASK")
        ->expected(1)
        ->take_all();
    app.add_option("--template", arguments.words,
                   "Words and sections of the page: german, or a TOML file. Default: English, all sections")
        ->type_name("FILE");
    app.add_flag("--list-words", arguments.lists_words, "Print the German template, from which others can be made");
    app.add_option("--tasks", arguments.tasks_file, "Further tasks (TOML), which replace known ones of the same name")
        ->type_name("FILE");
    app.add_flag("--list-tasks", arguments.lists_tasks, "Print the known tasks with their requirements, and end");
    add_heading(app, arguments.heading);
    app.add_option("--pdf", arguments.pdf, "Also write the page as PDF (.pdf); Chromium must be installed")
        ->type_name("FILE");
}

}  // namespace exitance
