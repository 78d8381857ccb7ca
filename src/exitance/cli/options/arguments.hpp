#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/cli/exit_code.hpp"
#include "exitance/cli/reference/verb_facts.hpp"
#include "exitance/cli/run_limits.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/files/light_probe_file.hpp"
#include "exitance/io/files/radiance_matrix.hpp"
#include "exitance/io/pictures/false_colour.hpp"
#include "exitance/io/pictures/tone_map.hpp"
#include "exitance/io/report/daylight_parts.hpp"
#include "exitance/io/report/hours_file.hpp"
#include "exitance/io/report/report.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/view_factors/view_factor_file.hpp"
#include "exitance/measure/glare/daylight_glare_rules.hpp"
#include "exitance/measure/working_plane.hpp"
#include "exitance/methods/options/solve_request.hpp"
#include "exitance/scene/photometric_units.hpp"
#include "exitance/solve/solve_options.hpp"
#include "exitance/what_if/daylight/daylight_provision.hpp"

namespace exitance {

enum class ProgressStyle { automatic, bar, plain, json, none };

/// Options that every verb has.
struct CommonArguments {
    LimitArguments limits;
    bool json = false;   ///< Print facts as JSON to stdout.
    bool quiet = false;  ///< Print only errors to stderr.
    bool verbose = false;
    ProgressStyle progress = ProgressStyle::automatic;
};

/// Options of verbs that read a scene.
struct SceneArguments {
    std::vector<std::string> files;  ///< Files that make one scene, in the order given.
    LoadOptions load;
};

struct SolveArguments : CommonArguments, SolveRequest {
    SceneArguments scene;
    std::string output;
};

/// Unit of light in a verb's results.
struct UnitArguments {
    UnitChoice choice = UnitChoice::scene;
    std::optional<double> efficacy;  ///< Luminous efficacy of light given in watts, lm/W; none: 179, as in Radiance.
};

struct ProbeArguments : CommonArguments {
    std::string solution, points;
    std::string output = "-";
    bool interpolant = false;
    bool exact = false;  ///< Direct light by closed forms only.
    Component component = Component::total;
    UnitArguments unit;
    std::size_t reference_paths = 0;  ///< Unbiased paths per point, traced instead of evaluating the solution; 0: none.
    std::uint64_t seed = 1;
    int threads = 0;
};

struct LightProbeArguments : CommonArguments {
    std::string solution, output;
    std::optional<ProbeGrid> grid;
    std::string points;    ///< File of points; empty: `grid`.
    unsigned rays = 1024;  ///< Rays per probe, a power of two.
    int threads = 0;
};

struct StatsArguments : CommonArguments {
    std::string solution;
    int threads = 0;
};

struct MixArguments : CommonArguments {
    std::string solution, output;
    std::vector<std::string> dim;          ///< Words GROUP=FACTOR.
    std::vector<std::string> reflectance;  ///< Words MATERIAL=r,g,b.
    int threads = 0;
};

struct ExportArguments : CommonArguments {
    std::string solution, output;
    std::string links;  ///< Number of an element, or a point x,y,z, whose links are exported; empty: export the light.
    int threads = 0;
};

struct RenderArguments : CommonArguments {
    std::string solution, output;
    std::optional<Camera> camera;  ///< Camera; none: the scene's `camera_name` or, without a name, an automatic camera.
    std::string camera_name;       ///< Name of a camera of the scene, or its number from 1; empty: none.
    std::optional<double>
        fov;  ///< Angle (degrees) or orthographic width (metres) given with `camera`; none: the default.
    Projection projection = Projection::perspective;
    PictureSize size;
    double exposure = 0;                   ///< Stops above the automatic exposure.
    std::optional<double> exposure_scale;  ///< Factor of radiosity, replaces `exposure`; none: use `exposure`.
    ToneCurve tone_map = ToneCurve::filmic;
    std::optional<Quantity> false_colour;
    ScaleChoice scale;       ///< Scale of false colours and isolux lines.
    bool has_scale = false;  ///< True if an option has set some part of `scale`.
    UnitArguments unit;
    bool isolux = false;
    std::size_t samples = 16;  ///< Rays per pixel.
    std::size_t gather = 0;    ///< Rays of a final gather per sample; 0: no final gather.
    /// Elements whose edges are drawn: "export": the exported elements; "true": the method's own; empty: none.
    std::string mesh;
    bool shadow_classes = false;
    bool interpolant = false;  ///< Show the exported elements in place of the full solution.
    std::string layer;         ///< Source whose layer is shown, by number or name; empty: all light.
    std::string path;          ///< File with one camera per row, for numbered pictures; empty: one picture.
    int threads = 0;
};

struct CompareArguments : CommonArguments {
    std::string solution, reference;
    bool interpolant = false;
    std::string map;       ///< File for a picture of the error in false colours; empty: none.
    RenderArguments view;  ///< Camera, size and scale of the map; other members are ignored.
    int threads = 0;
};

struct BakeArguments : CommonArguments {
    std::string solution, output;
    double density = 0;       ///< Texels per metre; 0: chosen for the scene.
    std::size_t padding = 4;  ///< Texels around every chart.
    LightMapFormat format;
    std::string uv;                   ///< Set of texture coordinates of the scene's file; empty: exitance's own charts.
    std::optional<PictureSize> size;  ///< Texels of each map with `uv`; empty: by density.
    std::string charts;               ///< PNG file for a picture of the charts with `uv`; empty: none.
    bool faceted = false;             ///< Ignore the normals of the scene's file.
    bool light_groups = false;        ///< True if separate maps are baked for every light group as well.
    int threads = 0;
};

struct ReportArguments : CommonArguments {
    std::string solution, output;
    std::vector<RenderArguments> views;  ///< Cameras of pictures; other members are ignored. Empty: automatic cameras.
    std::vector<MeasuringPlane> planes;
    std::vector<PlaneRequest> working_planes;
    double maintenance = 1;
    std::vector<std::string> observers;  ///< Descriptions for find_observers().
    std::string tables;                  ///< Folder for tables; empty: none.
    std::string pdf;                     ///< The page as PDF; empty: none.
    ReportHeading heading;
    std::vector<Requirement> requirements;
    std::vector<std::string> tasks;  ///< Tasks of rooms, "NAME" or "ROOM=NAME".
    std::string tasks_file;          ///< Further tasks (TOML); empty: none.
    bool lists_tasks = false;        ///< Print the known tasks, and nothing else.
    std::string words;               ///< Template of the page: "german" or a TOML file; empty: English.
    bool lists_words = false;        ///< Print the German template, and nothing else.
    PictureSize size{960, 600};
    UnitArguments unit;
    int threads = 0;
};

struct GlareArguments : CommonArguments {
    std::string solution;
    std::vector<std::string> observers;  ///< Descriptions for find_observers().
    GlareThreshold threshold;
    std::optional<double> efficacy;  ///< Luminous efficacy of light given in watts, lm/W; none: 179.
    int threads = 0;
};

struct DaylightArguments : CommonArguments {
    SceneArguments scene;  ///< A scene, or one solution (.h5) of it.
    std::string epw, output;
    std::string points;   ///< File of sensors; empty: the grids of the scene's Honeybee model.
    double error = 0.02;  ///< Requested relative RMS error of every grid.
    int division = 1;     ///< Parts into which Tregenza's sky patches are divided in each direction: 1, 2 or 4.
    double north = 0, ground = 0.2;
    SunDay sun_day;                      ///< Day for which hours of sunlight are counted.
    std::string eyes;                    ///< File with points for views out; empty: none.
    std::string views;                   ///< File with views for glare; empty: none.
    std::string occupied;                ///< "8-18", or a file with a number per hour; empty: 8 to 18 h.
    DaylightCriteria criteria;           ///< Occupied hours are read from `occupied`.
    std::string coefficients;            ///< Radiance matrix to evaluate; empty: none.
    std::string states;                  ///< File with states of panes; empty: all panes keep their state.
    std::optional<MatrixFormat> matrix;  ///< Format of matrix.mtx; none: matrix.csv.
    HoursFormat hours = HoursFormat::hdf5;
    std::optional<DaylightPart> part;  ///< Part of the sensors to compute; none: all sensors.
    bool merge = false;                ///< Write the results of all parts.
    int threads = 0;
};

struct CheckArguments : CommonArguments {
    SceneArguments scene;
    std::string picture;
    int threads = 0;
};

struct GenerateArguments : CommonArguments {
    std::string family, output;
    std::vector<std::string> parameters;  ///< Words "name=value".
};

struct LuminaireArguments : CommonArguments {
    std::string file;
    std::vector<std::string> outputs;
};

struct ExperimentArguments : CommonArguments {
    std::string study;   ///< Name of a built-in study, a file (.toml), or "list".
    std::string output;  ///< Folder to write.
    std::vector<std::string> methods;
    bool quick = false, print = false;
    int threads = 0;
};

struct ViewFactorArguments : CommonArguments {
    SceneArguments scene;
    std::string output;               ///< Matrix to write; may be empty if `operator_file` is not.
    std::string operator_file;        ///< File for the operator of solvers (.h5); empty: none.
    std::optional<double> error;      ///< Limit on the error of every row; 1e-3 if neither this nor `tolerance` is set.
    std::optional<double> tolerance;  ///< Relative error of every entry above 1e-6; replaces `error`.
    double smallest = 0;              ///< Smaller entries are dropped.
    std::optional<std::size_t> check;       ///< Rows checked by rays, or entries if `tolerance` is set.
    std::optional<std::size_t> check_rays;  ///< Rays per checked row or entry.
    std::uint64_t seed = 1;
    bool resume = false;                 ///< Continue from the rows that a stopped run kept.
    std::optional<FactorFormat> format;  ///< Format of the output; empty: given by the file's ending.
    bool with_sky = false;               ///< Add columns for the sky and for backs of faces.
    std::string nodes;       ///< `group`, `material` or a table with the node of every face; empty: faces are rows.
    std::string zone;        ///< Name of the zone in EnergyPlus; empty: "zone".
    std::string emissivity;  ///< `kd` or a table: adds exchange factors of grey surfaces; empty: none.
    int threads = 0;
};

struct View3dArguments : CommonArguments {
    std::string input, output;
    std::optional<double> error;  ///< Error of rows; empty: from the file's `eps`.
    int threads = 0;
};

struct HeatArguments : CommonArguments {
    std::string factors, table;  ///< Files with view factors (.h5) and with the thermal state of their surfaces (.csv).
    std::string output, exchange, gebhart;  ///< Tables to write; empty: none.
    std::optional<double> surroundings;     ///< Temperature of the surroundings, K; none: an enclosure.
    int threads = 0;
};

/// Numbers of variants, from 1: first to last.
struct VariantRange {
    std::size_t first = 1, last = 1;
};

struct SweepArguments : CommonArguments {
    std::string plan;
    bool list = false, collect = false;
    std::optional<VariantRange> run;   ///< Variants to run; none: --run is not given.
    std::size_t local = 0;             ///< Variants that are run at a time; 0: --local is not given.
    std::vector<std::string> outputs;  ///< Files of --collect; empty: both in the folder of the sweep.
    int threads = 0;
};

struct ViewArguments : CommonArguments {
    SceneArguments scene;  ///< A scene to solve, or one or two solutions (.h5).
    std::string output;    ///< Page to write (.html) instead of serving one; empty: none.
    std::string views;     ///< Saved views (.json) for that page; empty: none.
    int port = 0;          ///< Port on 127.0.0.1; 0: any free port.
    double error = 0.02;   ///< Requested relative RMS error if a scene is solved.
    /// For a scene: its method, its threads, and the options of `view_light_options`.
    SolveRequest request;
    UnitArguments unit;
    std::string save = "viewed.h5";
};

/// Format of the page that `exitance reference` prints.
enum class ReferenceFormat : std::uint8_t { man, markdown, bash, zsh, list };

struct ReferenceArguments : CommonArguments {
    ReferenceFormat format = ReferenceFormat::man;
};

/// A verb with its options.
using Command =
    std::variant<SolveArguments, ProbeArguments, CompareArguments, StatsArguments, MixArguments, ExportArguments,
                 RenderArguments, BakeArguments, ReportArguments, DaylightArguments, CheckArguments, GenerateArguments,
                 LuminaireArguments, ExperimentArguments, ViewFactorArguments, View3dArguments, HeatArguments,
                 ViewArguments, ReferenceArguments, LightProbeArguments, SweepArguments, GlareArguments>;

/// Text to print instead of running a verb, for --help and --version.
struct Information {
    std::string text;
};

/// The names, examples and options of all verbs, in the order of `exitance --help`.
std::vector<VerbFacts> facts_of_verbs();

/// Parses the command line without the program's name. Error (usage): an unknown verb or option, with the most similar
/// known one in the hint; a missing, wrong or repeated value.
Result<std::variant<Command, Information>> parse_arguments(const std::vector<std::string>& arguments);

}  // namespace exitance
