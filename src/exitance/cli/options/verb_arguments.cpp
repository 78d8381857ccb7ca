#include "exitance/cli/options/option_kinds.hpp"

namespace exitance {
namespace {

constexpr std::array<std::pair<ReferenceFormat, std::string_view>, 5> reference_format_names{{
    {ReferenceFormat::man, "man"},
    {ReferenceFormat::markdown, "markdown"},
    {ReferenceFormat::bash, "bash"},
    {ReferenceFormat::zsh, "zsh"},
    {ReferenceFormat::list, "list"},
}};

}  // namespace

void declare(CLI::App& app, ProbeArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution file (.h5), as solve writes it")->required();
    app.add_option(
           "--points", arguments.points,
           "Points in metres, each with the direction that it faces: CSV x,y,z,nx,ny,nz or .pts x y z dx dy dz; - for "
           "standard input")
        ->type_name("FILE")
        ->required();
    app.add_option(
           "-o,--output", arguments.output,
           "CSV to write: irradiance E_* and radiosity B_* of every point, and standard errors se_* of E. Default "
           "-: standard output")
        ->type_name("FILE");
    app.add_flag("--interpolant", arguments.interpolant,
                 "Evaluate the mesh that export writes, instead of the full solution with its exact direct light");
    app.add_flag("--exact", arguments.exact,
                 "Evaluate direct light by closed forms even where rays are cheaper, so that it has no noise. Slow in "
                 "scenes of thousands of faces under a sky");
    add_choice(app, "--component", light_component_names, arguments.component,
               "Part of the light: all of it, light straight from emitters, sky and sun, or light that was reflected. "
               "Default total");
    declare_unit(app, arguments.unit);
    CLI::Option* const reference =
        add_count(app, "--reference", arguments.reference_paths, 1,
                  "Trace N unbiased light paths per point instead of evaluating the solution, as a reference");
    add_count(app, "--seed", arguments.seed, 0, "Seed of the paths. Default 1")->needs(reference);
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, StatsArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution file (.h5), as solve writes it")->required();
    declare_threads(app, arguments.threads);
    declare_json(app, arguments);
}

void declare(CLI::App& app, MixArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution file (.h5), as solve --light-groups writes it")
        ->required();
    app.add_option("CHANGES", arguments.dim,
                   "GROUP=FACTOR: light of a group, relative to that in the scene; 0 turns it off")
        ->type_name("GROUP=FACTOR");
    app.add_option("--reflectance", arguments.reflectance, "New reflectance of a material. May be given several times")
        ->type_name("MATERIAL=r,g,b");
    app.add_option("-o,--output", arguments.output, "Solution to write (.h5)")->type_name("FILE")->required();
    declare_json(app, arguments);
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, ExportArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution file (.h5), as solve writes it")->required();
    app.add_option(
           "-o,--output", arguments.output,
           "File to write; its ending is the format: .glb (3D programs and engines), .vtu, .hdf or .vtkhdf (ParaView), "
           ".obj, .csv (a table); .curves.csv holds the curves of a discontinuity mesh")
        ->type_name("FILE")
        ->required();
    app.add_option("--links", arguments.links,
                   "Export the links of a solution made with --keep-links (.csv, .obj or .glb): ELEMENT is the number "
                   "of the element that receives the links, or a point x,y,z: then the elements of all levels there")
        ->type_name("ELEMENT");
    declare_threads(app, arguments.threads);
}

namespace {

/// Reads a grid of light probes, "ox,oy,oz dx,dy,dz nx,ny,nz".
ProbeGrid read_probe_grid(const std::string& words) {
    constexpr double max_probes = 1e8;  ///< derived from 256 bytes per probe: 26 GB
    const std::vector<double> n = read_numbers("--grid", words);
    bool is_grid = n.size() == 9;
    double probes = 1;
    for (std::size_t k = 6; k < 9 && is_grid; ++k) is_grid = n[k] >= 1 && n[k] == std::floor(n[k]), probes *= n[k];
    if (!is_grid || probes > max_probes)
        throw CLI::ValidationError(
            "--grid", fmt::format("'{}' is not 'ox,oy,oz dx,dy,dz nx,ny,nz' with at most 1e8 points", words));
    return {{n[0], n[1], n[2]},
            {n[3], n[4], n[5]},
            {static_cast<int>(n[6]), static_cast<int>(n[7]), static_cast<int>(n[8])}};
}

}  // namespace

void declare(CLI::App& app, LightProbeArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution file (.h5), as solve writes it")->required();
    CLI::Option* grid = app.add_option_function<std::string>(
                               "--grid", [&arguments](const std::string& w) { arguments.grid = read_probe_grid(w); },
                               "Grid of probes along the axes: the first point, the distances and the numbers of "
                               "points; metres")
                            ->type_name("\"ox,oy,oz dx,dy,dz nx,ny,nz\"");
    app.add_option("--points", arguments.points, "Points of the probes, metres: CSV with columns x,y,z, or .pts x y z")
        ->type_name("FILE")
        ->excludes(grid);
    app.add_option("-o,--output", arguments.output,
                   "File to write: .json, or .h5. Every probe has nine coefficients of radiance, their standard "
                   "errors, and the share of directions in which backs of surfaces are seen")
        ->type_name("FILE")
        ->required();
    app.add_option("--rays", arguments.rays,
                   "Rays per probe for reflected light, a power of two. Default 1024. Four times as many have about a "
                   "third of the noise")
        ->type_name("N")
        ->check([](const std::string& word) {
            const double n = read_number("--rays", word);
            constexpr double least = 64, most = 1 << 20;
            const bool is_power = n >= least && n <= most && n == std::exp2(std::round(std::log2(n)));
            return is_power ? std::string() : "must be a power of two from 64 to 1048576, not " + word;
        });
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, BakeArguments& arguments) {
    LightMapFormat& format = arguments.format;
    app.add_option("SOLUTION", arguments.solution, "Solution file (.h5), as solve writes it")->required();
    app.add_option("-o,--output", arguments.output,
                   "Folder for lightmaps.json, lightmap_0.exr and .png, ..., scene.glb")
        ->type_name("FOLDER")
        ->required();
    CLI::Option* density =
        add_positive(app, "--density", arguments.density, "T",
                     "Texels per metre. Default 64 (more in small scenes), at most a million texels in total");
    CLI::Option* uv =
        app.add_option("--uv", arguments.uv,
                       "Bake into texture coordinates of the scene's file, which must still exist: TEXCOORD_0 to "
                       "TEXCOORD_3 (glTF), vt (OBJ), or own: the file's set for light maps. Objects share one map "
                       "unless their charts (connected parts of the map) overlap. unwrap: make new coordinates for "
                       "all faces in one map, and write the model with them. Default: a chart for each flat part")
            ->type_name("SET");
    app.add_option_function<std::string>(
           "--size", [&arguments](const std::string& w) { arguments.size = read_size(w); },
           "Texels of each map with --uv. Default: the power of two that gives --density on average, at most 4096 if "
           "--density is not given")
        ->type_name("WxH")
        ->needs(uv)
        ->excludes(density);
    app.add_option("--charts", arguments.charts,
                   "Draw the charts of --uv into a PNG file: overlaps in red, mirrored ones in blue")
        ->type_name("FILE")
        ->needs(uv);
    app.add_flag(
        "--faceted", arguments.faceted,
        "Bake the light of the flat faces. Default: where a mesh approximates a curved surface, light follows the "
        "normals of the scene's file (glTF NORMAL, OBJ vn)");
    add_count(app, "--padding", arguments.padding, 1,
              "Texels around every chart. Default 4. 2^m texels keep charts apart down to mip level m")
        ->check(CLI::Range(1, 256));
    add_choice(app, "--quantity", light_map_quantity_names, format.quantity,
               "Quantity in the maps, W/m^2. Default irradiance");
    add_choice(app, "--component", light_component_names, format.component,
               "Part of the light: all of it, light straight from emitters, sky and sun, or light that was reflected. "
               "Default total");
    add_choice(app, "--directional", direction_form_names, format.directions,
               "Directions of the light, for normal maps. sh: spherical harmonics of degrees 0 and 1 (EXR). dominant: "
               "one direction and its share (EXR, PNG). A bake takes about five times as long. Default none");
    app.add_flag("--hdr", format.with_hdr,
                 "Also write Radiance pictures (.hdr, RGBE), precise to 0.4% of the brightest band");
    app.add_flag_callback(
        "--half", [&format] { format.precision = Precision::half; },
        "Write EXR files of 16-bit instead of 32-bit numbers");
    CLI::Option* unlit = app.add_flag_callback(
        "--unlit", [&format] { format.material = LightMapMaterial::unlit; },
        "Write tone-mapped light as base colour of the .glb. Default: linear light as emission");
    app.add_flag_callback(
           "--moz-lightmap", [&format] { format.material = LightMapMaterial::moz_lightmap; },
           "Write base colours into the .glb, and the light in its extension MOZ_lightmap")
        ->excludes(unlit);
    app.add_flag(
        "--light-groups", arguments.light_groups,
        "Also write maps of each light group, undimmed, on the same charts. Needs a solution of solve --light-groups");
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, CheckArguments& arguments) {
    declare_scene(app, arguments.scene);
    app.add_option("--picture", arguments.picture, "Picture of the scene with the findings marked (.png)")
        ->type_name("FILE");
    declare_threads(app, arguments.threads);
    declare_json(app, arguments);
}

void declare(CLI::App& app, GenerateArguments& arguments) {
    app.add_option("FAMILY", arguments.family, "Family of scenes; 'list' prints all families with their parameters")
        ->required();
    app.add_option("PARAMETERS", arguments.parameters, "Parameters of the family, as name=value");
    app.add_option("-o,--output", arguments.output, "Scene to write (.obj; its .mtl is written into the same folder)")
        ->type_name("FILE");
}

void declare(CLI::App& app, ReferenceArguments& arguments) {
    add_choice(app, "--format", reference_format_names, arguments.format,
               "Manual page, completion for a shell, page of all options, or list of them")
        ->required();
}

void declare(CLI::App& app, LuminaireArguments& arguments) {
    app.add_option("FILE", arguments.file, "Photometric file: IES LM-63 (.ies) or EULUMDAT (.ldt)")->required();
    app.add_option("-o,--output", arguments.outputs,
                   "Polar diagram (.svg), luminous opening (.obj) or standard table of UGR (.csv) to write; may be "
                   "given several times")
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
    app.add_option("--methods", arguments.methods,
                   "Run only rows with these labels, methods or bases, separated by commas")
        ->delimiter(',')
        ->type_name("NAMES");
    app.add_flag("--quick", arguments.quick, "Run fewer and smaller solves, under two minutes in total");
    app.add_flag("--print", arguments.print, "Print the description of the study, as a template for new studies");
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, ViewArguments& arguments) {
    declare_scene(app, arguments.scene);
    app.get_option("SCENE")->description(
        "Solution file (.h5), two solutions of one room to compare, or a scene, whose light is shown while it is "
        "solved");
    app.add_option("-o,--output", arguments.output,
                   "Page to write (.html) instead of serving one; it contains the solution and works without exitance")
        ->type_name("FILE");
    app.add_option("--views", arguments.views,
                   "Saved views for the page of -o (.json), as the viewer saves them; it opens with the first")
        ->type_name("FILE");
    add_count(app, "--port", arguments.port, 0, "Port on 127.0.0.1. Default: any free port")
        ->check(CLI::Range(0, 65535));
    add_positive(app, "--error", arguments.error, "R",
                 "Requested relative RMS error if a scene is solved. Default 0.02 (2%)")
        ->check(CLI::Range(1e-5, 1.0));
    add_choice(app, "--method", method_names, arguments.request.options.method,
               "Method for a scene, as for solve. Default auto");
    const std::shared_ptr<std::vector<GivenOption>> given = declare_rows(app, view_light_options);
    app.callback([given, &arguments] {
        Result<SolveRequest> light = make_request(*given);
        if (!light) throw CLI::ValidationError(light.error().where, light.error().message);
        light->options = arguments.request.options;
        arguments.request = std::move(*light);
    });
    declare_unit(app, arguments.unit);
    app.add_option("--save", arguments.save,
                   "File into which the page's button saves the light of a scene. Default viewed.h5")
        ->type_name("FILE");
    declare_work(app, arguments, arguments.request.options.threads);
}

}  // namespace exitance
