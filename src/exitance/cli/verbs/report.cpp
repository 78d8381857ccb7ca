#include "exitance/io/report/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/camera_choice.hpp"
#include "exitance/cli/light_unit.hpp"
#include "exitance/cli/observers.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/evaluate/surface_levels.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/pictures/display.hpp"
#include "exitance/io/pictures/isolux.hpp"
#include "exitance/io/pictures/unit_picture.hpp"
#include "exitance/io/report/lighting_tasks.hpp"
#include "exitance/io/report/report_pdf.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/io/solution/statistics_json.hpp"
#include "exitance/measure/floor_rooms.hpp"
#include "exitance/measure/glare/room_observers.hpp"
#include "exitance/measure/pictures/timed_picture.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

constexpr double unseen_difference = 0.003;  ///< Relative; derived from steps of 8-bit pictures, which are 0.8%.
constexpr int picture_samples = 2;  ///< Rays per pixel; derived from pages that show pictures at a third of their size.

/// The requested views; by default an automatic one and up to three cameras of the scene.
std::vector<RenderArguments> views(const ReportArguments& arguments, const Scene& scene) {
    constexpr std::size_t max_cameras = 3;
    std::vector<RenderArguments> out = arguments.views;
    if (out.empty()) {
        out.emplace_back();
        for (std::size_t i = 0; i < std::min(max_cameras, scene.cameras().size()); ++i)
            out.emplace_back().camera_name = std::to_string(i + 1);
    }
    for (RenderArguments& view : out) view.size = arguments.size;
    return out;
}

/// Adds a camera's view in display colours and in false colours. The captions say if a stop has left them coarse.
void add_pictures(const ReportArguments& arguments, const RadiosityFunction& light, const Camera& camera,
                  ReportContent& content, Terminal& terminal, const StopRequest& stop) {
    PictureOptions options{camera, arguments.size, picture_samples};
    options.interpolation = unseen_difference;
    const TimedPicture taken = take_picture_in_time(light, options, terminal.progress(), stop);
    if (taken.block == 0) return content.unfinished.push_back("pictures from " + describe(camera));
    const std::string note =
        taken.is_complete   ? ""
        : taken.samples > 0 ? fmt::format("; stopped after {} of {} samples per pixel", taken.samples, picture_samples)
                            : fmt::format("; stopped at squares of {} pixels", taken.block);
    const Picture& picture = taken.picture;
    ToneMap tones;
    tones.curve = ToneCurve::filmic, tones.scale = automatic_exposure(picture);
    content.pictures.push_back({"The room as it looks" + note, describe(camera), display_image(picture, tones)});
    const bool lux = content.unit.is_lux();
    const Quantity quantity = lux ? Quantity::illuminance : Quantity::irradiance;
    const Picture shown = in_unit(picture, content.unit);
    const ColourScale scale = make_colour_scale(shown, quantity);
    Image image = false_colour_image(shown, quantity, scale);
    const std::string legend = content.words.text(title(quantity, lux));
    if (lux) draw_isolux(image, shown, quantity, scale, content.words.text("lines " + title(quantity, lux)));
    draw_legend(image, legend, scale);
    content.pictures.push_back(
        {(lux ? "Illuminance in lx" : "Irradiance in W/m²") + note, describe(camera), std::move(image)});
}

/// The 1000 largest faces. Sets `left_out` to the number of the others.
std::vector<SurfaceId> largest_faces(const Scene& scene, std::size_t& left_out) {
    constexpr std::size_t max_rows = 1000;
    std::vector<SurfaceId> faces;
    for (SurfaceId s : scene.surfaces().ids()) faces.push_back(s);
    std::stable_sort(faces.begin(), faces.end(),
                     [&](SurfaceId a, SurfaceId b) { return scene.surfaces()[a].area > scene.surfaces()[b].area; });
    left_out = faces.size() > max_rows ? faces.size() - max_rows : 0;
    faces.resize(faces.size() - left_out);
    return faces;
}

/// Bakes light maps for the embedded viewer, if the scene is small enough for a page that can be mailed.
void add_viewer(const RadiosityFunction& light, ReportContent& content, Terminal& terminal, const StopRequest& stop) {
    constexpr double many_texels = 8000, few_texels = 2000;  // derived from the size of a page, about a megabyte
    constexpr std::size_t max_faces = 20000;
    const Scene& scene = light.solution().scene;
    if (scene.surfaces().size() > max_faces) return;
    double area = 0;
    for (const Region& region : scene.regions()) area += region.area;
    // The cost of a texel is proportional to the number of emitters. Directed emitters cost about eight times as much.
    constexpr double cheap_emitters = 16, cost_of_directed = 8;
    const double cost =
        static_cast<double>(scene.emitters().size()) * (scene.has_directed_emission() ? cost_of_directed : 1);
    const double texels = std::max(few_texels, many_texels * std::min(1.0, cheap_emitters / std::max(cost, 1.0)));
    BakeOptions options;
    options.density = std::min(64.0, std::sqrt(texels / area));
    Result<LightMaps> maps = bake_light_maps(light, options, terminal.progress(), stop);
    if (stop.requested())
        content.unfinished.push_back("the viewer");
    else if (maps)
        content.viewer = std::move(*maps);
}

/// True if the rooms of the scene are needed for planes, observers or the schedule of luminaires.
bool needs_rooms(const ReportArguments& arguments, const Scene& scene) {
    return need_rooms(arguments.observers) || !arguments.working_planes.empty() || !arguments.tasks.empty() ||
           !scene.luminaires().empty();
}

Result<void> add_working_planes(const ReportArguments& arguments, const Scene& scene, const FloorRooms& rooms,
                                std::vector<GridLight>& grids) {
    for (const PlaneRequest& request : arguments.working_planes) {
        Result<std::vector<GridLight>> planes = make_working_planes(scene, rooms, request);
        if (!planes) return planes.error();
        for (GridLight& plane : *planes) grids.push_back(std::move(plane));
    }
    return {};
}

/// Adds the planes and observers that the requirements of tasks need, if the user gave none: a working plane at 0.75 m,
/// a cylindrical one at the eyes of seated people, and automatic observers.
ReportArguments with_needs_of_tasks(ReportArguments arguments, std::span<const LightingTask> tasks) {
    constexpr double working_height = 0.75;  // metres, the usual height of EN 12464-1
    const auto need = [&](const std::string& quantity) {
        for (const std::string& words : arguments.tasks)
            for (const LightingTask& task : tasks)
                if (task.name == words.substr(words.find('=') + 1))
                    for (const Requirement::Limit& limit : task.limits)
                        if (limit.quantity == quantity) return true;
        return false;
    };
    const auto has_plane = [&](bool cylindrical) {
        return std::any_of(arguments.working_planes.begin(), arguments.working_planes.end(),
                           [&](const PlaneRequest& p) { return p.is_cylindrical == cylindrical; });
    };
    if ((need("Em") || need("U0")) && !has_plane(false))
        arguments.working_planes.emplace_back().height = working_height;
    if (need("Ez") && !has_plane(true)) {
        PlaneRequest& plane = arguments.working_planes.emplace_back();
        plane.height = seated_eye_height, plane.is_cylindrical = true;
    }
    if (need("UGR") && arguments.observers.empty()) arguments.observers.emplace_back("auto");
    return arguments;
}

std::optional<Error> find_misuse(const ReportArguments& arguments) {
    if (arguments.solution.empty())
        return Error{ErrorCode::usage, "no solution is given", "report",
                     "for example: exitance report room.h5 -o room.html"};
    if (!arguments.tasks_file.empty() && arguments.tasks.empty())
        return Error{ErrorCode::usage, "has no effect without a task", "--tasks", "add --task NAME, or --list-tasks"};
    if (arguments.output.empty() && arguments.tables.empty())
        return Error{ErrorCode::usage, "no output is given", "report", "name a page, -o room.html, or --tables FOLDER"};
    const bool measures = !arguments.planes.empty() || !arguments.working_planes.empty();
    if (arguments.maintenance < 1 && !measures)
        return Error{ErrorCode::usage, "has no effect without measuring planes", "--maintenance", "add --plane 0.75"};
    if (arguments.output.empty() && !measures && arguments.observers.empty())
        return Error{ErrorCode::usage, "there are no planes or observers for tables", "--tables",
                     "add --plane 0.75 or --observers auto, or a page, -o room.html"};
    if (arguments.output.empty() && !arguments.views.empty())
        return Error{ErrorCode::usage, "has no effect without a page, since tables hold no pictures", "--camera",
                     "add a page, -o room.html"};
    if (!arguments.requirements.empty() && !measures && arguments.observers.empty())
        return Error{ErrorCode::usage, "has no effect without measuring planes or observers", "--require",
                     "add --plane 0.75 or --observers auto"};
    if (!arguments.words.empty() && arguments.output.empty())
        return Error{ErrorCode::usage, "applies to the page, not to tables", "--template", "add a page, -o room.html"};
    if (!arguments.pdf.empty() && arguments.output.empty())
        return Error{ErrorCode::usage, "needs a page, from which it is printed", "--pdf", "add a page, -o room.html"};
    if (!arguments.pdf.empty() && ending(arguments.pdf) != ".pdf")
        return Error{ErrorCode::usage, "pages are printed as .pdf", arguments.pdf, "name the output something.pdf"};
    if (arguments.output.empty()) return std::nullopt;
    const bool page = arguments.output.ends_with(".html") || arguments.output.ends_with(".htm");
    if (page) return std::nullopt;
    return Error{ErrorCode::usage, "reports are written as .html", arguments.output, "name the output something.html"};
}

/// Adds the requested measuring planes and observers. Those that a stop leaves unfinished are omitted.
void add_measurements(const ReportArguments& arguments, std::span<const Observer> observers,
                      const RadiosityFunction& light, ReportContent& content, Terminal& terminal,
                      const StopRequest& stop) {
    std::vector<GridLight> finished;
    for (GridLight& grid : content.grids) {
        measure(light, grid, terminal.progress(), stop);
        if (!stop.requested()) finished.push_back(std::move(grid));
    }
    if (finished.size() < content.grids.size())
        content.unfinished.push_back(
            fmt::format("{} of {} measuring planes", content.grids.size() - finished.size(), content.grids.size()));
    content.grids = std::move(finished);
    const LightUnit lux(UnitChoice::lux, light.solution().scene.is_photometric(),
                        arguments.unit.efficacy.value_or(daylight_efficacy));
    for (const Observer& observer : observers)
        if (!stop.requested()) content.observers.push_back({observer, find_glare(light, observer, lux)});
    if (content.observers.size() < observers.size())
        content.unfinished.push_back(
            fmt::format("{} of {} observers", observers.size() - content.observers.size(), observers.size()));
}

/// Adds statistics, surfaces, the error at points, pictures and the viewer to the page.
Result<void> add_page(const ReportArguments& arguments, const RadiosityFunction& light, ReportContent& content,
                      Terminal& terminal, const StopRequest& stop) {
    const Scene& scene = light.solution().scene;
    content.statistics = statistics_json(light.solution().statistics, own_unit(scene.is_photometric()));
    std::vector<Camera> cameras;
    for (const RenderArguments& view : views(arguments, scene)) {
        Result<Camera> camera = choose_camera(view, light);
        if (!camera) return camera.error();
        cameras.push_back(*camera);
    }
    content.view = cameras.front();
    constexpr std::size_t surface_points = 20000, error_points = 400;
    constexpr unsigned error_rays = 2048;
    const std::vector<SurfaceId> faces = largest_faces(scene, content.surfaces_left_out);
    content.surfaces = measure_surfaces(light, faces, surface_points, terminal.progress(), stop);
    if (stop.requested()) content.surfaces.clear(), content.unfinished.push_back("surfaces and materials");
    content.error = find_error_percentile(light, error_points, error_rays, terminal.progress(), stop);
    if (stop.requested()) content.error = {}, content.unfinished.push_back("the 99th percentile of the error");
    for (const Camera& camera : cameras) add_pictures(arguments, light, camera, content, terminal, stop);
    add_viewer(light, content, terminal, stop);
    return {};
}

/// Writes page and tables. Fails without a page if a stop left no table finished.
ExitCode write(const ReportArguments& arguments, const ReportContent& content, Terminal& terminal,
               const StopRequest& stop) {
    const bool is_stopped = !content.unfinished.empty();
    if (is_stopped && arguments.output.empty() && content.grids.empty() && content.observers.empty())
        return terminal.fail_stopped("no table was finished");
    Result<void> written;
    if (!arguments.output.empty()) written = write_report(content, arguments.output);
    if (written && !arguments.tables.empty()) written = write_report_tables(content, arguments.tables);
    if (written && !arguments.pdf.empty()) written = print_page(arguments.output, arguments.pdf, stop);
    if (!written) return terminal.fail(written.error());
    if (!is_stopped) return ExitCode::done;
    terminal.note(fmt::format("stopped by the {}, without {}", name_of(terminal.limits().reason()),
                              fmt::join(content.unfinished, ", ")));
    return terminal.limits().stopped_code();
}

/// Runs a report whose arguments are complete.
ExitCode make_report(const ReportArguments& arguments, std::span<const LightingTask> tasks, Terminal& terminal) {
    if (!arguments.pdf.empty())
        if (const Result<void> printer = find_page_printer(arguments.pdf); !printer)
            return terminal.fail(printer.error());
    ReportContent content;
    content.heading = arguments.heading, content.requirements = arguments.requirements;
    if (!arguments.words.empty()) {
        Result<ReportWords> words = ReportWords::load(arguments.words);
        if (!words) return terminal.fail(words.error());
        content.words = std::move(*words);
    }
    for (const MeasuringPlane& plane : arguments.planes) {
        Result<GridLight> grid = make_grid(plane);
        if (!grid) return terminal.fail(grid.error());
        content.grids.push_back(std::move(*grid));
    }
    set_threads(arguments.threads);
    const Result<Solution> solution = load_solution(arguments.solution);
    if (!solution) return terminal.fail(solution.error());
    const RadiosityFunction light(*solution);
    if (needs_rooms(arguments, solution->scene)) content.rooms = FloorRooms(solution->scene, light.stage().tracer);
    const FloorRooms& rooms = content.rooms;
    Result<std::vector<Requirement>> required = require_tasks(arguments.tasks, tasks, content.rooms);
    if (!required) return terminal.fail(required.error());
    content.requirements.insert(content.requirements.end(), required->begin(), required->end());
    if (const Result<void> added = add_working_planes(arguments, solution->scene, rooms, content.grids); !added)
        return terminal.fail(added.error());
    const Result<std::vector<Observer>> observers = find_observers(arguments.observers, light.stage(), rooms);
    if (!observers) return terminal.fail(observers.error());
    content.solution = &*solution, content.unit = unit_of(arguments.unit, solution->scene, terminal);
    content.maintenance = arguments.maintenance;
    const StopRequest& stop = terminal.limits().keep();
    add_measurements(arguments, *observers, light, content, terminal, stop);
    if (!arguments.output.empty())
        if (const Result<void> added = add_page(arguments, light, content, terminal, stop); !added)
            return terminal.fail(added.error());
    terminal.progress().finish();
    return write(arguments, content, terminal, stop);
}

}  // namespace

/// Runs `exitance report SOLUTION -o PAGE --tables FOLDER`, `exitance report --list-tasks` or `--list-words`.
ExitCode run(const ReportArguments& given, Terminal& terminal) {
    const Result<std::vector<LightingTask>> tasks = load_tasks(given.tasks_file);
    if (!tasks) return terminal.fail(tasks.error());
    if (given.lists_tasks) {
        terminal.print(table_of_tasks(*tasks));
        return ExitCode::done;
    }
    if (given.lists_words) {
        terminal.print(known_report_words("german"));
        return ExitCode::done;
    }
    const ReportArguments arguments = with_needs_of_tasks(given, *tasks);
    if (const std::optional<Error> misuse = find_misuse(arguments)) return terminal.fail(*misuse);
    return make_report(arguments, *tasks, terminal);
}

}  // namespace exitance
