#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/io/scenes/honeybee/honeybee_choice.hpp"
#include "exitance/io/scenes/radiance/rad_words.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// A planar polygon with holes, metres.
struct HoneybeeOutline {
    std::vector<Point> boundary;
    std::vector<std::vector<Point>> holes = {};

    bool operator==(const HoneybeeOutline&) const = default;
};

/// Sides of a sheet that light can reach. The front is the one from which the boundary runs counter-clockwise; faces of
/// rooms have their front outside.
enum class HoneybeeSides : std::uint8_t { back, both };

/// A face, aperture, door, shade or shade mesh of a model.
struct HoneybeeSheet {
    std::string name;      ///< Its identifier.
    std::string modifier;  ///< Name of the sheet's material.
    std::vector<HoneybeeOutline> outlines;
    std::vector<HoneybeeOutline> openings = {};  ///< Apertures and doors, which are cut out of the sheet.
    HoneybeeSides sides = HoneybeeSides::both;
    /// Sheet of the neighbouring room in the same place; empty without one.
    std::string partner = {};

    bool operator==(const HoneybeeSheet&) const = default;
};

/// The sensors of a grid: positions in metres and unit normals.
struct HoneybeeGrid {
    std::string name;
    std::vector<Point> points = {};
    std::vector<Normal> normals = {};
};

/// An eye with a direction, of a view of any kind but a parallel one.
struct HoneybeeEye {
    std::string name;
    Point at;  ///< Metres.
    Normal direction;
};

/// A state of a dynamic object.
struct HoneybeeState {
    std::string modifier;                    ///< Name of the state's material; empty if the model gives none.
    std::vector<HoneybeeSheet> shades = {};  ///< Sheets that exist in this state only.
};

/// An aperture, door or shade with states.
struct HoneybeeDynamic {
    std::string object;  ///< Its identifier.
    std::string group;   ///< Identifier of the group of objects that change together; may be empty.
    std::vector<HoneybeeState> states;
    bool is_shade = false;
};

/// The parts of a Honeybee model that exitance uses.
struct HoneybeeModel {
    std::vector<RadPrimitive> modifiers;  ///< Materials in the words of Radiance, each name once.
    std::vector<HoneybeeSheet> sheets;
    std::vector<HoneybeeGrid> grids;
    std::vector<SceneCamera> views;  ///< Perspective and parallel views.
    std::vector<HoneybeeEye> eyes;   ///< Eyes of all views except parallel ones, in the order of the file.
    std::vector<HoneybeeDynamic> dynamic;
    std::vector<Finding> findings;  ///< Errors, and warnings about omitted parts.

    /// The first error of the findings; empty if there is none. `path`: the file of the model.
    std::optional<Error> first_error(const std::string& path) const;
};

/// True for files of Honeybee models: .hbjson, and .json files whose JSON names the type "Model" but not "CityJSON".
bool is_honeybee_file(const std::string& path);

/// Reads a Honeybee model (HBJSON, schema 1 and 2). Objects without a material get that of their room's modifier set,
/// the model's global set, or Honeybee's generic set, as Honeybee itself chooses it. Dynamic apertures, doors and
/// shades are in the chosen states, by default their first. Air boundaries are open. Energy properties are ignored.
/// O(size of the file). Source: honeybee-schema.
HoneybeeModel read_honeybee_model(const std::string& path, const HoneybeeChoices& choices = {});

}  // namespace exitance
