#include <cmath>
#include <cstdio>

#include "exitance/cli/options/option_kinds.hpp"

namespace exitance {
namespace {

constexpr std::array<std::pair<int, std::string_view>, 3> patch_counts{{{1, "146"}, {2, "577"}, {4, "2305"}}};

constexpr std::array<std::pair<HoursFormat, std::string_view>, 4> hours_formats{{{HoursFormat::hdf5, "h5"},
                                                                                 {HoursFormat::hdf5_float, "h5-float"},
                                                                                 {HoursFormat::npy, "npy"},
                                                                                 {HoursFormat::csv, "csv"}}};

constexpr std::array<std::pair<std::optional<MatrixFormat>, std::string_view>, 4> matrix_formats{
    {{std::nullopt, "csv"},
     {MatrixFormat::ascii, "ascii"},
     {MatrixFormat::float32, "float"},
     {MatrixFormat::float64, "double"}}};

/// Reads a part of the sensors, such as "3/8".
DaylightPart read_part(const std::string& word) {
    constexpr unsigned max_parts = 99'999;  // five digits in the names of folders
    DaylightPart out;
    unsigned part = 0, parts = 0;
    char rest = 0;
    if (std::sscanf(word.c_str(), "%5u/%5u%c", &part, &parts, &rest) != 2 || part < 1 || part > parts ||
        parts > max_parts)
        throw CLI::ValidationError("--part", fmt::format("'{}' is not a part such as 3/8", word));
    out.part = part, out.parts = parts;
    return out;
}

/// Declares an option whose value is a number from 0 to 1. `unit`: its type in the help.
template <class Target>
void add_share(CLI::App& app, const std::string& name, Target& target, const std::string& unit,
               const std::string& help) {
    const auto read = [name, &target](const std::string& word) {
        const double value = read_number(name, word);
        if (!(value >= 0 && value <= 1))
            throw CLI::ValidationError(name, fmt::format("must be from 0 to 1, not {}", word));
        target = value;
    };
    app.add_option_function<std::string>(name, read, help)->type_name(unit);
}

/// Options of occupancy, thresholds and electric light.
void declare_criteria(CLI::App& app, DaylightArguments& arguments) {
    DaylightCriteria& criteria = arguments.criteria;
    app.add_option("--occupied", arguments.occupied,
                   "Occupied hours: from and to every day, such as 8-18, or a file with a number per hour of the "
                   "weather, 0 for an empty room. Default 8-18")
        ->type_name("HOURS");
    add_positive(
        app, "--target", criteria.target, "LX",
        "Illuminance that daylight should reach, in daylight autonomy (DA, continuous DA, spatial sDA) and for "
        "dimmed electric light. Default 300");
    app.add_option_function<std::string>(
           "--useful",
           [&criteria](const std::string& w) {
               auto& [low, middle, high] = criteria.useful;
               char rest = 0;
               if (std::sscanf(w.c_str(), "%lf,%lf,%lf%c", &low, &middle, &high, &rest) != 3 || !(0 < low) ||
                   !(low < middle) || !(middle < high) || !std::isfinite(high))
                   throw CLI::ValidationError(
                       "--useful", fmt::format("'{}' is not three ascending numbers such as 100,300,3000", w));
           },
           "Limits between the ranges of useful daylight illuminance (UDI), ascending. Default 100,300,3000")
        ->type_name("LX,LX,LX");
    add_share(app, "--dimmed-power", criteria.dimmed_power, "SHARE",
              "Power of electric light that daylight dims completely, as a share of its full power. Default 0");
}

/// Options of the files to write, and of parts.
void declare_files(CLI::App& app, DaylightArguments& arguments) {
    add_choice(app, "--matrix", matrix_formats, arguments.matrix,
               "Format of the daylight coefficients: matrix.csv, or matrix.mtx of Radiance. Default csv");
    CLI::Option* coefficients =
        app.add_option("--coefficients", arguments.coefficients,
                       "Evaluate these daylight coefficients (a matrix of Radiance, sensors x patches, such as "
                       "rfluxmtx writes) instead of computing them; their error is not known")
            ->type_name("FILE");
    add_choice(app, "--hours", hours_formats, arguments.hours,
               "Format of the illuminances of all hours: hours.h5 with 16 or 32 bits per number, illuminance.npy and "
               "sun.npy, or illuminance.csv and sun.csv. Default h5");
    CLI::Option* part = app.add_option_function<std::string>(
                               "--part", [&arguments](const std::string& w) { arguments.part = read_part(w); },
                               "Evaluate part K of N of the sensors only, from 1, for --merge. Use it for jobs of a "
                               "cluster, which share the light in FOLDER/light.h5")
                            ->type_name("K/N")
                            ->excludes(coefficients);
    app.add_flag("--merge", arguments.merge,
                 "Write the results of all parts in FOLDER; takes the options of the parts except --part")
        ->excludes(part)
        ->excludes(coefficients);
}

/// Options of states of panes. Needs the options that cannot be combined with them.
void declare_states(CLI::App& app, DaylightArguments& arguments) {
    CLI::Option* states =
        app.add_option("--states", arguments.states,
                       "Groups of panes with states, such as open and blinds down, and the rule that chooses the "
                       "state of every hour (TOML); the states are written to states.csv. Use it for spatial daylight "
                       "autonomy (sDA) by LM-83, which closes blinds against the sun")
            ->type_name("FILE");
    for (const char* other : {"--coefficients", "--part", "--merge", "--views"})
        states->excludes(app.get_option(other));
}

/// Options of EN 17037.
void declare_en_17037(CLI::App& app, DaylightArguments& arguments) {
    app.add_option(
           "--eyes", arguments.eyes,
           "Points at which the view out is assessed by EN 17037, in a file as for --points, whose directions are "
           "ignored. The results are in view.csv")
        ->type_name("FILE");
    CLI::Option* views =
        app.add_option(
               "--views", arguments.views,
               "Views at which daylight glare (DGP) is evaluated in every hour: CSV x,y,z,dx,dy,dz, or x,y,z for "
               "eight directions each, or a Honeybee model with views; written to glare.csv and glare_hours.npy")
            ->type_name("FILE");
    for (const char* other : {"--coefficients", "--part", "--merge"}) views->excludes(app.get_option(other));
    app.add_option_function<std::string>(
           "--sun-day",
           [&arguments](const std::string& w) {
               constexpr std::array<int, 12> days{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
               int month = 0, day = 0;
               char rest = 0;
               if (std::sscanf(w.c_str(), "%2d-%2d%c", &month, &day, &rest) != 2 || month < 1 || month > 12 ||
                   day < 1 || day > days[static_cast<std::size_t>(month - 1)])
                   throw CLI::ValidationError("--sun-day", fmt::format("'{}' is not a day such as 03-21", w));
               arguments.sun_day.month = month, arguments.sun_day.day = day;
           },
           "Cloudless day whose hours of sunlight are counted, MM-DD: the time for which the sun is visible from a "
           "sensor's position, in any direction. Default 03-21")
        ->type_name("DAY");
    app.add_option_function<std::string>(
           "--sun-altitude",
           [&arguments](const std::string& w) {
               arguments.sun_day.min_altitude = read_number("--sun-altitude", w);
               if (!(arguments.sun_day.min_altitude >= 0 && arguments.sun_day.min_altitude < 90))
                   throw CLI::ValidationError("--sun-altitude", fmt::format("must be from 0 to 90, not {}", w));
           },
           "Lowest altitude of the sun that counts for these hours, degrees. Default 0")
        ->type_name("DEGREES");
}

}  // namespace

void declare(CLI::App& app, DaylightArguments& arguments) {
    declare_scene(app, arguments.scene);
    app.get_option("SCENE")->description("Scene, or a solution (.h5) of it, whose own light is ignored");
    app.add_option("--epw", arguments.epw, "Weather of a year: .epw (EnergyPlus) or .wea (Radiance)")
        ->type_name("FILE")
        ->required();
    app.add_option(
           "--points", arguments.points,
           "Sensors in metres, each with the direction that it faces: CSV x,y,z,nx,ny,nz, .pts x y z dx dy dz, or a "
           "Honeybee model with sensor grids. Default: the grids of the scene, if it is a Honeybee model")
        ->type_name("FILE");
    app.add_option("-o,--output", arguments.output, "Folder for hours.h5, metrics.csv, matrix.csv, summary.csv")
        ->type_name("FOLDER")
        ->required();
    add_positive(app, "--error", arguments.error, "R",
                 "Requested relative RMS error of the daylight factors and the annual sums of illuminance (lx h) of "
                 "every grid of sensors. Default 0.02")
        ->check(CLI::Range(1e-4, 1.0));
    add_choice(
        app, "--sky-patches", patch_counts, arguments.division,
        "Number of patches that represent sky and ground: Tregenza's 145 and the ground, or finer ones. Default 146");
    app.add_option_function<std::string>(
           "--north", [&arguments](const std::string& w) { arguments.north = read_number("--north", w); },
           "Direction of north, degrees clockwise from the y axis as seen from above. Default 0")
        ->type_name("DEGREES");
    add_share(app, "--ground", arguments.ground, "R", "Reflectance of the ground beneath the scene. Default 0.2");
    declare_files(app, arguments);
    declare_criteria(app, arguments);
    declare_en_17037(app, arguments);
    declare_states(app, arguments);
    declare_json(app, arguments);
    declare_work(app, arguments, arguments.threads);
}

}  // namespace exitance
