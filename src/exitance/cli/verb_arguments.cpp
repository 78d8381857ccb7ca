#include <algorithm>
#include <sstream>

#include "exitance/cli/option_kinds.hpp"

namespace exitance {
namespace {

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

constexpr std::array<std::pair<Component, std::string_view>, 3> component_names{{
    {Component::total, "total"},
    {Component::direct, "direct"},
    {Component::indirect, "indirect"},
}};

constexpr std::array<std::pair<int, std::string_view>, 3> patch_counts{{{1, "146"}, {2, "577"}, {4, "2305"}}};

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

}  // namespace

void declare(CLI::App& app, ProbeArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution (.h5)")->required();
    app.add_option("--points", arguments.points, "CSV x,y,z,nx,ny,nz or .pts x y z dx dy dz; - for standard input")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", arguments.output, "CSV with E_* and B_*; default - for standard output")
        ->type_name("FILE");
    app.add_flag("--interpolant", arguments.interpolant, "Evaluate what export writes, not the full function");
    add_choice(app, "--component", component_names, arguments.component, "Default total");
    declare_unit(app, arguments.unit);
    add_count(app, "--reference", arguments.reference_paths, 1,
              "N unbiased paths a point in place of the solution, with their standard errors");
    add_count(app, "--seed", arguments.seed, 0, "Of the paths; default 1");
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, CompareArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution (.h5)")->required();
    app.add_option("REFERENCE", arguments.reference, "Probe CSV with E_*, or another solution")->required();
    app.add_flag("--interpolant", arguments.interpolant, "Measure what export writes, not the full function");
    app.add_option(
           "--map", arguments.map,
           "Picture (.png) of where the error lies: |E - E_ref| in false colours; of a CSV at its nearest point "
           "on the surface")
        ->type_name("FILE");
    app.add_option_function<std::string>(
           "--camera", [&arguments](const std::string& w) { read_camera(w, arguments.view); },
           "Of the map; as of render")
        ->type_name("CAMERA");
    app.add_option_function<std::string>(
           "--size", [&arguments](const std::string& w) { arguments.view.size = read_size(w); },
           "Pixels of the map; default 640x400")
        ->type_name("WxH");
    app.add_option_function<std::string>(
           "--scale", [&arguments](const std::string& w) { read_scale(w, arguments.view.scale); },
           "Range of the map's colours, W/m^2: 0,5")
        ->type_name("LO,HI[,log]");
    declare_json(app, arguments);
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, StatsArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution (.h5)")->required();
    declare_json(app, arguments);
}

void declare(CLI::App& app, MixArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution (.h5) of solve --light-groups")->required();
    app.add_option("CHANGES", arguments.dim, "GROUP=FACTOR: light of a group, over what it was in the scene")
        ->type_name("GROUP=FACTOR");
    app.add_option("--reflectance", arguments.reflectance, "MATERIAL=r,g,b: repaint it; may be given several times")
        ->type_name("MATERIAL=r,g,b");
    app.add_option("-o,--output", arguments.output, "The new solution (.h5)")->type_name("FILE")->required();
    declare_json(app, arguments);
    declare_work(app, arguments, arguments.threads);
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
    app.add_option("-o,--output", arguments.output,
                   "Picture to write: .png, linear radiance as .exr or .hdr; with --path a video by ffmpeg: .mp4, "
                   ".mkv, .webm, .gif")
        ->type_name("FILE")
        ->required();
    app.add_option_function<std::string>(
           "--camera", [&arguments](const std::string& w) { read_camera(w, arguments); },
           "auto (default): one that shows much; 'ex,ey,ez tx,ty,tz fov': eye and target in metres, horizontal "
           "angle in degrees (orthographic: width in metres); or a camera of the scene, by name or by number from 1")
        ->type_name("CAMERA");
    app.add_option("--path", arguments.path,
                   "Cameras to take numbered pictures from (P.0001.png, ...): CSV time,ex,ey,ez,tx,ty,tz,fov, as the "
                   "viewer records them; one exposure for all. A video has 25 pictures a second, between the rows, too")
        ->type_name("FILE");
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
    declare_unit(app, arguments.unit);
    app.add_flag("--mesh", arguments.mesh, "Draw the elements' edges; those of a discontinuity mesh coloured by order")
        ->group("PNG");
    app.add_flag("--shadow-classes", arguments.shadow_classes,
                 "Faces of a discontinuity mesh as lit, penumbra and umbra, with a legend")
        ->group("PNG");
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
    app.add_flag("--light-groups", arguments.light_groups,
                 "Maps of every light group by itself too, undimmed, on the same charts (solve --light-groups)");
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, ReportArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution (.h5)")->required();
    app.add_option("-o,--output", arguments.output,
                   "Page to write (.html), its numbers beside it (.json); may be left out with --tables")
        ->type_name("FILE");
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
    declare_unit(app, arguments.unit);
    declare_standards(app, arguments);
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, DaylightArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution (.h5) of the scene; its own light does not count")
        ->required();
    app.add_option("--epw", arguments.epw, "Weather of a year (EnergyPlus)")->type_name("FILE")->required();
    app.add_option("--points", arguments.points, "Sensors: CSV x,y,z,nx,ny,nz or .pts x y z dx dy dz")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", arguments.output, "Folder for illuminance.csv, metrics.csv, matrix.csv, summary.csv")
        ->type_name("FOLDER")
        ->required();
    add_choice(app, "--sky-patches", patch_counts, arguments.division, "Patches of the sky; default 146");
    app.add_option_function<std::string>(
           "--north", [&arguments](const std::string& w) { arguments.north = read_number("--north", w); },
           "Degrees clockwise from y to north, seen from above; default 0")
        ->type_name("DEGREES");
    app.add_option_function<std::string>(
           "--ground",
           [&arguments](const std::string& w) {
               arguments.ground = read_number("--ground", w);
               if (!(arguments.ground >= 0 && arguments.ground <= 1))
                   throw CLI::ValidationError("--ground", fmt::format("must be from 0 to 1, not {}", w));
           },
           "Reflectance of the ground beneath the scene; default 0.2")
        ->type_name("R");
    declare_standards(app, arguments);
    declare_json(app, arguments);
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
    app.add_option(
           "-o,--output", arguments.outputs,
           "Polar diagram (.svg), luminous opening (.obj) or standard table of UGR (.csv) to write; may be given again")
        ->type_name("FILE")
        ->expected(1)
        ->take_all();
    declare_json(app, arguments);
}

void declare(CLI::App& app, ExperimentArguments& arguments) {
    app.add_option("STUDY", arguments.study, "Name of a study, a file that describes one (.toml), or 'list'")
        ->required();
    app.add_option("-o,--output", arguments.output,
                   "Folder for index.html, results.csv, plots and pictures; runs that are finished there are not "
                   "repeated")
        ->type_name("FOLDER");
    app.add_option("--methods", arguments.methods, "Only rows with these labels, methods or bases, between commas")
        ->delimiter(',')
        ->type_name("NAMES");
    app.add_flag("--quick", arguments.quick, "Fewer and smaller runs: under two minutes");
    app.add_flag("--print", arguments.print, "Print the study's description, to begin one's own with");
    declare_work(app, arguments, arguments.threads);
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

void declare(CLI::App& app, ViewArguments& arguments) {
    declare_scene(app, arguments.scene);
    app.get_option("SCENE")->description("Solution (.h5), or a scene, which is then solved while one looks on");
    add_count(app, "--port", arguments.port, 0, "Port on 127.0.0.1; default: any that is free")
        ->check(CLI::Range(0, 65535));
    add_positive(app, "--error", arguments.error, "R", "Of a scene: the relative RMS error asked for; default 0.02")
        ->check(CLI::Range(1e-5, 1.0));
    add_choice(app, "--method", method_names, arguments.options.method, "Of a scene: as of solve");
    app.add_option("--save", arguments.save, "Of a scene: where the page's button saves its light; default viewed.h5")
        ->type_name("FILE");
    declare_work(app, arguments, arguments.options.threads);
}

}  // namespace exitance
