#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/camera_choice.hpp"
#include "exitance/cli/camera_path.hpp"
#include "exitance/cli/common_stop.hpp"
#include "exitance/cli/light_unit.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/files/film.hpp"
#include "exitance/io/files/scratch_folder.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/pictures/display.hpp"
#include "exitance/io/pictures/isolux.hpp"
#include "exitance/io/pictures/linear_image.hpp"
#include "exitance/io/pictures/mesh_colours.hpp"
#include "exitance/io/pictures/unit_picture.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/measure/pictures/timed_picture.hpp"
#include "exitance/methods/light/mesh_of_layers.hpp"
#include "exitance/processes/result_of_all.hpp"
#include "exitance/solution/layers/light_layers.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// The error of options that cannot be combined or of values out of range; none if there is no error.
std::optional<Error> find_misuse(const RenderArguments& a) {
    const std::string end = ending(a.output);
    const auto usage = [](const std::string& message, const std::string& where, const std::string& hint) {
        return Error{ErrorCode::usage, message, where, hint};
    };
    const bool films = is_film(a.output);
    if (films && a.path.empty())
        return usage("a video needs a path of cameras", a.output, "add --path P.csv, as the viewer records it");
    if (!films && end != ".png" && end != ".exr" && end != ".hdr")
        return usage(fmt::format("pictures are written as .png, .exr or .hdr, videos as .mp4, .mkv, .webm or .gif, not "
                                 "'{}'",
                                 end),
                     a.output, "name the output something.png");
    if (a.has_scale && !a.false_colour && !a.isolux)
        return usage("has no effect without --false-colour or --isolux", "--scale, --bands, --palette",
                     "add one of them, or leave the option out");
    if (a.unit.choice != UnitChoice::scene && !a.false_colour && !a.isolux)
        return usage("has no effect without --false-colour or --isolux", "--unit",
                     "add one of them, or leave the option out");
    const bool is_drawn = a.false_colour || a.isolux || !a.mesh.empty() || a.shadow_classes;
    const bool is_toned = a.exposure != 0 || a.exposure_scale || a.tone_map != ToneCurve::filmic;
    if (end != ".png" && !films && (is_drawn || is_toned))
        return usage(
            fmt::format("{} holds radiance, without drawings or tone mapping", end), a.output,
            "--false-colour, --isolux, --mesh, --shadow-classes, --exposure and --tone-map apply to .png only");
    if (is_toned && (a.false_colour || a.shadow_classes))
        return usage("have no effect on false colours and shadow classes", "--exposure, --tone-map", "leave them out");
    if (a.false_colour && a.shadow_classes)
        return usage("cannot be combined with --false-colour: both colour the pixels", "--shadow-classes",
                     "make a picture of each");
    if (!a.path.empty() && (a.camera || !a.camera_name.empty() || a.projection != Projection::perspective))
        return usage("has its own cameras, in perspective", "--path", "omit --camera and --projection");
    if (!a.path.empty() && (a.false_colour || a.isolux) && !a.scale.range)
        return usage("needs one scale for all pictures", "--path", "add --scale LO,HI");
    if (a.gather > 0 && (!std::has_single_bit(a.gather) || a.gather > 1 << 20))
        return usage(fmt::format("{} is not a power of two from 4 to 1048576", a.gather), "--gather", "");
    if (a.interpolant && !a.layer.empty())
        return usage("cannot be combined with --interpolant: a layer is a part of it", "--layer", "omit one of them");
    const char* shown = a.interpolant ? "--interpolant" : a.layer.empty() ? nullptr : "--layer";
    if (shown && a.gather > 0)
        return usage(fmt::format("cannot be combined with {}, which shows light as it is stored", shown), "--gather",
                     "omit one of them");
    if (shown && a.shadow_classes && !a.isolux)
        return usage("has no effect on shadow classes without --isolux", shown, "leave it out, or add --isolux");
    return std::nullopt;
}

/// The picture in display colours (false colours or tone-mapped). Adds the exposure to `texts`.
Image develop(const RenderArguments& arguments, const Picture& picture, const LightUnit& own, ImageTexts& texts,
              Terminal& terminal) {
    if (arguments.false_colour) {
        const ColourScale scale = make_colour_scale(picture, *arguments.false_colour, arguments.scale);
        return false_colour_image(picture, *arguments.false_colour, scale);
    }
    ToneMap tones;
    tones.curve = arguments.tone_map;
    tones.scale = arguments.exposure_scale.value_or(automatic_exposure(picture) * std::exp2(arguments.exposure));
    const std::string stops =
        arguments.exposure_scale ? "" : fmt::format("{:+.4g} stops above automatic; ", arguments.exposure);
    texts.emplace_back(
        "Exposure", fmt::format("{}radiosity in {} times {:.6g}, then a {} curve", stops, own.radiosity(), tones.scale,
                                tones.curve == ToneCurve::filmic ? "filmic" : "linear"));
    if (!arguments.exposure_scale) terminal.note(fmt::format("--exposure {:.4g}x", tones.scale));
    return display_image(picture, tones);
}

/// The method's elements or, for --mesh export, the exported elements. A solution with direct light only has no others.
const ElementTree& shown_elements(const RenderArguments& arguments, const Solution& solution) {
    const bool of_export = arguments.mesh == "export" || solution.bounces == 0;
    return of_export ? solution.interpolant.tree : solution.indirect.tree;
}

Result<void> write_display(const RenderArguments& arguments, const RadiosityFunction& light, const Camera& camera,
                           const Picture& picture, Terminal& terminal) {
    ImageTexts texts{{"Software", "exitance"}, {"Camera", describe(camera)}};
    const SixNodeMesh& mesh = light.solution().discontinuity;
    const Scene& scene = light.solution().scene;
    const LightUnit unit = unit_of(arguments.unit, scene, terminal);
    // Without --unit, light in watts keeps its bands: false colours show their mean or their weighted sum (luminance).
    const bool is_one_number = arguments.unit.choice != UnitChoice::scene || unit.is_lux();
    const Picture shown = is_one_number ? in_unit(picture, unit) : picture;
    MeshView view;
    std::vector<KeyEntry> key;
    if (!mesh.empty() && (!arguments.mesh.empty() || arguments.shadow_classes))
        view = view_mesh(mesh, scene, light.stage().tracer, camera, arguments.size);
    if (arguments.shadow_classes) key = shadow_class_key();
    Image image = arguments.shadow_classes ? shadow_class_image(mesh, scene, view)
                                           : develop(arguments, arguments.false_colour ? shown : picture,
                                                     own_unit(scene.is_photometric()), texts, terminal);
    if (!arguments.mesh.empty() && !mesh.empty()) {
        draw_ordered_edges(image, mesh_edges(mesh, view));
        for (const KeyEntry& entry : edge_order_key()) key.push_back(entry);
    } else if (!arguments.mesh.empty())
        draw_edges(image, element_edges(shown_elements(arguments, light.solution()), scene, light.stage().tracer,
                                        camera, arguments.size));
    if (!key.empty()) draw_key(image, key);
    if (arguments.isolux) {
        const Quantity quantity = unit.is_lux() ? Quantity::illuminance : Quantity::irradiance;
        draw_isolux(image, shown, quantity, make_colour_scale(shown, quantity, arguments.scale),
                    "lines " + title(quantity, unit.is_lux()));
    }
    if (arguments.false_colour)
        draw_legend(image, title(*arguments.false_colour, unit.is_lux()),
                    make_colour_scale(shown, *arguments.false_colour, arguments.scale));
    return write_png(arguments.output, image, texts);
}

Result<void> write_linear(const RenderArguments& arguments, const LightUnit& own, const Camera& camera,
                          const Picture& picture) {
    const ImageFacts facts{
        {"software", "exitance"},
        {"camera", describe(camera)},
        {"units", fmt::format("R, G, B: radiance in {}; irradiance: {}", own.radiance(), own.irradiance())}};
    const LinearImage image = linear_image(picture);
    return ending(arguments.output) == ".exr" ? write_exr(arguments.output, image, facts)
                                              : write_hdr(arguments.output, image, facts);
}

/// Writes a picture in the first process. Collective.
Result<void> write_picture(const RenderArguments& arguments, const RadiosityFunction& light, const Camera& camera,
                           const Picture& picture, Terminal& terminal) {
    return by_first([&] {
        return ending(arguments.output) == ".png"
                   ? write_display(arguments, light, camera, picture, terminal)
                   : write_linear(arguments, own_unit(light.solution().scene.is_photometric()), camera, picture);
    });
}

/// Inserts a number before the file name extension: "walk.0012.png" from "walk.png" and 12.
std::string numbered(const std::string& output, std::size_t number) {
    const std::string end = ending(output);
    return fmt::format("{}.{:04}{}", output.substr(0, output.size() - end.size()), number, end);
}

/// Seconds per pixel for tone mapping, drawing, compression and writing. Measured 0.2 to 0.5 us in pictures of 640 x
/// 400 to 8192 x 8192 pixels, as .png and .exr.
constexpr double write_seconds_a_pixel = 0.5e-6;

/// Sets a deadline that leaves time to write the picture before the time limit.
void keep_time_to_write(const RenderArguments& arguments, const RunLimits& limits, CommonStop& stop) {
    const double write_seconds = write_seconds_a_pixel * static_cast<double>(arguments.size.pixels());
    if (arguments.limits.time_limit)
        stop.set_deadline(
            seconds_from_now(limits.seconds_left() - std::min(write_seconds, 0.5 * limits.seconds_left())));
}

/// Note about a picture that is coarser than requested because of a stop.
std::string describe_stop(const TimedPicture& taken, const RenderArguments& arguments, StopReason why) {
    if (taken.samples > 0)
        return fmt::format("stopped by the {}: the picture has {} of {} samples per pixel", name_of(why), taken.samples,
                           arguments.samples);
    return fmt::format(
        "stopped by the {}: there was no time for one sample per pixel, so the picture consists of squares of at most "
        "{} x {} pixels",
        name_of(why), taken.block, taken.block);
}

/// The irradiance that pictures show in place of the full solution. Empty if they show the solution.
Result<ShownIrradiance> shown_light(const RenderArguments& arguments, const RadiosityFunction& light) {
    if (arguments.interpolant)
        return ShownIrradiance([&light](RegionId r, const Point& x) {
            const ProbePoint place{x, light.solution().scene.regions()[r].plane.n};
            return light.interpolant_at(std::span(&place, 1)).front().irradiance;
        });
    if (arguments.layer.empty()) return ShownIrradiance();
    const LightLayers& layers = layers_of(light.solution());
    if (layers.empty())
        return Error{ErrorCode::usage, "the solution has no layers", "--layer",
                     "solve with --method discontinuity --layers on"};
    const Scene& scene = light.solution().scene;
    std::vector<std::uint32_t> sources = named_sources(layers, scene, arguments.layer);
    if (sources.empty())
        return Error{ErrorCode::usage, fmt::format("no source is called '{}'", arguments.layer), "--layer",
                     fmt::format("give a number from 1 to {}, or the name of an emitter's material or group",
                                 layers.sources.size())};
    return ShownIrradiance([&layers, &scene, sources = std::move(sources)](RegionId r, const Point& x) {
        return light_at(layers, scene, r, x, sources);
    });
}

PictureOptions picture_options(const RenderArguments& arguments, const Camera& camera) {
    PictureOptions options{camera, arguments.size, static_cast<int>(arguments.samples)};
    options.gather = static_cast<unsigned>(arguments.gather);
    return options;
}

/// Renders numbered pictures, one per camera, all with the exposure of the first. Sets `done` to the number of finished
/// pictures.
ExitCode render_path(const RenderArguments& arguments, const std::vector<Camera>& cameras,
                     const RadiosityFunction& light, const ShownIrradiance& shown, Terminal& terminal,
                     std::size_t& done) {
    CommonStop stop(terminal, terminal.limits().keep());
    keep_time_to_write(arguments, terminal.limits(), stop);
    RenderArguments frame = arguments;
    for (done = 0; done < cameras.size(); ++done) {
        const std::size_t i = done;
        const Picture picture =
            take_picture_of(shown, light, picture_options(arguments, cameras[i]), terminal.progress(), stop.request());
        if (stop.request().requested()) break;
        if (!frame.exposure_scale) frame.exposure_scale = automatic_exposure(picture) * std::exp2(arguments.exposure);
        frame.output = numbered(arguments.output, i + 1);
        const Result<void> written = write_picture(frame, light, cameras[i], picture, terminal);
        if (!written) return terminal.fail(written.error());
    }
    terminal.progress().finish();
    if (done > 0) terminal.note(fmt::format("{} pictures with --exposure {:.4g}x", done, *frame.exposure_scale));
    if (done == cameras.size()) return ExitCode::done;
    if (done == 0) return stop.fail("no picture was finished");
    terminal.note(
        fmt::format("stopped by the {}: {} of {} pictures are finished", name_of(stop.reason()), done, cameras.size()));
    return stop.stopped_code();
}

/// Renders a video from pictures at equal intervals along the path. The pictures are in a temporary folder.
ExitCode render_film(const RenderArguments& arguments, const std::vector<CameraStation>& stations,
                     const RadiosityFunction& light, const ShownIrradiance& shown, Terminal& terminal) {
    constexpr double rate = 25;  // pictures per second
    constexpr std::size_t max_pictures = 9999;
    const Result<void> found = by_first([&] { return find_film_program(arguments.output); });
    if (!found) return terminal.fail(found.error());
    const auto falls = [](const CameraStation& a, const CameraStation& b) { return b.time < a.time; };
    const std::vector<Camera> cameras = std::adjacent_find(stations.begin(), stations.end(), falls) == stations.end()
                                            ? at_equal_times(stations, rate, max_pictures)
                                            : std::vector<Camera>();
    if (cameras.empty())
        return terminal.fail(Error{ErrorCode::bad_input, "times of a video must increase and span at most 400 s",
                                   arguments.path, "the first number of a row is its time in seconds"});
    std::optional<ScratchFolder> folder;  // only set in the first process, which writes the pictures
    RenderArguments frames = arguments;
    const Result<void> made = by_first([&]() -> Result<void> {
        Result<ScratchFolder> found = ScratchFolder::make("exitance-film");
        if (!found) return found.error();
        folder.emplace(std::move(*found));
        frames.output = folder->path() + "/frame.png";
        return {};
    });
    if (!made) return terminal.fail(made.error());
    std::size_t finished = 0;
    const ExitCode code = render_path(frames, cameras, light, shown, terminal, finished);
    if (finished == 0) return code;
    const Result<void> written = by_first([&] { return write_film(folder->path(), rate, arguments.output); });
    return written ? code : terminal.fail(written.error());
}

/// Renders one picture, with all samples or as many as the limits allow.
ExitCode render_picture(const RenderArguments& arguments, const RadiosityFunction& light, const ShownIrradiance& shown,
                        Terminal& terminal) {
    const Result<Camera> camera = choose_camera(arguments, light);
    if (!camera) return terminal.fail(camera.error());
    if (!arguments.camera) terminal.note(fmt::format("--camera '{}'", describe(*camera)));
    const PictureOptions options = picture_options(arguments, *camera);
    TimedPicture taken;
    taken.is_complete = true;
    std::optional<CommonStop> stop;
    if (!arguments.shadow_classes || arguments.isolux) {
        stop.emplace(terminal, terminal.limits().keep());
        keep_time_to_write(arguments, terminal.limits(), *stop);
        taken = take_picture_in_time(light, options, terminal.progress(), stop->request(), shown);
    }
    terminal.progress().finish();
    if (taken.block == 0 && !taken.is_complete) return stop->fail("not even a coarse picture was finished");
    const Result<void> written = write_picture(arguments, light, *camera, taken.picture, terminal);
    if (!written) return terminal.fail(written.error());
    if (taken.is_complete) return ExitCode::done;
    terminal.note(describe_stop(taken, arguments, stop->reason()));
    return stop->stopped_code();
}

}  // namespace

/// Runs `exitance render SOLUTION -o PICTURE`.
ExitCode run(const RenderArguments& arguments, Terminal& terminal) {
    if (const std::optional<Error> misuse = find_misuse(arguments)) return terminal.fail(*misuse);
    set_threads(arguments.threads);
    Result<Solution> solution = all_or_none(load_solution(arguments.solution));
    if (!solution) return terminal.fail(solution.error());
    if (arguments.shadow_classes || !arguments.mesh.empty())
        if (const Result<void> made = make_requested_mesh(*solution); !made) return terminal.fail(made.error());

    if (arguments.shadow_classes && solution->discontinuity.empty())
        return terminal.fail(Error{ErrorCode::usage, "the solution has no faces with shadow classes",
                                   "--shadow-classes", "solve with --method discontinuity"});

    const RadiosityFunction light(*solution);
    const Result<ShownIrradiance> shown = shown_light(arguments, light);
    if (!shown) return terminal.fail(shown.error());
    if (!arguments.path.empty()) {
        const Result<std::vector<CameraStation>> stations = all_or_none(load_camera_path(arguments.path));
        if (!stations) return terminal.fail(stations.error());
        if (is_film(arguments.output)) return render_film(arguments, *stations, light, *shown, terminal);
        std::vector<Camera> cameras;
        for (const CameraStation& station : *stations) cameras.push_back(station.camera);
        std::size_t done = 0;
        return render_path(arguments, cameras, light, *shown, terminal, done);
    }
    return render_picture(arguments, light, *shown, terminal);
}

}  // namespace exitance
