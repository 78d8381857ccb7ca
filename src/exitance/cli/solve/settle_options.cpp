#include "exitance/cli/solve/settle_options.hpp"

#include <fmt/format.h>

#include <utility>

#include "exitance/cli/discontinuity_arguments.hpp"
#include "exitance/cli/processes.hpp"
#include "exitance/cli/solve/classical_solve.hpp"
#include "exitance/cli/solve/kept_groups.hpp"
#include "exitance/cli/solve/local_pass_check.hpp"
#include "exitance/cli/solve/task_engine_check.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/probe_file.hpp"
#include "exitance/io/scenes/sky_words.hpp"
#include "exitance/methods/plan/obedience.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

/// Found out before the work, not after it: can the result be written?
Result<void> check_output(const std::string& path) {
    if (path.empty()) return Error{ErrorCode::usage, "is missing", "-o", "exitance solve room.obj -o room.h5"};
    const Result<AtomicFile> file = AtomicFile::create(path);
    return file ? Result<void>() : Result<void>(file.error());
}

/// A solution is no mesh and no picture.
Result<void> check_ending(const std::string& path) {
    for (const char* end : {".vtu", ".vtkhdf", ".hdf", ".glb", ".gltf", ".obj", ".csv", ".png", ".exr", ".hdr"})
        if (path.ends_with(end)) {
            const bool picture =
                std::string_view(end) == ".png" || std::string_view(end) == ".exr" || std::string_view(end) == ".hdr";
            return Error{ErrorCode::usage,
                         fmt::format("solve writes a solution (.h5), from which `{}` makes a {}",
                                     picture ? "render" : "export", end),
                         "-o",
                         fmt::format("exitance solve SCENE -o S.h5, then exitance {} S.h5 -o {}",
                                     picture ? "render" : "export", path)};
        }
    return {};
}

/// The points that light is looked at become options.
Result<void> read_importance(SolveArguments& arguments) {
    if (arguments.importance.empty()) return {};
    const Result<ProbePoints> points = load_probe_points(arguments.importance);
    if (!points) return points.error();
    if (points->size() == 0)
        return Error{ErrorCode::bad_input, "holds no points", arguments.importance, "without --importance all counts"};
    for (std::size_t i = 0; i < points->size(); ++i)
        arguments.options.importance.push_back({points->points[i], points->normals[i]});
    return {};
}

/// The sky that is asked for becomes a part of the scene that is read.
Result<void> read_sky(SolveArguments& arguments) {
    if (arguments.sky.empty() && arguments.epw.empty()) return {};
    if (arguments.sky.empty())
        return Error{ErrorCode::usage, "a weather file needs a kind of sky and a time", "--epw",
                     "--sky perez,time=06-21T12:00"};
    std::optional<Weather> weather;
    if (!arguments.epw.empty()) {
        Result<Weather> read = load_epw(arguments.epw);
        if (!read) return read.error();
        weather = std::move(*read);
    }
    Result<ChosenSky> sky = parse_sky(arguments.sky, weather ? &*weather : nullptr);
    if (!sky) return sky.error();
    if (arguments.photometric) sky->photometric = arguments.photometric;
    if (weather)
        for (const std::string& warning : weather->warnings) sky->warnings.push_back(arguments.epw + ": " + warning);
    arguments.scene.load.sky = std::move(*sky);
    return {};
}

/// Options that say something for another one.
void share_options(SolveArguments& arguments) {
    // The engine of tasks reads the threshold that classical forms read.
    if (arguments.options.task_engine)
        arguments.options.threshold = std::exchange(arguments.classical.threshold, std::nullopt);
    // Growing cells are delivered as they are where nothing is gathered; their learning has no classical form.
    if (arguments.options.method == Method::growing_cells && arguments.classical.gather) {
        if (!*arguments.classical.gather) arguments.options.smoothing = false;
        arguments.classical.gather.reset();
    }
    // Exact visible parts within links are a classical form, whether or not another of its options is given.
    const SolveOptions& o = arguments.options;
    if (o.visibility == VisibilityKind::exact && !o.task_engine && !o.local_pass && !arguments.classical.any())
        arguments.classical.direct = ClassicalDirect::apart;
}

/// Forms with a path of their own have checks of their own. Over several processes `auto` is `matrix`.
Result<void> check_methods(const SolveArguments& arguments) {
    const bool of_its_own = arguments.classical.any() || arguments.options.task_engine ||
                            arguments.options.local_pass.value_or(LocalPassRule::e) != LocalPassRule::e;
    if (of_its_own) return {};
    SolveOptions options = arguments.options;
    if (processes() > 1 && options.method == Method::automatic) options.method = Method::matrix;
    return check_obedience(options);
}

}  // namespace

Result<void> settle_options(SolveArguments& arguments) {
    share_options(arguments);
    Result<void> settled = check_task_engine(arguments);
    if (settled) settled = check_local_pass(arguments);
    if (settled) settled = check_discontinuity(arguments.options);
    if (settled) settled = read_importance(arguments);
    if (settled) settled = read_sky(arguments);
    if (settled) settled = check_classical(arguments);
    if (settled) settled = check_methods(arguments);
    if (settled) settled = check_processes(arguments);
    if (settled) settled = check_light_groups(arguments);
    if (settled) settled = check_ending(arguments.output);
    if (!settled) return settled;
    // All processes come here, whatever is done with what the first one finds.
    if (const Result<void> output = by_first([&] { return check_output(arguments.output); });
        !arguments.dry_run && !output)
        return output;
    return arguments.trace.empty() ? Result<void>() : check_output(arguments.trace);
}

}  // namespace exitance
