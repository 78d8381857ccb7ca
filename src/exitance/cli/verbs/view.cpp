#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <future>
#include <thread>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/json_output.hpp"
#include "exitance/cli/light_unit.hpp"
#include "exitance/cli/solve/settle_options.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/cli/view/view_changes.hpp"
#include "exitance/cli/view/view_events.hpp"
#include "exitance/cli/view/view_frames.hpp"
#include "exitance/cli/view/view_pair.hpp"
#include "exitance/cli/view/view_share.hpp"
#include "exitance/cli/view/view_words.hpp"
#include "exitance/io/export/glb_nodes.hpp"
#include "exitance/io/export/viewer_data.hpp"
#include "exitance/io/export/viewer_part.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/measure/pictures/automatic_camera.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/what_if/light_groups/keep_light_groups.hpp"

namespace exitance {
namespace {

using Parameters = ViewServer::Parameters;

/// A solution that the page shows, with its camera and its radiosity function. The function, which points, lines and
/// exact pictures need, is built in the background while the page fetches the first elements.
class Viewed {
  public:
    explicit Viewed(Solution found)
        : solution(std::move(found)),
          light_(begun()),
          camera(automatic_camera(solution, RayTracer(solution.scene), Projection::perspective, {})) {}
    /// Shows a solution with the given camera, that of the previous solution.
    Viewed(Solution found, const Camera& as_before) : solution(std::move(found)), light_(begun()), camera(as_before) {}
    Viewed(const Viewed&) = delete;
    Viewed& operator=(const Viewed&) = delete;

    const RadiosityFunction& light() const { return *light_.get(); }

    const Solution solution;

  private:
    std::shared_future<std::unique_ptr<const RadiosityFunction>> begun() const {
        return std::async(std::launch::async, [this] { return std::make_unique<const RadiosityFunction>(solution); });
    }
    std::shared_future<std::unique_ptr<const RadiosityFunction>> light_;

  public:
    const Camera camera;
};

/// All solutions so far, the newest last. Older ones are kept because running requests may use them.
class Gallery {
  public:
    std::size_t add(Solution solution) {
        auto fresh = std::make_unique<Viewed>(std::move(solution));
        const std::lock_guard lock(mutex_);
        all_.push_back(std::move(fresh));
        return all_.size();
    }
    const Viewed* newest() const {
        const std::lock_guard lock(mutex_);
        return all_.empty() ? nullptr : all_.back().get();
    }

    /// The second of two solutions that are compared; null if there is one only.
    const Viewed* other() const { return other_.get(); }
    void set_other(Solution solution) { other_ = std::make_unique<Viewed>(std::move(solution), newest()->camera); }

  private:
    mutable std::mutex mutex_;
    std::deque<std::unique_ptr<Viewed>> all_;
    std::unique_ptr<Viewed> other_;
};

/// The viewer's page with the light of a solution as one file. `facts`: the solution whose materials and lamps the page
/// describes; the page multiplies and paints them by itself.
Result<std::string> share(const std::string& page, const Viewed& facts, const Viewed& light, const LightUnit& unit,
                          const std::string& views) {
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < viewer_part_count(light.solution, ViewerLayer::exported); ++i)
        parts.push_back(viewer_part(light.solution, ViewerLayer::exported, i));
    return make_shared_page(page, {viewer_scene_json(facts.solution, facts.camera, unit), parts, views});
}

/// Registers the requests that read the newest solution, with the changes of light that they specify.
void serve_light(ViewServer& server, const Gallery& gallery, ViewFrames& frames, ViewChanges<Viewed>& changes,
                 const ViewUnits& units) {
    const auto with_light = [&gallery, &changes](auto answer) {
        return [&gallery, &changes, answer](const Parameters& parameters) -> ViewAnswer {
            const bool is_other = view_text(parameters, "of") == "other";
            const Viewed* viewed = is_other ? gallery.other() : gallery.newest();
            if (!viewed) return view_absent;
            if (is_other || !changes.are_asked_for(parameters)) return answer(*viewed, parameters);
            const auto changed = changes.find(*viewed, parameters);
            return changed ? answer(**changed, parameters)
                           : ViewAnswer{400, "text/plain", changed.error().message + " " + changed.error().hint};
        };
    };
    server.get("/groups", with_light([&changes](const Viewed& v, const Parameters&) {
                   return changes.read_groups([&](const LightGroups& groups) {
                       return ViewAnswer{200, "application/json", light_groups_json(groups, v.solution.scene)};
                   });
               }));
    server.get("/data/scene", with_light([units](const Viewed& v, const Parameters&) {
                   const LightUnit unit = units(v.solution.scene);
                   return ViewAnswer{200, "application/json", viewer_scene_json(v.solution, v.camera, unit)};
               }));
    server.get("/data/part", with_light([](const Viewed& v, const Parameters& parameters) {
                   const std::string name = view_text(parameters, "layer");
                   const auto part = view_numbers(parameters, "part", 1);
                   ViewerLayer layer{};
                   if (!find_viewer_layer(name, layer) || !part || (*part)[0] < 0 ||
                       (*part)[0] >= static_cast<double>(viewer_part_count(v.solution, layer)))
                       return view_misunderstood;
                   const auto number = static_cast<std::size_t>((*part)[0]);
                   const RadiosityFunction* light = layer == ViewerLayer::raw ? &v.light() : nullptr;
                   return ViewAnswer{200, "application/octet-stream",
                                     view_text(parameters, "only") == "light"
                                         ? viewer_part_light(v.solution, layer, number, light)
                                         : viewer_part(v.solution, layer, number, light)};
               }));
    server.get("/data/frame", with_light([&frames](const Viewed& v, const Parameters& parameters) {
                   return frames.take(v.light(), parameters);
               }));
    server.get("/data/point", with_light([](const Viewed& v, const Parameters& parameters) {
                   const auto at = view_numbers(parameters, "at", 6);
                   if (!at) return view_misunderstood;
                   const std::vector<double>& n = *at;
                   const Vec3 normal{n[3], n[4], n[5]};
                   if (!(norm(normal) > 0)) return view_misunderstood;
                   return ViewAnswer{200, "application/json",
                                     viewer_point_json(v.light(), {{n[0], n[1], n[2]}, normalized(normal)})};
               }));
    server.get("/data/line", with_light([units](const Viewed& v, const Parameters& parameters) {
                   constexpr std::size_t points = 129;
                   const auto at = view_numbers(parameters, "at", 9);
                   if (!at) return view_misunderstood;
                   const std::vector<double>& n = *at;
                   const Vec3 normal{n[6], n[7], n[8]};
                   if (!(norm(normal) > 0)) return view_misunderstood;
                   return ViewAnswer{200, "application/json",
                                     viewer_line_json(v.light(), {n[0], n[1], n[2]}, {n[3], n[4], n[5]},
                                                      normalized(normal), points, units(v.solution.scene))};
               }));
}

/// Registers the request for a page that holds its data.
void serve_share(ViewServer& server, const Gallery& gallery, ViewChanges<Viewed>& changes, const ViewUnits& units,
                 const std::string& page) {
    server.get("/share", [&gallery, &changes, units, page](const Parameters& parameters) -> ViewAnswer {
        const Viewed* viewed = gallery.newest();
        if (!viewed) return view_absent;
        std::shared_ptr<const Viewed> changed;
        if (changes.are_asked_for(parameters)) {
            const auto found = changes.find(*viewed, parameters);
            if (!found) return {400, "text/plain", found.error().message + " " + found.error().hint};
            changed = *found;
        }
        const LightUnit unit = units(viewed->solution.scene);
        const Result<std::string> shared = share(page, *viewed, changed ? *changed : *viewed, unit, "[]");
        if (!shared) return {500, "text/plain", shared.error().message};
        return {200, "text/html; charset=utf-8", *shared};
    });
}

/// A solve that shows its light as it converges.
class RunningSolve {
  public:
    RunningSolve(const ViewArguments& arguments, Scene scene, Gallery& gallery, ViewChanges<Viewed>& changes,
                 Terminal& terminal)
        : arguments_(arguments),
          scene_(std::move(scene)),
          gallery_(gallery),
          changes_(changes),
          progress_(events_, terminal.progress()),
          limits_(terminal.limits()) {}

    void serve(ViewServer& server) {
        server.events("/data/events",
                      [this](std::size_t& next, std::string& text) { return events_.wait(next, text); });
        server.post("/data/stop", [this](const Parameters&) {
            limits_.stop().interrupt();
            return ViewAnswer{200, "text/plain", "stopping"};
        });
        server.post("/data/save", [this](const Parameters&) { return save(); });
    }

    void run() {
        SolveRequest request = arguments_.request;
        SolveOptions& options = request.options;
        options.error = arguments_.error;
        options.memory_limit_bytes = arguments_.limits.memory_limit;
        const auto show = [&](Solution solution) {
            solution.options = with_scene_options(options_json(request), arguments_.scene.load);
            const std::size_t count = gallery_.add(std::move(solution));
            events_.tell("light", fmt::format(R"({{"count": {}}})", count));
        };
        Result<Solution> solution = solve_scene(std::move(scene_), options, progress_, limits_.stop(), nullptr, show);
        if (solution && request.light_groups) {
            Result<LightGroups> groups = keep_light_groups(*solution, options, progress_, limits_.stop());
            if (groups)
                changes_.set_groups(std::move(*groups));
            else
                solution = groups.error();
        }
        std::string message = solution ? describe_end(solution->statistics) : solution.error().message;
        // A solve that was stopped before its first estimate returns no better light than the shown one.
        if (solution && (solution->statistics.relative_error_estimate || !gallery_.newest()))
            show(std::move(*solution));
        std::replace_if(
            message.begin(), message.end(), [](char c) { return c == '"' || c == '\\' || (c >= 0 && c < ' '); }, '\'');
        events_.end(fmt::format(R"({{"message": "{}"}})", message));
    }

  private:
    /// Text such as "reached: estimated error 1.8%, 2% requested" or "stopped by the time limit: ...".
    std::string describe_end(const SolveStatistics& statistics) const {
        const std::string error =
            statistics.relative_error_estimate
                ? fmt::format("estimated error {:.2g}%", 100 * *statistics.relative_error_estimate)
                : "the error is not known";
        const std::string why = statistics.stopped_by == "interrupt" ? limits_.reason() : statistics.stopped_by;
        const std::string end = statistics.converged  ? "reached"
                                : why == "interrupt"  ? "stopped"
                                : why == "iterations" ? "not reached"
                                                      : "stopped by the " + why;
        return fmt::format("{}: {}, {:.2g}% requested", end, error, 100 * arguments_.error);
    }

    ViewAnswer save() {
        const Viewed* viewed = gallery_.newest();
        if (!viewed) return {200, "text/plain", "there is no light yet"};
        const LightGroups groups = changes_.groups();
        const Result<void> written = write_solution(arguments_.save, viewed->solution, &groups);
        if (!written) return {500, "text/plain", written.error().message};
        return {200, "text/plain", "saved as " + arguments_.save};
    }

    const ViewArguments& arguments_;
    Scene scene_;
    Gallery& gallery_;
    ViewChanges<Viewed>& changes_;  ///< Gets the light groups at the end of the solve.
    ViewEvents events_;
    ViewProgress progress_;
    RunLimits& limits_;
};

/// Prints the address of the server and answers requests until a signal ends the program. `running`: solve to start on
/// a thread of its own, or null.
ExitCode serve(ViewServer& server, const ViewArguments& arguments, RunningSolve* running, Terminal& terminal) {
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
                     arguments.scene.files[0], "a solution is in metres, with Z up, and its faces are cut"};
    if (!r.sky.empty() || !r.epw.empty() || r.photometric || r.light_groups)
        return Error{ErrorCode::usage, "--sky, --epw, --quantity and --light-groups are for scenes",
                     arguments.scene.files[0],
                     "give them to the solve that makes the solution, or view the scene itself"};
    return {};
}

/// The error of options for a page to share that do not fit; none if they do.
std::optional<Error> find_misused_output(const ViewArguments& arguments) {
    if (arguments.output.empty() && !arguments.views.empty())
        return Error{ErrorCode::usage, "is for a page that is written", "--views", "add -o ROOM.html"};
    if (arguments.output.empty()) return {};
    if (ending(arguments.output) != ".html")
        return Error{ErrorCode::usage, "pages are written as .html", arguments.output,
                     "name the output something.html"};
    if (arguments.scene.files.size() > 1)
        return Error{ErrorCode::usage, "holds one solution", arguments.output, "name one solution, or omit -o"};
    return {};
}

/// Checks the options for a scene, and completes those for loading it.
Result<void> prepare(ViewArguments& arguments) {
    LoadOptions& load = arguments.scene.load;
    const std::vector<std::string>& files = arguments.scene.files;
    const auto solution = std::find_if(files.begin(), files.end(), [](const auto& f) { return f.ends_with(".h5"); });
    if (solution != files.end())
        return Error{ErrorCode::usage,
                     "is a solution, and view shows one solution, two solutions, or one scene of several files",
                     *solution, "name two solutions at most, and no scenes beside them"};
    if (!arguments.output.empty() || !arguments.views.empty())
        return Error{ErrorCode::usage, "-o and --views are for solutions", files[0],
                     "solve the scene first: exitance solve SCENE -o S.h5"};
    SolveRequest request = arguments.request;
    request.options.error = arguments.error;
    if (const Result<Way> way = find_way(request); !way) return way.error();
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
    unit_of(arguments.unit, solution->scene, terminal);
    gallery.add(std::move(*solution));
    const Scene& scene = gallery.newest()->solution.scene;
    if (!arguments.output.empty()) {
        Result<std::string> views("[]");
        if (!arguments.views.empty()) views = read_saved_views(arguments.views);
        if (!views) return terminal.fail(views.error());
        const Result<std::string> shared = share(page, *gallery.newest(), *gallery.newest(), units(scene), *views);
        if (!shared) return terminal.fail(shared.error());
        const Result<void> written = write_file(arguments.output, *shared);
        return written ? ExitCode::done : terminal.fail(written.error());
    }
    if (files.size() == 2) {
        Result<Solution> other = load_solution(files[1]);
        if (!other) return terminal.fail(other.error());
        const Result<void> fits = check_pair(scene, other->scene, units, files[1]);
        if (!fits) return terminal.fail(fits.error());
        gallery.set_other(std::move(*other));
    }
    ViewFrames frames(units);
    ViewChanges<Viewed> changes(std::move(groups));
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
    ViewChanges<Viewed> changes({});
    serve_light(server, gallery, frames, changes, units);
    serve_share(server, gallery, changes, units, page);
    CheckedScene checked = load_scene(arguments.scene.files, load);
    terminal.show(checked.findings);
    if (!checked.scene) return terminal.fail(checked);
    if (load.photometric) checked.scene->declare_photometric(*load.photometric);
    if (load.light_groups)
        if (const Result<void> few = check_light_groups(*checked.scene); !few) return terminal.fail(few.error());
    unit_of(arguments.unit, *checked.scene, terminal);
    RunningSolve running(arguments, std::move(*checked.scene), gallery, changes, terminal);
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
    server.get("/data/state", [state](const Parameters&) { return ViewAnswer{200, "application/json", state}; });
    return solves ? view_scene(arguments, *page, server, terminal) : view_solutions(arguments, *page, server, terminal);
}

}  // namespace exitance
