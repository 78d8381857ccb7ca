#include "exitance/cli/options/option_kinds.hpp"

#include <algorithm>
#include <sstream>

namespace exitance {
namespace {

constexpr std::array<std::pair<ProgressStyle, std::string_view>, 5> progress_names{{
    {ProgressStyle::automatic, "auto"},
    {ProgressStyle::bar, "bar"},
    {ProgressStyle::plain, "plain"},
    {ProgressStyle::json, "json"},
    {ProgressStyle::none, "none"},
}};

constexpr std::array<std::pair<UnitChoice, std::string_view>, 3> unit_names{
    {{UnitChoice::lux, "lux"}, {UnitChoice::watt, "w"}, {UnitChoice::watt, "watt"}}};

}  // namespace

double read_number(const std::string& option, const std::string& word) {
    double value = 0;
    if (!CLI::detail::lexical_cast(word, value) || !std::isfinite(value))
        throw CLI::ValidationError(option, fmt::format("'{}' is not a number", word));
    return value;
}

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

std::vector<double> read_numbers(const std::string& option, std::string words) {
    std::replace(words.begin(), words.end(), ',', ' ');
    std::vector<double> numbers;
    std::istringstream in(words);
    for (std::string word; in >> word;) numbers.push_back(read_number(option, word));
    return numbers;
}

void declare_common(CLI::App& app, CommonArguments& arguments) {
    app.add_flag("-q,--quiet", arguments.quiet, "Write only errors to the error stream")->group("Run");
    app.add_flag("-v,--verbose", arguments.verbose, "Write more details to the error stream")->group("Run");
}

void declare_limits(CLI::App& app, LimitArguments& limits, const std::string& at_limit) {
    add_positive(app, "--time-limit", limits.time_limit, "SECONDS",
                 "Limit on the wall time of the whole run. At the limit, " + at_limit)
        ->group("Limits");
    if (app.get_option_no_throw("--memory-limit")) return;
    app.add_option_function<std::string>(
           "--memory-limit", [&limits](const std::string& w) { limits.memory_limit = read_bytes("--memory-limit", w); },
           "Limit on the resident memory of the process, such as 4G. If it is exceeded, the run ends as at the time "
           "limit")
        ->type_name("SIZE")
        ->group("Limits");
}

void declare_json(CLI::App& app, CommonArguments& arguments) {
    app.add_flag("--json", arguments.json, "Print facts as JSON to standard output")->group("Run");
}

void declare_threads(CLI::App& app, int& threads) {
    add_count(app, "--threads", threads, 1, "Number of threads; the result does not depend on it. Default all cores")
        ->group("Run");
}

void declare_work(CLI::App& app, CommonArguments& arguments, int& threads) {
    declare_threads(app, threads);
    declare_progress(app, arguments);
}

void declare_progress(CLI::App& app, CommonArguments& arguments) {
    add_choice(app, "--progress", progress_names, arguments.progress,
               "How progress is shown. Default auto: a bar on a terminal, else a line every ten seconds")
        ->group("Run");
}

void declare_unit(CLI::App& app, UnitArguments& unit) {
    CLI::Option* named = add_choice(app, "--unit", unit_names, unit.choice,
                                    "Unit of the light: lx (from W/m^2 by 179 lm/W and weights 0.265, 0.670, 0.065 of "
                                    "R, G, B) or W/m^2 (mean of the bands). Default: the unit of the scene's light");
    add_positive(app, "--efficacy", unit.efficacy, "LM/W", "Luminous efficacy, instead of 179 lm/W")->needs(named);
}

constexpr std::array<std::pair<double, std::string_view>, 5> length_unit_names{{
    {1e-3, "mm"},
    {1e-2, "cm"},
    {0.0254, "in"},
    {0.3048, "ft"},
    {1.0, "m"},
}};
constexpr std::array<std::pair<bool, std::string_view>, 2> up_names{{{true, "y"}, {false, "z"}}};

constexpr int max_texture_parts = 10'000'000;  ///< Largest number of parts; a solve of so many takes about 80 GB.

void declare_scene(CLI::App& app, SceneArguments& scene) {
    app.add_option("SCENE", scene.files,
                   "Scene (.obj with its .mtl, .gltf, .glb, .rad, .vs3, .stl, .ply, .hbjson, .json); several files "
                   "make one scene")
        ->required();
    app.add_flag_callback(
           "--strict", [&scene] { scene.load.faults = Faults::refuse; },
           "Report faults of the scene as errors. Default: they are repaired where possible")
        ->group("Scene");
    app.add_option(
           "--luminaires", scene.load.luminaires,
           "Table of luminaires in the scene (.csv) with the columns file,x,y,z and optionally aim_x,aim_y,aim_z,"
           "rotation,dimming,lumens,maintenance_factor,group")
        ->type_name("FILE")
        ->group("Scene");
    add_choice(
        app, "--length-unit", length_unit_names, scene.load.metres_per_unit,
        "Length unit of .obj, .stl, .ply, .rad and .vs3 files. Default m. Points, cameras and tables are in metres")
        ->group("Scene");
    add_choice(app, "--up", up_names, scene.load.y_is_up,
               "Upright axis of .obj, .stl, .ply and .vs3 files. Default z. Points, cameras and tables have Z up")
        ->group("Scene");
    app.add_option("--lod", scene.load.lod,
                   "Level of detail to read from CityJSON files, such as 1.3. Objects without it are left out, with a "
                   "warning. Default: the highest level of each object")
        ->check([](const std::string& word) { return read_number("--lod", word) >= 0 ? "" : "must not be negative"; })
        ->type_name("LEVEL")
        ->group("Scene details");
    app.add_flag("--turn-bodies", scene.load.turn_bodies,
                 "Turn the faces of closed bodies that are inside out. Use it if check reports such bodies")
        ->group("Scene");
    app.add_option("--texture-parts", scene.load.texture_parts,
                   "Limit on the parts into which textured faces are cut where their colour varies. Each part reflects "
                   "and emits the mean of its part of the texture; 0: faces are not cut. Default 500 plus a quarter of "
                   "the number of faces")
        ->check(CLI::Range(0, max_texture_parts))
        ->type_name("N")
        ->group("Scene");
    app.add_flag("--run-commands", scene.load.run_commands,
                 "Run '!' lines of .rad files with the installed Radiance programs")
        ->group("Scene");
    app.add_flag("--older-gensky", scene.load.older_sky_programs,
                 "Evaluate '!gensky' and '!gendaylit' lines of .rad files as Radiance's programs did before November "
                 "2019. Use it to compare with results of that time")
        ->group("Scene details");
}

PictureSize read_size(const std::string& words) {
    std::string blank = words;
    std::replace(blank.begin(), blank.end(), 'x', ' ');
    const std::vector<double> n = read_numbers("--size", blank);
    const bool whole = n.size() == 2 && n[0] == std::floor(n[0]) && n[1] == std::floor(n[1]);
    if (!whole || std::min(n[0], n[1]) < 1 || std::max(n[0], n[1]) > 16384)
        throw CLI::ValidationError("--size", fmt::format("'{}' is not a size such as 640x400, at most 16384", words));
    return {static_cast<int>(n[0]), static_cast<int>(n[1])};
}

}  // namespace exitance
