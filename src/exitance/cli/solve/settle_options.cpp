#include "exitance/cli/solve/settle_options.hpp"

#include <filesystem>
#include <utility>

#include "exitance/cli/named_files.hpp"
#include "exitance/cli/processes.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/probe_file.hpp"
#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/wea_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/sky_words.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

/// Error if `path` is missing or cannot be written. Checked before the work, so that no result is lost.
Result<void> check_output(const std::string& path) {
    if (path.empty()) return Error{ErrorCode::usage, "is missing", "-o", "exitance solve room.obj -o room.h5"};
    const Result<AtomicFile> file = AtomicFile::create(path);
    return file ? Result<void>() : Result<void>(file.error());
}

/// Reads the file of --importance into the options.
Result<void> read_importance(SolveArguments& arguments) {
    if (arguments.importance.empty()) return {};
    const Result<ProbePoints> points = load_probe_points(arguments.importance);
    if (!points) return points.error();
    if (points->size() == 0)
        return Error{ErrorCode::bad_input, "holds no points", arguments.importance,
                     "leave out --importance for equal accuracy everywhere"};
    for (std::size_t i = 0; i < points->size(); ++i)
        arguments.options.importance.push_back({points->points[i], points->normals[i]});
    return {};
}

/// Replaces a file name in --dm-lines by the names on the lines of that file.
Result<void> read_line_surfaces(SolveArguments& arguments) {
    std::optional<ShadowLines>& lines = arguments.options.discontinuity.lines;
    std::error_code none;
    if (!lines || lines->names.size() != 1 || !std::filesystem::is_regular_file(lines->names[0], none)) return {};
    const std::string path = lines->names[0];
    const Result<std::string> text = read_whole_file(path);
    if (!text) return text.error();
    lines->names.clear();
    for (TextLines line(*text); line.next();) lines->names.emplace_back(line.rest());
    if (lines->names.empty())
        return Error{ErrorCode::bad_input, "names no surfaces", path, "one name of a material or object a line"};
    return {};
}

/// Error (usage) if no method supports all options. With several processes, `auto` is `matrix`.
Result<void> check_support(const SolveArguments& arguments) {
    SolveRequest request = arguments;
    if (processes() > 1 && request.options.method == Method::automatic) request.options.method = Method::matrix;
    const Result<MethodForm> method_form = find_method_form(request);
    return method_form ? Result<void>() : Result<void>(method_form.error());
}

}  // namespace

Result<void> read_sky(const SolveRequest& request, LoadOptions& load) {
    if (request.sky.empty()) return {};
    std::optional<Weather> weather;
    if (!request.epw.empty()) {
        Result<Weather> read = load_weather(request.epw);
        if (!read) return read.error();
        weather = std::move(*read);
    }
    Result<ChosenSky> sky = parse_sky(request.sky, weather ? &*weather : nullptr);
    if (!sky) return sky.error();
    if (request.photometric) sky->photometric = request.photometric;
    if (weather)
        for (const std::string& warning : weather->warnings) sky->warnings.push_back(request.epw + ": " + warning);
    load.sky = std::move(*sky);
    return {};
}

Result<void> settle_options(SolveArguments& arguments) {
    Result<void> settled = check_support(arguments);
    if (settled) settled = check_processes(arguments);
    if (settled) settled = read_importance(arguments);
    if (settled) settled = read_line_surfaces(arguments);
    if (settled) settled = read_sky(arguments, arguments.scene.load);
    if (settled) settled = check_solution_name("solve", arguments.output);
    if (!settled) return settled;
    // by_first() is collective: it must run before the condition on `dry_run`.
    if (const Result<void> output = by_first([&] { return check_output(arguments.output); });
        !arguments.dry_run && !output)
        return output;
    return arguments.trace.empty() ? Result<void>() : check_output(arguments.trace);
}

}  // namespace exitance
