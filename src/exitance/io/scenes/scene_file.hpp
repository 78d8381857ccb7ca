#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/io/scenes/scene_lines.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// What becomes of faults that have a safe repair.
enum class Faults : std::uint8_t {
    repair,  ///< They are repaired, and said.
    refuse,  ///< They are errors.
};

/// A sky to be put over a scene.
struct ChosenSky {
    DistantLight in_watts, in_lumens;
    bool light_groups = false;               ///< Gives the emitters of every group materials of their own.
    std::optional<bool> photometric = {};    ///< Which of them; none: as the scene has it.
    std::vector<std::string> warnings = {};  ///< Sentences about the weather file that it comes from.
};

/// How a scene is read.
struct LoadOptions {
    Faults faults = Faults::repair;
    bool run_commands = false;  ///< Lets installed programs of Radiance's do what lines that begin with '!' say.
    const StopRequest* stop = nullptr;  ///< Ends such programs.
    bool older_sky_programs = false;    ///< Reads !gensky and !gendaylit as those of before November 2019.
    std::optional<ChosenSky> sky = {};
    std::string luminaires = {};           ///< A table of luminaires that stand in the scene; empty: none.
    bool light_groups = false;             ///< Gives the emitters of every group materials of their own.
    std::optional<bool> photometric = {};  ///< Is the scene's light in lumens? None: as its files say.
    bool turn_bodies = false;              ///< Turns the faces of closed bodies that are inside out.
    /// Length unit and upright axis of files that do not say either; none: metres, Z up.
    std::optional<double> metres_per_unit = {};
    std::optional<bool> y_is_up = {};
};

/// A scene, and where its faces' lines stand: those of several files are counted on from one to the next.
struct LoadedScene : CheckedScene {
    SceneLines lines = {};
    /// By material: how much its reflectance varies over faces that show pictures, RMS. Faces have the mean. May be
    /// shorter than the materials.
    std::vector<Spectrum> reflectance_deviation = {};
};

/// Reads and checks the files of one scene, in their order. Files of Radiance share the names of materials and stand
/// where the first of them does; of faces in one plane the later one is on top. As below otherwise.
LoadedScene load_scene(std::span<const std::string> paths, const LoadOptions& options);

/// Reads and checks a scene file; its ending says what it is (.obj, .gltf, .glb, .rad, .stl, .vs3). Every error of
/// the file is among the findings. An unreadable file has the code cannot_read, everything else that is wrong
/// bad_input.
CheckedScene load_scene(const std::string& path, Faults faults = Faults::repair);

/// True if one of the files says its length unit and which axis is up: then so does the scene.
bool say_units(std::span<const std::string> paths);

/// What a scene file says, not yet checked; nothing, where it is of no known kind or cannot be read.
SceneDescription read_description(std::span<const std::string> paths, const LoadOptions& options);

}  // namespace exitance
