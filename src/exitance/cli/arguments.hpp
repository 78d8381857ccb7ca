#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/cli/exit_code.hpp"
#include "exitance/cli/run_limits.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/pictures/false_colour.hpp"
#include "exitance/io/pictures/tone_map.hpp"
#include "exitance/io/report/report.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/measure/working_plane.hpp"
#include "exitance/methods/options/solve_request.hpp"
#include "exitance/scene/photometric_units.hpp"
#include "exitance/solve/solve_options.hpp"
#include "exitance/what_if/daylight/daylight_provision.hpp"

namespace exitance {

enum class ProgressStyle { automatic, bar, plain, json, none };

/// What every verb understands.
struct CommonArguments {
    LimitArguments limits;
    bool json = false;   ///< Facts as JSON on stdout.
    bool quiet = false;  ///< Nothing but errors on stderr.
    bool verbose = false;
    ProgressStyle progress = ProgressStyle::automatic;
};

/// Of verbs that read a scene.
struct SceneArguments {
    std::vector<std::string> files;  ///< That make it, in their order.
    LoadOptions load;
};

struct SolveArguments : CommonArguments, SolveRequest {
    SceneArguments scene;
    std::string output;
};

/// In what unit a verb tells light.
struct UnitArguments {
    UnitChoice choice = UnitChoice::scene;
    std::optional<double> efficacy;  ///< lm/W of light in watts; none: Radiance's 179.
};

struct ProbeArguments : CommonArguments {
    std::string solution, points;
    std::string output = "-";
    bool interpolant = false;
    Component component = Component::total;
    UnitArguments unit;
    std::size_t reference_paths = 0;  ///< 0: evaluate the solution; N: N unbiased paths a point instead.
    std::uint64_t seed = 1;
    int threads = 0;
};

struct StatsArguments : CommonArguments {
    std::string solution;
};

struct MixArguments : CommonArguments {
    std::string solution, output;
    std::vector<std::string> dim;          ///< GROUP=FACTOR
    std::vector<std::string> reflectance;  ///< MATERIAL=r,g,b
    int threads = 0;
};

struct ExportArguments : CommonArguments {
    std::string solution, output;
    std::string links;  ///< An element's number, or a place x,y,z; empty: export the light.
};

struct RenderArguments : CommonArguments {
    std::string solution, output;
    std::optional<Camera> camera;  ///< None: the scene's of the name below, or else one that shows the scene well.
    std::string camera_name;       ///< Of a camera that came with the scene, or its number, counted from 1.
    std::optional<double> fov;     ///< Where a camera was given with one.
    Projection projection = Projection::perspective;
    PictureSize size;
    double exposure = 0;                   ///< Stops above what is chosen automatically.
    std::optional<double> exposure_scale;  ///< Or what radiosity is multiplied by.
    ToneCurve tone_map = ToneCurve::filmic;
    std::optional<Quantity> false_colour;
    ScaleChoice scale;       ///< Of false colours and of isolux lines.
    bool has_scale = false;  ///< Was any of it asked for?
    UnitArguments unit;
    bool isolux = false;
    std::size_t samples = 16;  ///< Rays a pixel.
    std::size_t gather = 0;    ///< Rays of a final gather at each of them.
    /// Elements whose edges are drawn: "export": those that export writes; "true": the method's own; empty: none.
    std::string mesh;
    bool shadow_classes = false;
    std::string path;  ///< A camera a row, for numbered pictures; empty: one picture.
    int threads = 0;
};

struct CompareArguments : CommonArguments {
    std::string solution, reference;
    bool interpolant = false;
    std::string map;       ///< Picture to write of where the error lies; empty: none.
    RenderArguments view;  ///< Of which camera, size and scale count.
    int threads = 0;
};

struct BakeArguments : CommonArguments {
    std::string solution, output;
    double density = 0;       ///< Texels per metre; 0: what suits the scene.
    std::size_t padding = 4;  ///< Texels.
    LightMapFormat format;
    bool light_groups = false;  ///< Maps of every light group by itself, too.
    int threads = 0;
};

struct ReportArguments : CommonArguments {
    std::string solution, output;
    std::vector<RenderArguments> views;  ///< Of which the camera counts; empty: automatic ones.
    std::vector<MeasuringPlane> planes;
    std::vector<PlaneRequest> working_planes;
    double maintenance = 1;
    std::vector<std::string> observers;  ///< In words.
    std::string tables;                  ///< Folder for them; empty: none.
    PictureSize size{960, 600};
    UnitArguments unit;
    int threads = 0;
};

struct DaylightArguments : CommonArguments {
    std::string solution, epw, points, output;
    int division = 1;  ///< Of Tregenza's patches, in either direction.
    double north = 0, ground = 0.2;
    SunDay sun_day;    ///< On which hours of sunlight are counted.
    std::string eyes;  ///< Points for views out; empty: none.
    int threads = 0;
};

struct CheckArguments : CommonArguments {
    SceneArguments scene;
    std::string picture;
};

struct GenerateArguments : CommonArguments {
    std::string family, output;
    std::vector<std::string> parameters;  ///< "name=value"
};

struct LuminaireArguments : CommonArguments {
    std::string file;
    std::vector<std::string> outputs;
};

struct ExperimentArguments : CommonArguments {
    std::string study;   ///< A built-in one, a file (.toml), or "list".
    std::string output;  ///< A folder.
    std::vector<std::string> methods;
    bool quick = false, print = false;
    int threads = 0;
};

struct ViewFactorArguments : CommonArguments {
    SceneArguments scene;
    std::string output;
    std::optional<double> error;            ///< Error of every row; 1e-3 if neither this nor a tolerance is given.
    std::optional<double> tolerance;        ///< Relative error of every entry above 1e-6, in place of an error of rows.
    double smallest = 0;                    ///< Entries below are dropped.
    std::optional<std::size_t> check;       ///< Rows that rays check, or entries if there is a tolerance.
    std::optional<std::size_t> check_rays;  ///< Per row or entry.
    std::uint64_t seed = 1;
    bool resume = false;  ///< Go on from the rows that an earlier run kept.
    int threads = 0;
};

struct HeatArguments : CommonArguments {
    std::string factors, table;          ///< View factors (.h5), and the thermal state of their surfaces (.csv).
    std::string output, exchange;        ///< Tables to write; empty: none.
    std::optional<double> surroundings;  ///< Temperature of the surroundings, K; none: an enclosure.
    int threads = 0;
};

struct ViewArguments : CommonArguments {
    SceneArguments scene;  ///< Or a solution (.h5).
    int port = 0;          ///< 0: any that is free.
    double error = 0.02;   ///< Asked for, of a scene.
    SolveOptions options;  ///< Method and threads.
    std::string save = "viewed.h5";
};

/// What the program is to do.
using Command =
    std::variant<SolveArguments, ProbeArguments, CompareArguments, StatsArguments, MixArguments, ExportArguments,
                 RenderArguments, BakeArguments, ReportArguments, DaylightArguments, CheckArguments, GenerateArguments,
                 LuminaireArguments, ExperimentArguments, ViewFactorArguments, HeatArguments, ViewArguments>;

/// Text asked for by --help or --version.
struct Information {
    std::string text;
};

/// Reads the command line, the program's name left out. Errors are of code `usage` and name the nearest known verb or
/// option in their hint.
Result<std::variant<Command, Information>> parse_arguments(const std::vector<std::string>& arguments);

}  // namespace exitance
