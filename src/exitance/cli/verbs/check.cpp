#include <fmt/format.h>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/json_output.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/pictures/check_picture.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/scene/findings.hpp"
#include "exitance/scene/model_units.hpp"
#include "exitance/scene/shell.hpp"

namespace exitance {
namespace {

/// "1 emitter" or "3 emitters".
std::string counted(std::size_t count, const char* noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// Findings of one kind under a heading; empty if there are none.
std::string group(const std::vector<Finding>& findings, Finding::Kind kind, std::string_view singular,
                  std::string_view plural) {
    std::string lines;
    std::size_t count = 0;
    for (const Finding& finding : findings) {
        if (finding.kind != kind) continue;
        ++count;
        lines += fmt::format("  {}: {}\n", place_of(finding), finding.message);
        if (!finding.hint.empty()) lines += fmt::format("    hint: {}\n", finding.hint);
    }
    return count == 0 ? "" : fmt::format("{} {}\n{}", count, count == 1 ? singular : plural, lines);
}

/// Warnings, repairs and size of a scene as text. Errors are printed to stderr instead.
std::string report(const CheckedScene& checked, const Shell& shell) {
    using Kind = Finding::Kind;
    std::string text = group(checked.findings, Kind::warning, "warning", "warnings") +
                       group(checked.findings, Kind::repair, "repair", "repairs");
    if (!checked.scene) return text + "The scene cannot be used.\n";
    const Scene& scene = *checked.scene;
    double area = 0;
    for (const Surface& surface : scene.surfaces()) area += surface.area;
    const Vec3 size = scene.box().size();
    if (shell.open_edges > 0)
        text += fmt::format("{} edges ({:.4g} m in total) belong to only one face: the model is open there.\n",
                            shell.open_edges, shell.open_length);
    return text + fmt::format(
                      "The scene can be used: {} surfaces of {:.4g} m^2 ({} after joining coplanar neighbours), "
                      "{}, {}{}, {:.4g} x {:.4g} x {:.4g} m.\n",
                      scene.surfaces().size(), area, scene.regions().size(),
                      counted(scene.emitters().size(), "emitter"),
                      scene.lights().empty() ? "" : counted(scene.lights().size(), "light") + " without extent, ",
                      counted(scene.materials().size(), "material"), size.x, size.y, size.z);
}

}  // namespace

/// Runs `exitance check SCENE`.
ExitCode run(const CheckArguments& arguments, Terminal& terminal) {
    if (!arguments.picture.empty() && ending(arguments.picture) != ".png")
        return terminal.fail(
            {ErrorCode::usage, "the picture is written as .png", arguments.picture, "name it something.png"});
    set_threads(arguments.threads);
    LoadedScene checked = load_scene(arguments.scene.files, arguments.scene.load);
    Shell shell;
    if (checked.scene) {
        shell = inspect_shell(*checked.scene);
        for (Finding& finding : findings_of(shell, *checked.scene)) {
            checked.lines.place(finding);
            checked.findings.push_back(std::move(finding));
        }
        const LoadOptions& load = arguments.scene.load;
        if (!say_units(arguments.scene.files))
            for (Finding& finding : findings_of(guess_units(*checked.scene), *checked.scene,
                                                load.metres_per_unit.has_value(), load.y_is_up.has_value()))
                checked.findings.push_back(std::move(finding));
        sort_findings(checked.findings);
        checked.marks.insert(checked.marks.end(), shell.marks.begin(), shell.marks.end());
    }
    terminal.print(arguments.json ? check_json(checked) : report(checked, shell));
    if (!arguments.picture.empty()) {
        const Image image =
            check_picture(read_description(arguments.scene.files, arguments.scene.load), checked.marks, 1280, 720);
        const Result<void> written = write_png(arguments.picture, image, {{"Software", "exitance"}});
        if (!written) return terminal.fail(written.error());
    }
    if (checked.scene) return ExitCode::done;
    return arguments.json ? terminal.fail(checked) : terminal.fail_with_all(checked);
}

}  // namespace exitance
