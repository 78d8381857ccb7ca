#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/io/scenes/honeybee/honeybee_choice.hpp"
#include "exitance/io/scenes/scene_lines.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Treatment of faults in a scene file that can be repaired safely.
enum class Faults : std::uint8_t {
    repair,  ///< Repair the faults and report them.
    refuse,  ///< Report the faults as errors.
};

/// A sky that is added to a scene.
struct ChosenSky {
    DistantLight in_watts, in_lumens;
    bool light_groups = false;               ///< Gives the emitters of each group materials of their own.
    std::optional<bool> photometric = {};    ///< True: `in_lumens` is used; empty: the one in the scene's unit.
    std::vector<std::string> warnings = {};  ///< Sentences about the weather file, if there is one.
};

/// Options for reading a scene.
struct LoadOptions {
    Faults faults = Faults::repair;
    bool run_commands = false;          ///< Runs installed Radiance programs for lines that begin with '!'.
    const StopRequest* stop = nullptr;  ///< When a stop is requested, programs that `!` lines run are ended.
    bool older_sky_programs = false;    ///< Interprets !gensky and !gendaylit as before November 2019.
    std::optional<ChosenSky> sky = {};
    std::string luminaires = {};           ///< Path of a table of luminaires to add to the scene; empty: none.
    bool light_groups = false;             ///< Gives the emitters of each group materials of their own.
    std::optional<bool> photometric = {};  ///< True if the scene's light is in lumens; empty: as stated in the files.
    bool turn_bodies = false;              ///< Reverses the faces of closed bodies whose fronts are inside.
    /// Length unit and upright axis of files that do not define them; empty: metres, Z up.
    std::optional<double> metres_per_unit = {};
    std::optional<bool> y_is_up = {};
    bool without_panes = false;  ///< Omits clear glass, for view factors, which it does not change.
    /// False where emission does not matter (view factors) or comes with the run (a year of daylight): a material file
    /// that cannot be read is then a repair even if nothing emits.
    bool needs_light = true;
    /// Limit on the parts into which textured faces are cut; none: `default_texture_parts`, 0: no face is cut.
    std::optional<std::size_t> texture_parts = {};
    std::string lod = {};                  ///< Level of detail to read from .city.json files; empty: the highest.
    HoneybeeChoices honeybee_states = {};  ///< States of dynamic objects of Honeybee models.
};

/// A pane of a scene file with its names: its outline in the scene's coordinates, metres.
struct NamedPane {
    std::string material, object;
    std::vector<Point> corners;
};

/// A scene with the map from face lines to files. Line numbers of several files are numbered consecutively.
struct LoadedScene : CheckedScene {
    SceneLines lines = {};
    /// Per material: RMS deviation of the reflectance within and between textured faces of that material, which has
    /// their mean. May be shorter than the list of materials.
    std::vector<Spectrum> reflectance_deviation = {};
    Point origin = {};  ///< Subtracted from the coordinates of the first file, metres.
    std::vector<NamedPane> panes = {};
};

/// Reads and checks the files of one scene, in the given order. Radiance files share their material names and are read
/// at the position of the first of them. Of coplanar faces the later one is on top, or one that emits light.
/// Errors as for the overload below.
LoadedScene load_scene(std::span<const std::string> paths, const LoadOptions& options);

/// Reads and checks a scene file in the format of its ending (.obj, .gltf, .glb, .rad, .stl, .ply, .vs3, .hbjson,
/// .json). The findings list every error in the file. The error code is cannot_read if the file cannot be read,
/// otherwise bad_input.
CheckedScene load_scene(const std::string& path, Faults faults = Faults::repair);

/// True if one of the files defines its length unit and upright axis; the scene then uses these.
bool say_units(std::span<const std::string> paths);

/// Returns the content of scene files without checking it; empty if a file has an unknown format or cannot be read.
SceneDescription read_description(std::span<const std::string> paths, const LoadOptions& options);

}  // namespace exitance
