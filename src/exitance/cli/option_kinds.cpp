#include "exitance/cli/option_kinds.hpp"

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

bool read_switch(const char* option, const std::string& word) {
    if (word != "on" && word != "off")
        throw CLI::ValidationError(option, fmt::format("must be on or off, not '{}'", word));
    return word == "on";
}

void declare_common(CLI::App& app, CommonArguments& arguments) {
    app.add_flag("-q,--quiet", arguments.quiet, "Nothing but errors on the error stream");
    app.add_flag("-v,--verbose", arguments.verbose, "Say more on the error stream");
}

void declare_limits(CLI::App& app, LimitArguments& limits, const std::string& at_limit) {
    add_positive(app, "--time-limit", limits.time_limit, "SECONDS", "Wall time of the whole run; then " + at_limit)
        ->group("Limits");
    app.add_option_function<std::string>(
           "--memory-limit", [&limits](const std::string& w) { limits.memory_limit = read_bytes("--memory-limit", w); },
           "Resident memory of the process, such as 4G; beyond it the same")
        ->type_name("SIZE")
        ->group("Limits");
}

void declare_json(CLI::App& app, CommonArguments& arguments) {
    app.add_flag("--json", arguments.json, "Facts as JSON on standard output");
}

void declare_work(CLI::App& app, CommonArguments& arguments, int& threads) {
    add_count(app, "--threads", threads, 1, "Threads to use; default all. The result does not depend on it");
    add_choice(app, "--progress", progress_names, arguments.progress,
               "auto: a bar on a terminal, a line every ten seconds otherwise");
}

void declare_unit(CLI::App& app, UnitArguments& unit) {
    CLI::Option* named =
        add_choice(app, "--unit", unit_names, unit.choice,
                   "Light in lx (of W/m^2 by 179 lm/W and weights 0.265, 0.670, 0.065 of R, G, B) or in W/m^2 (mean of "
                   "the bands); default: what the scene's light is in, which is never converted twice");
    add_positive(app, "--efficacy", unit.efficacy, "LM/W", "In place of 179 lm/W")->needs(named);
}

constexpr std::array<std::pair<double, std::string_view>, 5> length_unit_names{{
    {1e-3, "mm"},
    {1e-2, "cm"},
    {0.0254, "in"},
    {0.3048, "ft"},
    {1.0, "m"},
}};
constexpr std::array<std::pair<bool, std::string_view>, 2> up_names{{{true, "y"}, {false, "z"}}};

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
    add_choice(app, "--length-unit", length_unit_names, scene.load.metres_per_unit,
               "Length unit of .obj, .stl, .ply, .rad and .vs3 files; default m. Points, cameras and tables are in metres");
    add_choice(app, "--up", up_names, scene.load.y_is_up,
               "Upright axis of .obj, .stl, .ply and .vs3 files; default z. Points, cameras and tables have Z up");
    app.add_flag("--turn-bodies", scene.load.turn_bodies,
                 "Turn the faces of closed bodies that are inside out; check reports such bodies");
    app.add_flag("--run-commands", scene.load.run_commands,
                 "Run '!' lines of .rad files with the installed Radiance programs");
    app.add_flag("--older-gensky", scene.load.older_sky_programs,
                 "Evaluate '!gensky' and '!gendaylit' lines of .rad files as Radiance's programs did before November "
                 "2019; default: as today's do. For comparison with results of that time");
}

}  // namespace exitance
