#include <fmt/format.h>

#include <map>
#include <string>

#include "exitance/cli/verbs.hpp"
#include "exitance/io/scenes/obj/obj_writer.hpp"
#include "exitance/samples/generate.hpp"

namespace exitance {
namespace {

std::string list_families() {
    std::string text;
    for (const SceneFamily& family : scene_families()) {
        text += fmt::format("{}: {}\n", family.name, family.help);
        for (const FamilyParameter& parameter : family.parameters)
            text += fmt::format("    {}={}  {} ({} to {})\n", parameter.name, parameter.value, parameter.help,
                                parameter.least, parameter.most);
    }
    return text + "Every family also takes rot=DEGREES,ax,ay,az, scale=S, shift=x,y,z and name=NAME.\n";
}

Result<std::map<std::string, std::string>> split(const std::vector<std::string>& words) {
    std::map<std::string, std::string> parameters;
    for (const std::string& word : words) {
        const std::size_t equals = word.find('=');
        if (equals == std::string::npos || equals == 0)
            return Error{ErrorCode::usage, fmt::format("'{}' is not of the form name=value", word), "",
                         "exitance generate list shows the parameters of every family"};
        if (!parameters.emplace(word.substr(0, equals), word.substr(equals + 1)).second)
            return Error{ErrorCode::usage, "is given more than once", word.substr(0, equals), ""};
    }
    return parameters;
}

}  // namespace

/// Runs `exitance generate FAMILY name=value ... -o SCENE`.
ExitCode run(const GenerateArguments& arguments, Terminal& terminal) {
    if (arguments.family == "list") {
        terminal.print(list_families());
        return ExitCode::done;
    }
    if (arguments.output.empty())
        return terminal.fail({ErrorCode::usage, "is missing", "-o", "exitance generate complex m=6 -o complex.obj"});
    const Result<std::map<std::string, std::string>> parameters = split(arguments.parameters);
    if (!parameters) return terminal.fail(parameters.error());
    const Result<SceneDescription> scene = generate_scene(arguments.family, *parameters);
    if (!scene) return terminal.fail(scene.error());
    if (const Result<void> written = write_obj(*scene, arguments.output); !written)
        return terminal.fail(written.error());
    if (!arguments.quiet) terminal.print(fmt::format("{}: {} polygons", arguments.output, scene->faces.size()));
    return ExitCode::done;
}

}  // namespace exitance
