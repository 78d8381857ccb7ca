#include "exitance/cli/arguments.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "exitance/cli/nearest.hpp"

namespace exitance {
namespace {

using Parsed = std::variant<Command, Information>;

// -------------------------------------------------------------------------------------------------- values

std::vector<std::string> names_of(const auto& table) {
    std::vector<std::string> names;
    for (const auto& entry : table) names.emplace_back(entry.second);
    return names;
}

/// An option whose values are the names of a table.
template <class Choice, std::size_t N, class Target>
CLI::Option* add_choice(CLI::App& app, const std::string& name,
                        const std::array<std::pair<Choice, std::string_view>, N>& table, Target& target,
                        const std::string& help) {
    const auto read = [name, &table, &target](const std::string& word) {
        for (const auto& [value, known] : table)
            if (known == word) {
                target = value;
                return;
            }
        throw CLI::ValidationError(name, fmt::format("'{}' is not one of {}", word, fmt::join(names_of(table), ", ")));
    };
    return app.add_option_function<std::string>(name, read, help)
        ->type_name(fmt::format("{}", fmt::join(names_of(table), "|")));
}

double read_number(const std::string& option, const std::string& word) {
    double value = 0;
    if (!CLI::detail::lexical_cast(word, value) || !std::isfinite(value))
        throw CLI::ValidationError(option, fmt::format("'{}' is not a number", word));
    return value;
}

/// A number above 0.
template <class Target>
CLI::Option* add_positive(CLI::App& app, const std::string& name, Target& target, const std::string& unit,
                          const std::string& help) {
    const auto read = [name, &target](const std::string& word) {
        const double value = read_number(name, word);
        if (value <= 0) throw CLI::ValidationError(name, fmt::format("must be above 0, not {}", word));
        target = value;
    };
    return app.add_option_function<std::string>(name, read, help)->type_name(unit);
}

/// A whole number of at least `least`.
template <class Target>
CLI::Option* add_count(CLI::App& app, const std::string& name, Target& target, long long least,
                       const std::string& help) {
    constexpr double most = std::is_same_v<Target, int> ? 1 << 16 : 9e15;
    const auto read = [name, &target, least](const std::string& word) {
        const double value = read_number(name, word);
        if (value != std::floor(value) || value < static_cast<double>(least))
            throw CLI::ValidationError(name, fmt::format("must be a whole number from {}, not {}", least, word));
        if (value > most) throw CLI::ValidationError(name, fmt::format("{} is too much", word));
        target = static_cast<std::size_t>(value);
    };
    return app.add_option_function<std::string>(name, read, help)->type_name("N");
}

int read_bounces(const std::string& word) {
    if (word == "all") return all_bounces;
    const double value = read_number("--bounces", word);
    if (value != std::floor(value) || value < 0 || value > 1e9)
        throw CLI::ValidationError("--bounces", fmt::format("must be 'all' or a whole number from 0, not {}", word));
    return static_cast<int>(value);
}

/// "4G", "500M", "1048576": bytes, with K, M, G and T as powers of 1024.
std::size_t read_bytes(const std::string& option, const std::string& word) {
    const std::size_t digits = std::min(word.find_first_not_of("0123456789."), word.size());
    std::string unit = word.substr(digits);
    for (char& c : unit) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const std::vector<std::string> units{"", "K", "M", "G", "T"};
    const auto at = std::find_if(units.begin(), units.end(), [&](const std::string& prefix) {
        return unit == prefix || unit == prefix + "B" || (!prefix.empty() && unit == prefix + "IB");
    });
    if (digits == 0 || at == units.end())
        throw CLI::ValidationError(option, fmt::format("'{}' is not a size such as 500M or 4G", word));
    const double bytes =
        std::ldexp(read_number(option, word.substr(0, digits)), static_cast<int>(10 * (at - units.begin())));
    if (bytes < 1 || bytes > 1e18)
        throw CLI::ValidationError(option, fmt::format("must be between 1 byte and an exabyte, not {}", word));
    return static_cast<std::size_t>(bytes);
}

/// Numbers between commas and blanks.
std::vector<double> read_numbers(const std::string& option, std::string words) {
    std::replace(words.begin(), words.end(), ',', ' ');
    std::vector<double> numbers;
    std::istringstream in(words);
    for (std::string word; in >> word;) numbers.push_back(read_number(option, word));
    return numbers;
}

/// "auto", "ex,ey,ez tx,ty,tz fov" (metres and degrees; the last may be left out), or what the scene's cameras are
/// called.
void read_camera(const std::string& words, RenderArguments& arguments) {
    arguments.camera.reset(), arguments.fov.reset(), arguments.camera_name.clear();
    if (words == "auto") return;
    if (words.find_first_of(", ") == std::string::npos ||
        words.find_first_not_of("0123456789.,+-eE ") != std::string::npos) {
        arguments.camera_name = words;
        return;
    }
    const std::vector<double> n = read_numbers("--camera", words);
    if (n.size() != 6 && n.size() != 7)
        throw CLI::ValidationError("--camera", fmt::format("'{}' is not 'ex,ey,ez tx,ty,tz fov'", words));
    const Camera camera{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    if (n.size() == 7) arguments.fov = n[6];
    if (camera.eye == camera.target) throw CLI::ValidationError("--camera", "looks at where it stands");
    arguments.camera = camera;
}

/// "ox,oy,oz ux,uy,uz vx,vy,vz spacing [margin]", metres; spacing may be "auto".
MeasuringPlane read_plane(std::string words) {
    const std::string given = words;
    if (const std::size_t at = words.find("auto"); at != std::string::npos) words.replace(at, 4, "0");
    const std::vector<double> n = read_numbers("--grid", words);
    const bool automatic = words != given;
    if ((n.size() != 10 && n.size() != 11) || (automatic ? n[9] != 0 : !(n[9] > 0)))
        throw CLI::ValidationError("--grid",
                                   fmt::format("'{}' is not 'ox,oy,oz ux,uy,uz vx,vy,vz spacing [margin]'", given));
    return {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}, n[9], n.size() == 11 ? n[10] : 0};
}

/// "640x400"
PictureSize read_size(const std::string& words) {
    std::string blank = words;
    std::replace(blank.begin(), blank.end(), 'x', ' ');
    const std::vector<double> n = read_numbers("--size", blank);
    const bool whole = n.size() == 2 && n[0] == std::floor(n[0]) && n[1] == std::floor(n[1]);
    if (!whole || std::min(n[0], n[1]) < 1 || std::max(n[0], n[1]) > 16384)
        throw CLI::ValidationError("--size", fmt::format("'{}' is not a size such as 640x400, at most 16384", words));
    return {static_cast<int>(n[0]), static_cast<int>(n[1])};
}

/// "0,500", "log", "1,1000,log"
void read_scale(std::string words, ScaleChoice& scale) {
    if (words == "log" || words.ends_with(",log")) {
        scale.by_ratio = true;
        words.erase(words.size() > 3 ? words.size() - 4 : 0);
        if (words.empty()) return;
    }
    const std::vector<double> n = read_numbers("--scale", words);
    if (n.size() != 2 || !(n[0] < n[1]))
        throw CLI::ValidationError("--scale", fmt::format("'{}' is not 'LO,HI' with LO below HI", words));
    if (scale.by_ratio && !(n[0] > 0)) throw CLI::ValidationError("--scale", "by ratios begins above 0");
    scale.range = std::pair(n[0], n[1]);
}

/// "10" or "smooth"
void read_bands(const std::string& word, ScaleChoice& scale) {
    scale.smooth = word == "smooth";
    if (scale.smooth) return;
    const double value = read_number("--bands", word);
    if (value != std::floor(value) || value < 1 || value > 100)
        throw CLI::ValidationError("--bands",
                                   fmt::format("must be 'smooth' or a whole number from 1 to 100, not {}", word));
    scale.bands = static_cast<std::size_t>(value);
}

// -------------------------------------------------------------------------------------------------- verbs

constexpr std::array<std::pair<Quantity, std::string_view>, 4> quantity_names{{
    {Quantity::radiosity, "radiosity"},
    {Quantity::irradiance, "irradiance"},
    {Quantity::luminance, "luminance"},
    {Quantity::illuminance, "illuminance"},
}};

constexpr std::array<std::pair<Palette, std::string_view>, 4> palette_names{{
    {Palette::viridis, "viridis"},
    {Palette::inferno, "inferno"},
    {Palette::turbo, "turbo"},
    {Palette::grey, "grey"},
}};

constexpr std::array<std::pair<Projection, std::string_view>, 4> projection_names{{
    {Projection::perspective, "perspective"},
    {Projection::orthographic, "orthographic"},
    {Projection::fisheye, "fisheye"},
    {Projection::panorama, "panorama"},
}};

constexpr std::array<std::pair<ToneCurve, std::string_view>, 2> tone_names{{
    {ToneCurve::filmic, "filmic"},
    {ToneCurve::linear, "linear"},
}};

constexpr std::array<std::pair<ProgressStyle, std::string_view>, 5> progress_names{{
    {ProgressStyle::automatic, "auto"},
    {ProgressStyle::bar, "bar"},
    {ProgressStyle::plain, "plain"},
    {ProgressStyle::json, "json"},
    {ProgressStyle::none, "none"},
}};

constexpr std::array<std::pair<Component, std::string_view>, 3> component_names{{
    {Component::total, "total"},
    {Component::direct, "direct"},
    {Component::indirect, "indirect"},
}};

bool read_switch(const char* option, const std::string& word) {
    if (word != "on" && word != "off")
        throw CLI::ValidationError(option, fmt::format("must be on or off, not '{}'", word));
    return word == "on";
}

void declare_common(CLI::App& app, CommonArguments& arguments) {
    app.add_flag("-q,--quiet", arguments.quiet, "Nothing but errors on the error stream");
    app.add_flag("-v,--verbose", arguments.verbose, "Say more on the error stream");
}

void declare_json(CLI::App& app, CommonArguments& arguments) {
    app.add_flag("--json", arguments.json, "Facts as JSON on standard output");
}

void declare_work(CLI::App& app, CommonArguments& arguments, int& threads) {
    add_count(app, "--threads", threads, 1, "Threads to use; default all. The result does not depend on it");
    add_choice(app, "--progress", progress_names, arguments.progress,
               "auto: a bar on a terminal, a line every ten seconds otherwise");
}

void declare_scene(CLI::App& app, SceneArguments& scene) {
    app.add_option("SCENE", scene.files, "Scene (.obj with its .mtl, .gltf, .glb, .rad); several files make one")
        ->required();
    app.add_flag_callback(
        "--strict", [&scene] { scene.load.faults = Faults::refuse; },
        "Faults of the scene are errors; else they are repaired");
    app.add_option("--luminaires", scene.load.luminaires,
                   "Table of luminaires in the scene (.csv): file,x,y,z and, where wanted, aim_x,aim_y,aim_z,rotation,"
                   "dimming,lumens,maintenance_factor,group")
        ->type_name("FILE");
    app.add_flag("--run-commands", scene.load.run_commands,
                 "Have lines of .rad files that begin with '!' done by Radiance's programs, where they are installed");
}

/// on or off, into a bool or an optional one.
template <class Switch>
CLI::Option* add_switch(CLI::App& app, const std::string& name, Switch& value, const std::string& help) {
    return app
        .add_option_function<std::string>(
            name, [name, &value](const std::string& w) { value = read_switch(name.c_str(), w); }, help)
        ->type_name("on|off");
}

constexpr std::array<std::pair<bool, std::string_view>, 2> quantity_kinds{
    {{false, "radiometric"}, {true, "photometric"}}};

void declare_accuracy(CLI::App& app, SolveOptions& o) {
    add_positive(app, "--error", o.error, "R", "Relative RMS error asked for; default 0.02")->group("Accuracy");
    add_positive(app, "--error-interpolant", o.error_interpolant, "R", "Relative RMS error asked of what export writes")
        ->group("Accuracy");
    add_positive(app, "--mesh-size", o.mesh_size, "METRES", "Longest edge of an element")->group("Accuracy");
    add_positive(app, "--min-area", o.min_area, "M2", "No element is cut smaller, m^2")->group("Accuracy");
    add_positive(app, "--residual", o.residual, "R", "Of the system, relative to its right side")->group("Accuracy");
    add_count(app, "--max-iterations", o.max_iterations, 1, "Sweeps, Krylov steps or shots")->group("Accuracy");
    add_positive(app, "--epsilon", o.epsilon, "R",
                 "Error of all links of a hierarchy together, relative RMS; has pairs judged")
        ->group("Accuracy");
}

void declare_method(CLI::App& app, SolveArguments& arguments) {
    SolveOptions& o = arguments.options;
    add_choice(app, "--relaxation", relaxation_names, o.relaxation, "How the system is solved")->group("Method");
    app.add_flag("--overshooting", o.overshooting, "Shoot ahead what will come back")->group("Method");
    add_choice(app, "--visibility", visibility_names, o.visibility, "Default auto")->group("Method");
    add_count(app, "--visibility-samples", o.visibility_samples, 1, "Rays a pair of elements")->group("Method");
    add_switch(app, "--triage", o.triage, "Links look for certain visibility before they cast rays; default on")
        ->group("Method");
    app.add_option_function<std::string>(
           "--clusters",
           [&o](const std::string& w) {
               o.clusters = w == "auto" ? std::nullopt : std::optional(read_switch("--clusters", w));
           },
           "Links between clusters of polygons, too; default auto: where they are many")
        ->type_name("auto|on|off")
        ->group("Method");
    add_switch(app, "--smoothing", o.smoothing,
               "Deliver the method's elements in place of gathering their light: smoothed, or (off) as they are, of "
               "hierarchies as links alone have them")
        ->group("Method");
    app.add_option("--importance", arguments.importance,
                   "Refine links for the light at these points (.csv or .pts, as of probe)")
        ->type_name("FILE")
        ->group("Method");
    app.add_flag("--keep-links", o.keep_links, "Put a hierarchy's links into the solution, for export --links")
        ->group("Method");
    add_choice(app, "--oracle", oracle_names, o.oracle,
               "By what links are cut: error of what they bring (default), form factor, or power")
        ->group("Method");
    add_choice(app, "--form-factors", form_factor_names, o.form_factors, "Where a method has the choice")
        ->group("Method");
    add_count(app, "--hemicube-cells", o.hemicube_cells, 2, "Along an edge of a hemicube's top, even")->group("Method");
    add_count(app, "--seed", o.seed, 0, "Of the random numbers; default 1")->group("Method");
}

void declare_limits(CLI::App& app, SolveArguments& arguments) {
    SolveOptions& o = arguments.options;
    add_positive(app, "--time-limit", arguments.time_limit, "SECONDS", "Stop then and write what there is")
        ->group("Limits");
    app.add_option_function<std::string>(
           "--memory-limit", [&o](const std::string& w) { o.memory_limit_bytes = read_bytes("--memory-limit", w); },
           "Such as 4G")
        ->type_name("SIZE")
        ->group("Limits");
    add_positive(app, "--checkpoint-every", arguments.checkpoint_every, "SECONDS",
                 "Keep the state in FILE.checkpoint beside the output")
        ->group("Limits");
    app.add_flag("--resume", arguments.resume, "Go on from that state, if there is one")->group("Limits");
    app.add_flag("--dry-run", arguments.dry_run, "Counts and a forecast; nothing is solved or written")
        ->group("Limits");
}

void declare(CLI::App& app, SolveArguments& arguments) {
    SolveOptions& o = arguments.options;
    declare_scene(app, arguments.scene);
    app.add_option("-o,--output", arguments.output, "Solution to write (.h5)")->type_name("FILE");
    add_choice(app, "--method", method_names, o.method, "Default auto: what is best for the scene");
    add_choice(app, "--basis", basis_names, o.basis,
               "Of matrix: constant, linear, galerkin1 to 3; of wavelet: the others");
    app.callback([&o] {
        if (o.basis && !fits(*o.basis, o.method))
            throw CLI::ValidationError("--basis",
                                       fmt::format("method {} has no basis {}", name_in(method_names, o.method),
                                                   name_in(basis_names, *o.basis)));
    });
    app.add_option_function<std::string>(
           "--bounces", [&o](const std::string& w) { o.bounces = read_bounces(w); },
           "0: direct light alone; default all")
        ->type_name("N|all");
    declare_accuracy(app, o);
    declare_method(app, arguments);
    declare_limits(app, arguments);
    declare_json(app, arguments);
    declare_work(app, arguments, o.threads);
    add_choice(app, "--quantity", quantity_kinds, arguments.photometric,
               "Is light given in watts or in lumens? Default by the file: photometric where glTF has lights");
    add_choice(app, "--schedule", schedule_names, o.schedule,
               "How work comes to threads; default stealing. The result does not depend on it");
    app.add_option("--trace", arguments.trace, "Write every task's time, thread and data (Chrome trace format, .json)")
        ->type_name("FILE");
}

void declare(CLI::App& app, ProbeArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution (.h5)")->required();
    app.add_option("--points", arguments.points, "CSV x,y,z,nx,ny,nz or .pts x y z dx dy dz; - for standard input")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", arguments.output, "CSV with E_* and B_*; default - for standard output")
        ->type_name("FILE");
    app.add_flag("--interpolant", arguments.interpolant, "Evaluate what export writes, not the full function");
    add_choice(app, "--component", component_names, arguments.component, "Default total");
    add_count(app, "--reference", arguments.reference_paths, 1,
              "N unbiased paths a point in place of the solution, with their standard errors");
    add_count(app, "--seed", arguments.seed, 0, "Of the paths; default 1");
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, CompareArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution (.h5)")->required();
    app.add_option("REFERENCE", arguments.reference, "Probe CSV with E_*, or another solution")->required();
    declare_json(app, arguments);
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, StatsArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution (.h5)")->required();
    declare_json(app, arguments);
}

void declare(CLI::App& app, ExportArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution (.h5)")->required();
    app.add_option("-o,--output", arguments.output, "By ending: .glb, .hdf or .vtkhdf, .vtu, .obj, .csv")
        ->type_name("FILE")
        ->required();
    app.add_option(
           "--links", arguments.links,
           "Of a solution with --keep-links: the links to an element, by its number, or, with those to all that "
           "it is part of, to the one at x,y,z; as .csv, .obj or .glb")
        ->type_name("ELEMENT");
}

void declare(CLI::App& app, RenderArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution (.h5)")->required();
    app.add_option("-o,--output", arguments.output, "Picture to write: .png, or linear radiance as .exr or .hdr")
        ->type_name("FILE")
        ->required();
    app.add_option_function<std::string>(
           "--camera", [&arguments](const std::string& w) { read_camera(w, arguments); },
           "auto (default): one that shows much; 'ex,ey,ez tx,ty,tz fov': eye and target in metres, horizontal "
           "angle in degrees (orthographic: width in metres); or a camera of the scene, by name or by number from 1")
        ->type_name("CAMERA");
    add_choice(app, "--projection", projection_names, arguments.projection,
               "Default perspective; fisheye: equidistant; panorama: 360 x 180 degrees");
    app.add_option_function<std::string>(
           "--size", [&arguments](const std::string& w) { arguments.size = read_size(w); }, "Pixels; default 640x400")
        ->type_name("WxH");
    add_count(app, "--samples", arguments.samples, 1, "Rays a pixel, at most 1024; default 16")
        ->check(CLI::Range(1, 1024));
    add_count(app, "--gather", arguments.gather, 4,
              "Final gather by so many rays at every sample, in place of the elements' indirect light; a power of two");
    const auto read_exposure = [&arguments](const std::string& word) {
        if (word.ends_with('x')) {
            arguments.exposure_scale = read_number("--exposure", word.substr(0, word.size() - 1));
            if (!(*arguments.exposure_scale > 0))
                throw CLI::ValidationError("--exposure", fmt::format("must multiply by more than 0, not {}", word));
            return;
        }
        arguments.exposure = word == "auto" ? 0 : read_number("--exposure", word);
        if (std::abs(arguments.exposure) > 60)
            throw CLI::ValidationError("--exposure", fmt::format("must be between -60 and 60 stops, not {}", word));
    };
    app.add_option_function<std::string>(
           "--exposure", read_exposure,
           "Stops above the automatic exposure: 1 is twice as bright; or 0.02x: radiosity "
           "times 0.02, the same in every picture; default auto")
        ->type_name("STOPS|FACTORx|auto")
        ->group("PNG");
    add_choice(app, "--tone-map", tone_names, arguments.tone_map, "Default filmic")->group("PNG");
    add_choice(app, "--false-colour", quantity_names, arguments.false_colour,
               "Values as colours, with a legend; the last two as the eye weighs the bands")
        ->group("PNG");
    const auto of_scale = [&app, &arguments](const char* name, const char* help, const char* type, auto read) {
        app.add_option_function<std::string>(
               name, [&arguments, read](const std::string& w) { read(w, arguments.scale), arguments.has_scale = true; },
               help)
            ->type_name(type)
            ->group("PNG");
    };
    of_scale("--scale", "Range of the colours and lines: 0,500, or 1,1000,log for equal ratios; log: those alone",
             "LO,HI[,log]|log", read_scale);
    of_scale("--bands", "So many colours of equal width, or smooth; default round steps", "N|smooth", read_bands);
    add_choice(app, "--palette", palette_names, arguments.scale.palette, "Default viridis")
        ->group("PNG")
        ->each([&arguments](const std::string&) { arguments.has_scale = true; });
    app.add_flag("--isolux", arguments.isolux, "Draw lines of equal illuminance, with their values")->group("PNG");
    app.add_flag("--mesh", arguments.mesh, "Draw the elements' edges")->group("PNG");
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, BakeArguments& arguments) {
    LightMapFormat& format = arguments.format;
    app.add_option("SOLUTION", arguments.solution, "Solution (.h5)")->required();
    app.add_option("-o,--output", arguments.output,
                   "Folder for lightmaps.json, lightmap_0.exr and .png, ..., scene.glb")
        ->type_name("FOLDER")
        ->required();
    add_positive(app, "--density", arguments.density, "T",
                 "Texels per metre; default: 64 (in small scenes more), with at most a million texels on surfaces");
    add_count(app, "--padding", arguments.padding, 1,
              "Texels around every chart; 2^m keep charts apart down to mip level m; default 4")
        ->check(CLI::Range(1, 256));
    add_choice(app, "--quantity", light_map_quantity_names, format.quantity, "In W/m^2; default irradiance");
    app.add_flag_callback(
        "--half", [&format] { format.precision = Precision::half; }, "EXR of 16-bit numbers in place of 32-bit ones");
    CLI::Option* unlit = app.add_flag_callback(
        "--unlit", [&format] { format.material = LightMapMaterial::unlit; },
        "The .glb shows a toned picture of the light as base colour; default: linear light as emission");
    app.add_flag_callback(
           "--moz-lightmap", [&format] { format.material = LightMapMaterial::moz_lightmap; },
           "The .glb has base colours, and its light in the extension MOZ_lightmap")
        ->excludes(unlit);
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, ReportArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution (.h5)")->required();
    app.add_option("-o,--output", arguments.output, "Page to write (.html), its numbers beside it (.json)")
        ->type_name("FILE")
        ->required();
    app.add_option_function<std::vector<std::string>>(
           "--grid",
           [&arguments](const std::vector<std::string>& all) {
               for (const std::string& words : all) arguments.planes.push_back(read_plane(words));
           },
           "Plane to measure on, 'ox,oy,oz ux,uy,uz vx,vy,vz spacing [margin]': a corner, two edges, the distance of "
           "points (auto: that of EN 12464-1) and a strip to leave out, metres; light from where u x v points. May be "
           "given again")
        ->type_name("PLANE")
        ->expected(1)
        ->take_all();
    app.add_option_function<std::vector<std::string>>(
           "--camera",
           [&arguments](const std::vector<std::string>& all) {
               for (const std::string& words : all) read_camera(words, arguments.views.emplace_back());
           },
           "As of render; may be given again. Default: one that shows much, and up to three of the scene's")
        ->type_name("CAMERA")
        ->expected(1)
        ->take_all();
    app.add_option_function<std::string>(
           "--size", [&arguments](const std::string& w) { arguments.size = read_size(w); }, "Pixels; default 960x600")
        ->type_name("WxH");
    add_choice(app, "--unit", report_unit_names, arguments.unit,
               "watt (default): W/m^2, mean of the bands; lux: lx, where emitters are given in cd/m^2");
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, CheckArguments& arguments) {
    declare_scene(app, arguments.scene);
    app.add_option("--picture", arguments.picture, "Picture of the scene that marks what was found (.png)")
        ->type_name("FILE");
    declare_json(app, arguments);
}

void declare(CLI::App& app, GenerateArguments& arguments) {
    app.add_option("FAMILY", arguments.family, "Family of scenes, or 'list'")->required();
    app.add_option("PARAMETERS", arguments.parameters, "Of the family, name=value");
    app.add_option("-o,--output", arguments.output, "Scene to write (.obj, its .mtl beside it)")->type_name("FILE");
}

void declare(CLI::App& app, LuminaireArguments& arguments) {
    app.add_option("FILE", arguments.file, "Photometric file: IES LM-63 (.ies) or EULUMDAT (.ldt)")->required();
    app.add_option("-o,--output", arguments.outputs,
                   "Polar diagram (.svg) or luminous opening (.obj) to write; may be given again")
        ->type_name("FILE")
        ->expected(1)
        ->take_all();
    declare_json(app, arguments);
}

void declare(CLI::App& app, ViewFactorArguments& arguments) {
    declare_scene(app, arguments.scene);
    app.add_option("-o,--output", arguments.output,
                   "Matrix to write: .csv, .vf as View3D does, or sparse: .mtx (Matrix Market), .h5")
        ->type_name("FILE")
        ->required();
    const auto read_tolerance = [&arguments](const std::string& word) {
        arguments.tolerance = read_number("--tolerance", word);
        if (arguments.tolerance < 1e-12 || arguments.tolerance > 0.1)
            throw CLI::ValidationError("--tolerance", fmt::format("must be between 1e-12 and 0.1, not {}", word));
    };
    app.add_option_function<std::string>("--tolerance", read_tolerance,
                                         "Relative error of entries above 1e-6; default 1e-4")
        ->type_name("R");
    add_count(app, "--check", arguments.check, 0, "Entries drawn by lot that rays check; default 100");
    add_count(app, "--check-rays", arguments.check_rays, 64, "Rays an entry so checked; default 16384");
    add_count(app, "--seed", arguments.seed, 0, "Of the lot and of the rays; default 1");
    add_positive(app, "--time-limit", arguments.time_limit, "SECONDS", "End then, with nothing written");
    declare_json(app, arguments);
    declare_work(app, arguments, arguments.threads);
}

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

template <class Arguments>
Result<Parsed> parse_verb(CLI::App& app, const std::vector<std::string>& words) {
    Arguments arguments;
    declare(app, arguments);
    declare_common(app, arguments);
    app.allow_extras();
    try {
        app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
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
    Result<Parsed> (*parse)(CLI::App&, const std::vector<std::string>&);
};

const std::vector<Verb>& verbs() {
    static const std::vector<Verb> all{
        {"solve", "Computes the light in a scene.", "exitance solve room.obj -o room.h5", parse_verb<SolveArguments>},
        {"probe", "Evaluates irradiance and radiosity at points.",
         "exitance probe room.h5 --points desks.csv -o light.csv", parse_verb<ProbeArguments>},
        {"compare", "Tells how far a solution is from a reference.", "exitance compare room.h5 reference.csv",
         parse_verb<CompareArguments>},
        {"stats", "Tells what a solution took: counts, times, memory, error, energy balance.", "exitance stats room.h5",
         parse_verb<StatsArguments>},
        {"export", "Writes a solution for other programs.", "exitance export room.h5 -o room.glb",
         parse_verb<ExportArguments>},
        {"render", "Makes a picture of a solution.", "exitance render room.h5 -o room.png",
         parse_verb<RenderArguments>},
        {"bake", "Writes light maps: pictures of the light on every surface, and a model that shows them.",
         "exitance bake room.h5 -o lightmaps", parse_verb<BakeArguments>},
        {"report", "Writes a page with pictures, tables, measuring planes, energy balance and error.",
         "exitance report room.h5 -o room.html", parse_verb<ReportArguments>},
        {"check", "Tells what is wrong with a scene and what was repaired.", "exitance check room.obj",
         parse_verb<CheckArguments>},
        {"generate", "Writes a scene of a built-in family.", "exitance generate complex m=6 -o complex.obj",
         parse_verb<GenerateArguments>},
        {"luminaire", "Tells the facts of a photometric file; draws its polar diagram and its opening.",
         "exitance luminaire downlight.ies -o downlight.svg", parse_verb<LuminaireArguments>},
        {"viewfactors", "Writes the matrix of view factors between a scene's polygons.",
         "exitance viewfactors room.obj -o room.csv", parse_verb<ViewFactorArguments>},
    };
    return all;
}

std::string help() {
    std::string text =
        "Example:\n  exitance solve room.obj -o room.h5\n\n"
        "Light in rooms of diffuse surfaces.\n\n"
        "Usage: exitance VERB [options] INPUT...\n\nVerbs:\n";
    for (const Verb& verb : verbs()) text += fmt::format("  {:<12} {}\n", verb.name, verb.does);
    return text + "\nexitance VERB --help describes a verb; exitance --version names the libraries built in.\n";
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
    const auto verb = std::find_if(verbs().begin(), verbs().end(), [&](const Verb& v) { return v.name == first; });
    if (verb == verbs().end()) return unknown_verb(first);
    CLI::App app(fmt::format("Example:\n  {}\n\n{}", verb->example, verb->does), "exitance " + verb->name);
    return verb->parse(app, {arguments.begin() + 1, arguments.end()});
}

}  // namespace exitance
