#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <thread>

#include "exitance/base/parallel.hpp"
#include "exitance/base/words.hpp"
#include "exitance/cli/json_output.hpp"
#include "exitance/cli/light_unit.hpp"
#include "exitance/cli/solve/settle_options.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/cli/view/view_pair.hpp"
#include "exitance/cli/view/view_requests.hpp"
#include "exitance/cli/view/view_share.hpp"
#include "exitance/cli/view/view_solve.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/methods/light/mesh_of_layers.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/what_if/light_groups/keep_light_groups.hpp"

namespace exitance {
namespace {

/// Prints the address of the server and answers requests until a signal ends the program. `running`: solve to start on
/// a thread of its own, or null.
ExitCode serve(ViewServer& server, const ViewArguments& arguments, ViewSolve* running, Terminal& terminal) {
    const Result<int> port = server.bind(arguments.port);
    if (!port) return terminal.fail(port.error());
    terminal.print(fmt::format("http://127.0.0.1:{}/", *port));
    std::fflush(stdout);
    terminal.note(fmt::format("open http://127.0.0.1:{}/ in a browser; Ctrl+C ends the viewer", *port));
    terminal.limits().keep(RunLimits::Signals::end_program);
    std::jthread solver;
    if (running) solver = std::jthread([running] { running->run(); });
    server.listen();
    return ExitCode::done;
}

/// The error of options that apply to scenes only, given with a solution; none if there are none.
std::optional<Error> find_options_of_scenes(const ViewArguments& arguments) {
    const LoadOptions& load = arguments.scene.load;
    const SolveRequest& r = arguments.request;
    if (load.metres_per_unit || load.y_is_up || !load.lod.empty() || load.turn_bodies || load.texture_parts)
        return Error{ErrorCode::usage, "--length-unit, --up, --lod, --turn-bodies and --texture-parts are for scenes",
                     arguments.scene.files[0],
                     "leave them out: a solution is in metres, with Z up, and its faces are cut already"};
    if (!r.sky.empty() || !r.epw.empty() || r.photometric || r.light_groups)
        return Error{ErrorCode::usage, "--sky, --epw, --quantity and --light-groups are for scenes",
                     arguments.scene.files[0],
                     "give them to the solve that makes the solution, or view the scene itself"};
    return {};
}

/// The error of options for a page to share that do not fit; none if they do.
std::optional<Error> find_misused_output(const ViewArguments& arguments) {
    if (arguments.output.empty() && !arguments.views.empty())
        return Error{ErrorCode::usage, "applies only to a page that is written", "--views", "add -o ROOM.html"};
    if (arguments.output.empty()) return {};
    if (ending(arguments.output) != ".html")
        return Error{ErrorCode::usage, "pages are written as .html", arguments.output,
                     "name the output something.html"};
    if (arguments.scene.files.size() > 1)
        return Error{ErrorCode::usage, "can show only one solution", arguments.output, "name one solution, or omit -o"};
    return {};
}

/// Checks the options for a scene, and completes those for loading it.
Result<void> prepare(ViewArguments& arguments) {
    LoadOptions& load = arguments.scene.load;
    const std::vector<std::string>& files = arguments.scene.files;
    const auto solution = std::find_if(files.begin(), files.end(), [](const auto& f) { return f.ends_with(".h5"); });
    if (solution != files.end())
        return Error{ErrorCode::usage,
                     "is a solution; view shows one solution, two solutions, or one scene of several files", *solution,
                     "name two solutions at most, and no scenes beside them"};
    if (!arguments.output.empty() || !arguments.views.empty())
        return Error{ErrorCode::usage, "-o and --views are for solutions", files[0],
                     "solve the scene first: exitance solve SCENE -o S.h5"};
    SolveRequest request = arguments.request;
    request.options.error = arguments.error;
    if (const Result<MethodForm> method_form = find_method_form(request); !method_form) return method_form.error();
    load.photometric = request.photometric, load.light_groups = request.light_groups;
    return read_sky(request, load);
}

/// Runs `exitance view SOLUTION [SOLUTION]`, or writes a page to share.
ExitCode view_solutions(const ViewArguments& arguments, const std::string& page, ViewServer& server,
                        Terminal& terminal) {
    if (const std::optional<Error> error = find_options_of_scenes(arguments)) return terminal.fail(*error);
    const std::vector<std::string>& files = arguments.scene.files;
    if (const std::optional<Error> error = find_misused_output(arguments)) return terminal.fail(*error);
    Gallery gallery;
    const ViewUnits units(arguments.unit);
    LightGroups groups;
    Result<Solution> solution = load_solution(files[0], Rehearsed::not_yet, &groups);
    if (!solution) return terminal.fail(solution.error());
    if (groups.empty())  // dimmed light is that of elements
        if (const Result<void> made = make_requested_mesh(*solution); !made) return terminal.fail(made.error());
    unit_of(arguments.unit, solution->scene, terminal);
    gallery.add(std::move(*solution));
    const Scene& scene = gallery.newest()->solution.scene;
    if (!arguments.output.empty()) {
        Result<std::string> views("[]");
        if (!arguments.views.empty()) views = read_saved_views(arguments.views);
        if (!views) return terminal.fail(views.error());
        const Result<std::string> shared = share_page(page, *gallery.newest(), *gallery.newest(), units(scene), *views);
        if (!shared) return terminal.fail(shared.error());
        const Result<void> written = write_file(arguments.output, *shared);
        return written ? ExitCode::done : terminal.fail(written.error());
    }
    if (files.size() == 2) {
        Result<Solution> other = load_solution(files[1]);
        if (!other) return terminal.fail(other.error());
        if (const Result<void> made = make_requested_mesh(*other); !made) return terminal.fail(made.error());
        const Result<void> fits = check_pair(scene, other->scene, units, files[1]);
        if (!fits) return terminal.fail(fits.error());
        gallery.set_other(std::move(*other));
    }
    ViewFrames frames(units);
    ViewChanges changes(std::move(groups));
    serve_light(server, gallery, frames, changes, units);
    serve_share(server, gallery, changes, units, page);
    return serve(server, arguments, nullptr, terminal);
}

/// Runs `exitance view SCENE`.
ExitCode view_scene(ViewArguments& arguments, const std::string& page, ViewServer& server, Terminal& terminal) {
    if (const Result<void> fit = prepare(arguments); !fit) return terminal.fail(fit.error());
    const LoadOptions& load = arguments.scene.load;
    if (load.sky)
        for (const std::string& warning : load.sky->warnings) terminal.progress().warn(warning);
    Gallery gallery;
    const ViewUnits units(arguments.unit);
    ViewFrames frames(units);
    ViewChanges changes({});
    serve_light(server, gallery, frames, changes, units);
    serve_share(server, gallery, changes, units, page);
    CheckedScene checked = load_scene(arguments.scene.files, load);
    terminal.show(checked.findings);
    if (!checked.scene) return terminal.fail(checked);
    if (load.photometric) checked.scene->declare_photometric(*load.photometric);
    if (load.light_groups)
        if (const Result<void> few = check_light_groups(*checked.scene); !few) return terminal.fail(few.error());
    unit_of(arguments.unit, *checked.scene, terminal);
    ViewSolve running(arguments, std::move(*checked.scene), gallery, changes, terminal);
    running.serve(server);
    return serve(server, arguments, &running, terminal);
}

}  // namespace

/// Runs `exitance view`.
ExitCode run(const ViewArguments& given, Terminal& terminal) {
    ViewArguments arguments = given;
    const Result<std::string> page = find_viewer_page();
    if (!page) return terminal.fail(page.error());
    set_threads(arguments.request.options.threads);
    ViewServer server;
    if (const Result<void> read = server.serve_page(*page); !read) return terminal.fail(read.error());
    const std::vector<std::string>& files = arguments.scene.files;
    const bool solves =
        files.size() > 2 || !std::all_of(files.begin(), files.end(), [](const auto& f) { return f.ends_with(".h5"); });
    const std::string pair =
        solves || files.size() < 2 ? "null" : fmt::format("[{}, {}]", json_text(files[0]), json_text(files[1]));
    const std::string state = fmt::format(R"({{"solving": {}, "files": {}}})", solves, pair);
    server.get("/data/state", [state](const ViewServer::Parameters&) {
        return ViewAnswer{200, "application/json", state};
    });
    return solves ? view_scene(arguments, *page, server, terminal) : view_solutions(arguments, *page, server, terminal);
}

}  // namespace exitance
