#include "exitance/cli/options/option_kinds.hpp"

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

/// Reads a camera: "auto", "ex,ey,ez tx,ty,tz fov" (metres and degrees; fov is optional), or the name or number of a
/// camera of the scene.
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
    if (n.size() == 7) arguments.fov = n[6];
    arguments.camera = Camera{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
}

/// Reads a measuring plane "ox,oy,oz ux,uy,uz vx,vy,vz spacing [margin]", metres; spacing may be "auto".
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

/// Reads a range or a kind of scale, such as "0,500", "log" or "1,1000,log".
void read_scale(std::string words, ScaleChoice& scale) {
    if (words == "log" || words.ends_with(",log")) {
        scale.by_ratio = true;
        words.erase(words.size() > 3 ? words.size() - 4 : 0);
        if (words.empty()) return;
    }
    const std::vector<double> n = read_numbers("--scale", words);
    if (n.size() != 2 || !(n[0] < n[1]))
        throw CLI::ValidationError("--scale", fmt::format("'{}' is not 'LO,HI' with LO below HI", words));
    if (scale.by_ratio && !(n[0] > 0)) throw CLI::ValidationError("--scale", "a logarithmic scale must begin above 0");
    scale.range = std::pair(n[0], n[1]);
}

/// Reads a number of colours, such as "10", or "smooth".
void read_bands(const std::string& word, ScaleChoice& scale) {
    scale.smooth = word == "smooth";
    if (scale.smooth) return;
    const double value = read_number("--bands", word);
    if (value != std::floor(value) || value < 1 || value > 100)
        throw CLI::ValidationError("--bands",
                                   fmt::format("must be 'smooth' or a whole number from 1 to 100, not {}", word));
    scale.bands = static_cast<std::size_t>(value);
}

/// Reads an exposure: "auto", stops above the automatic exposure, or a factor such as "0.02x".
void read_exposure(const std::string& word, RenderArguments& arguments) {
    if (word.ends_with('x')) {
        arguments.exposure_scale = read_number("--exposure", word.substr(0, word.size() - 1));
        if (!(*arguments.exposure_scale > 0))
            throw CLI::ValidationError("--exposure", fmt::format("the factor must be above 0, not {}", word));
        return;
    }
    arguments.exposure = word == "auto" ? 0 : read_number("--exposure", word);
    if (std::abs(arguments.exposure) > 60)
        throw CLI::ValidationError("--exposure", fmt::format("must be between -60 and 60 stops, not {}", word));
}

/// Declares the options for exposure, false colours and isolux lines.
void declare_display(CLI::App& app, RenderArguments& arguments) {
    app.add_option_function<std::string>(
           "--exposure", [&arguments](const std::string& w) { read_exposure(w, arguments); },
           "Stops above the automatic exposure (1 is twice as bright), or 0.02x: radiosity times 0.02, the same in "
           "every picture. Default auto")
        ->type_name("STOPS|FACTORx|auto")
        ->group("PNG");
    add_choice(app, "--tone-map", tone_names, arguments.tone_map, "Curve from radiance to pixel values. Default filmic")
        ->group("PNG");
    add_choice(app, "--false-colour", quantity_names, arguments.false_colour,
               "Show values as colours with a legend; luminance and illuminance weight the bands as the eye does")
        ->group("PNG");
    const auto of_scale = [&app, &arguments](const char* name, const char* help, const char* type, auto read) {
        app.add_option_function<std::string>(
               name, [&arguments, read](const std::string& w) { read(w, arguments.scale), arguments.has_scale = true; },
               help)
            ->type_name(type)
            ->group("PNG");
    };
    of_scale("--scale",
             "Range of colours and isolux lines, such as 0,500, or 1,1000,log for steps of equal ratio. Default: the "
             "range of the light in the picture",
             "LO,HI[,log]|log", read_scale);
    of_scale("--bands", "Number of colours of equal width, or smooth. Default: round steps", "N|smooth", read_bands);
    add_choice(app, "--palette", palette_names, arguments.scale.palette, "Colours of values. Default viridis")
        ->group("PNG")
        ->each([&arguments](const std::string&) { arguments.has_scale = true; });
    app.add_flag("--isolux", arguments.isolux, "Draw lines of equal illuminance with their values")->group("PNG");
}

}  // namespace

void declare(CLI::App& app, CompareArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution file (.h5), as solve writes it")->required();
    app.add_option("REFERENCE", arguments.reference,
                   "Light to compare with: a CSV of probe (columns E_*), or another solution")
        ->required();
    app.add_flag("--interpolant", arguments.interpolant,
                 "Measure the mesh that export writes, instead of the full solution with its exact direct light");
    app.add_option("--map", arguments.map,
                   "Picture (.png) of |E - E_ref| in false colours. If the reference is a CSV, each pixel shows the "
                   "nearest of its points on the same surface")
        ->type_name("FILE");
    app.add_option_function<std::string>(
           "--camera", [&arguments](const std::string& w) { read_camera(w, arguments.view); },
           "Camera of the map, as for render")
        ->type_name("CAMERA");
    app.add_option_function<std::string>(
           "--size", [&arguments](const std::string& w) { arguments.view.size = read_size(w); },
           "Pixels of the map. Default 640x400")
        ->type_name("WxH");
    app.add_option_function<std::string>(
           "--scale", [&arguments](const std::string& w) { read_scale(w, arguments.view.scale); },
           "Range of the map's colours, W/m^2, such as 0,5")
        ->type_name("LO,HI[,log]");
    declare_json(app, arguments);
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, RenderArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution file (.h5), as solve writes it")->required();
    app.add_option("-o,--output", arguments.output,
                   "Picture to write: .png, linear radiance as .exr or .hdr; with --path also a video by ffmpeg: .mp4, "
                   ".mkv, .webm, .gif")
        ->type_name("FILE")
        ->required();
    app.add_option_function<std::string>(
           "--camera", [&arguments](const std::string& w) { read_camera(w, arguments); },
           "Camera 'ex,ey,ez tx,ty,tz fov': eye and target in metres, horizontal angle in degrees (orthographic: width "
           "in metres); or a camera of the scene, by its name or its number from 1. Default auto: a view that shows "
           "much of the scene")
        ->type_name("CAMERA");
    app.add_option(
           "--path", arguments.path,
           "Cameras of numbered pictures (P.0001.png, ...): CSV time,ex,ey,ez,tx,ty,tz,fov, as the viewer records "
           "them; all pictures have one exposure. A video has 25 pictures per second and interpolates between rows")
        ->type_name("FILE");
    add_choice(
        app, "--projection", projection_names, arguments.projection,
        "Projection of the camera; fisheye is equidistant, panorama shows 360 x 180 degrees. Default perspective");
    app.add_option_function<std::string>(
           "--size", [&arguments](const std::string& w) { arguments.size = read_size(w); },
           "Pixels of the picture. Default 640x400")
        ->type_name("WxH");
    add_count(app, "--samples", arguments.samples, 1, "Rays per pixel, at most 1024. Default 16")
        ->check(CLI::Range(1, 1024));
    add_count(app, "--gather", arguments.gather, 4,
              "Compute indirect light at every sample by N rays (a power of two, at least 4) instead of reading it "
              "from the elements. "
              "Default: none. It is slow; use it to see which details are artefacts of the elements");
    app.add_flag("--interpolant", arguments.interpolant,
                 "Show the mesh that export writes, instead of the full solution with its exact direct light; isolux "
                 "lines are those of the mesh, too");
    app.add_option("--layer", arguments.layer,
                   "Show the direct light of one source from its layer (solve --layers on): the source's number from "
                   "1, its material or its group (all sources of that name), or others")
        ->type_name("NAME");
    declare_display(app, arguments);
    declare_unit(app, arguments.unit);
    app.add_flag("--mesh", arguments.mesh,
                 "Draw the edges of the method's own elements; the curves of a discontinuity mesh are coloured by the "
                 "order of the discontinuity. '--mesh export' draws the exported elements")
        ->check(CLI::IsMember({"true", "export"}).description(""))
        ->group("PNG");
    app.add_flag("--shadow-classes", arguments.shadow_classes,
                 "Show faces of a discontinuity mesh as lit, penumbra and umbra, with a legend")
        ->group("PNG");
    declare_work(app, arguments, arguments.threads);
}

void declare(CLI::App& app, ReportArguments& arguments) {
    app.add_option("SOLUTION", arguments.solution, "Solution file (.h5), as solve writes it");
    app.add_option("-o,--output", arguments.output,
                   "Page to write (.html; its numbers are also written as .json); optional with --tables")
        ->type_name("FILE");
    app.add_option_function<std::vector<std::string>>(
           "--grid",
           [&arguments](const std::vector<std::string>& all) {
               for (const std::string& words : all) arguments.planes.push_back(read_plane(words));
           },
           "Measuring plane 'ox,oy,oz ux,uy,uz vx,vy,vz spacing [margin]', metres: a corner, two edges, distance of "
           "points (auto: that of EN 12464-1), strip to leave out; it measures light that arrives from the side to "
           "which u x v points. May be "
           "given several times")
        ->type_name("PLANE")
        ->expected(1)
        ->take_all();
    app.add_option_function<std::vector<std::string>>(
           "--camera",
           [&arguments](const std::vector<std::string>& all) {
               for (const std::string& words : all) read_camera(words, arguments.views.emplace_back());
           },
           "Camera of a picture, as for render. May be given several times. Default: a view that shows much, and up to "
           "three cameras of the scene")
        ->type_name("CAMERA")
        ->expected(1)
        ->take_all();
    app.add_option_function<std::string>(
           "--size", [&arguments](const std::string& w) { arguments.size = read_size(w); },
           "Pixels of the pictures. Default 960x600")
        ->type_name("WxH");
    declare_unit(app, arguments.unit);
    declare_standards(app, arguments);
    declare_work(app, arguments, arguments.threads);
}

}  // namespace exitance
