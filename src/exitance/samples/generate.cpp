#include "exitance/samples/generate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "exitance/samples/families.hpp"

namespace exitance {
namespace {

/// A family and the function that generates it.
struct Recipe {
    SceneFamily family;
    PolygonKit (*make)(const FamilyValues&);
};

const FamilyParameter lights = {"lights", 1, 1, 4, true, "number of square lights; their total power is constant"};
const FamilyParameter reflectance = {"rho", 0.5, 0, 0.999999, false, "reflectance of the walls"};

const FamilyParameter seed = {"seed", 7, 0, 9e15, true, "seed of the random positions"};

/// Rooms with light paths that are hard to find.
const std::vector<Recipe> hard_recipes{
    {{"cove",
      "a room lit by coves alone: emitters on shelves that look up, behind lips: 20 polygons",
      {{"x", 5, 1, 1000, false, "width of the room, from shelf to shelf, metres"},
       {"y", 4, 0.1, 1000, false, "length of the room, along the shelves, metres"},
       {"z", 2.8, 0.5, 100, false, "height of the room, metres"},
       {"at", 2.45, 0.1, 99, false, "height of the shelves' undersides, metres"},
       {"deep", 0.25, 0.05, 0.45, false, "depth of the shelves, metres"},
       {"thick", 0.05, 0.001, 0.5, false, "thickness of the shelves, metres"},
       {"lip", 0.1, 0.001, 0.5, false, "height of the lips, metres"},
       {"lamp", 0.1, 0.001, 0.4, false, "width of the emitters, metres"},
       {"wall", 0.85, 0, 0.999999, false, "reflectance of walls and shelves"},
       {"ceiling", 0.9, 0, 0.999999, false, "reflectance of the ceiling"},
       {"floor", 0.5, 0, 0.999999, false, "reflectance of the floor"}}},
     make_cove},
    {{"blinds",
      "a room lit by a window behind a blind: 7 + 2 slats polygons",
      {{"slats", 60, 1, 100000, true, "number of slats, which have no thickness"},
       {"tilt", 45, -90, 90, false, "angle of the slats, degrees"},
       {"deep", 0.025, 0.001, 0.2, false, "width of a slat, metres"},
       {"away", 0.15, 0.12, 4, false, "distance of the blind from the wall, metres"}}},
     make_blinds},
    {{"clutter",
      "thin triangles at random positions under a lamp: 12 + 2 n polygons",
      {{"n", 1500, 0, 1e6, true, "number of triangles, which reflect on both sides"},
       {"thin", 0.05, 1e-4, 1, false, "width of a triangle by its length"},
       seed}},
     make_clutter},
    {{"gaps",
      "narrow gaps: over a lamp, behind a board, between two boxes: 28 polygons",
      {{"lamp", 0.01, 1e-5, 0.5, false, "distance of the lamp from the ceiling, metres"},
       {"board", 0.01, 1e-5, 0.5, false, "distance of the board from the wall, metres"},
       {"boxes", 0.005, 1e-5, 0.5, false, "distance of the two boxes, metres"}}},
     make_gaps},
    {{"door",
      "two rooms that a door joins, a lamp in one of them: 26 polygons",
      {{"x", 4, 1, 1000, false, "depth of a room, metres"},
       {"width", 0.9, 0.01, 3.9, false, "width of the door, metres"},
       {"height", 2.1, 0.01, 2.6, false, "height of the door, metres"},
       {"lamp", 0.01, 1e-5, 0.5, false, "distance of the lamp from the ceiling, metres"}}},
     make_door},
    {{"keyhole",
      "a lit box with a small hole, in a room: 27 polygons",
      {{"hole", 0.03, 1e-4, 0.8, false, "width and height of the hole, metres"}}},
     make_keyhole},
    {{"bright",
      "a room of one high reflectance with two boxes and a lamp: 22 polygons",
      {{"rho", 0.97, 0, 0.999999, false, "reflectance of everything"}}},
     make_bright},
    {{"tree",
      "leaves at random on a trunk, under a lamp: 17 + 2 leaves polygons",
      {{"leaves", 20000, 0, 1e6, true, "number of triangles, which reflect on both sides"},
       {"size", 0.08, 1e-3, 1, false, "size of a leaf, metres"},
       seed}},
     make_tree},
    {{"lightwell",
      "a room lit through a shaft: 14 polygons",
      {{"width", 1, 0.01, 3.9, false, "width of the shaft, metres"},
       {"length", 9, 0.01, 1000, false, "length of the shaft, metres"}}},
     make_lightwell},
};

const FamilyParameter azimuth = {"azimuth", 215, 0, 360, false, "of the sun, degrees clockwise from +y"};
const FamilyParameter altitude = {"altitude", 35, 1, 90, false, "of the sun above the horizon, degrees"};

/// Parts of buildings.
const std::vector<Recipe> building_recipes{
    {{"atrium",
      "a court with balconies and parapets below a roof light: 7 + 20 floors polygons",
      {{"floors", 3, 1, 100, true, "floors with balconies"},
       {"x", 12, 4, 1000, false, "length, metres"},
       {"y", 9, 4, 1000, false, "width"},
       {"deep", 1.4, 0.1, 1.5, false, "depth of the balconies"},
       {"parapet", 1, 0.05, 2, false, "height of the parapets"}}},
     make_atrium},
    {{"stair",
      "a stair of open treads in its stairwell: 24 + 6 steps polygons",
      {{"steps", 14, 1, 1000, true, "treads"},
       {"width", 1, 0.2, 10, false, "length of a tread, metres"},
       {"thick", 0.04, 0.001, 0.15, false, "thickness of a tread"},
       {"side", 0.4, 0.05, 10, false, "distance from the treads to the walls"}}},
     make_stair},
    {{"colonnade",
      "columns before a wall, below a roof, in the sun: 9 + columns sides polygons",
      {{"columns", 6, 1, 1000, true, "columns"},
       {"sides", 12, 3, 1000, true, "sides of a column"},
       {"radius", 0.25, 0.01, 0.9, false, "of a column, metres"},
       {"apart", 2.5, 1.9, 100, false, "distance between columns"},
       azimuth,
       altitude}},
     make_colonnade},
    {{"greenhouse",
      "a gabled frame of thin bars over beds, in the sun: 12 + 22 ribs + 12 purlins polygons",
      {{"ribs", 8, 1, 1000, true, "ribs: two posts and two rafters each"},
       {"purlins", 2, 0, 20, true, "bars along each side of the roof"},
       {"bar", 0.04, 0.002, 0.1, false, "width and height of a bar, metres"},
       {"length", 5, 1, 1000, false, "of the house"},
       azimuth,
       altitude}},
     make_greenhouse},
    {{"furniture",
      "cupboards of boards that touch, and boxes in them: 12 + 18 n polygons and 6 for every shelf and box",
      {{"n", 3, 0, 1000, true, "cupboards"}, seed}},
     make_furniture},
    {{"canopy",
      "flat roofs with black tops above a wide ground: 2 + 6 roofs polygons",
      {{"ground", 800, 1, 1e5, false, "length of the ground's sides, metres"},
       {"size", 4, 0.01, 1e3, false, "of a roof"},
       {"height", 3, 0.01, 1e3, false, "of a roof above the ground"},
       {"roofs", 1, 1, 100, true, "roofs in a row"},
       {"sun", 1, 0, 1, true, "0: a lamp of a quarter of the roof's area in place of the sun"},
       azimuth,
       altitude}},
     make_canopy},
};

/// Rooms and objects for studies, and scenes of papers.
std::vector<Recipe> study_recipes() {
    return {
        {{"blocker",
          "a blocker between a source and a receiver, all black, so that the light is analytic: 3 polygons",
          {{"h", 0.7, -1e6, 1e6, false, "height of the blocker; the source is at 2, the umbra vanishes at 4/3"}}},
         make_blocker},
        {{"tube",
          "a closed tube of 1 by 1 with a light at one end: 6 polygons",
          {reflectance, {"length", 8, 1e-3, 1e6, false, "length of the tube, metres"}}},
         make_tube},
        {{"furnace",
          "every face emits 1 W/m^2 and reflects rho, so that B = 1/(1-rho) everywhere: 12 polygons",
          {reflectance, {"inner", 1, 0, 1, true, "1: with a box that floats inside"}}},
         make_furnace},
        {{"complex",
          "chairs in a closed triangular room under a triangular light: 5 + 27 m polygons",
          {{"m", 6, 1, 500000, true, "number of chairs; the room's area grows with them"},
           {"scaled", 1, 0, 1, true, "0: the room is that of 36 chairs, or of m where that is more"}}},
         make_complex},
        {{"flat", "lights over a receiver, in the open: 1 + lights polygons", {lights}}, make_flat},
        {{"boxes", "two floating boxes over a floor, in the open: 13 + lights polygons", {lights}}, make_boxes},
        {{"table", "a table on a floor, in the open: 33 + lights polygons", {lights}}, make_table},
        {{"chair", "a detailed chair on a floor, in the open: 64 + lights polygons", {lights}}, make_chair},
        {{"float", "a table, four chairs at it and one above, in the open: 213 + lights polygons", {lights}},
         make_float},
        {{"spiral",
          "a spiral staircase, in the open: 4 + sides + 6 steps polygons",
          {{"steps", 16, 1, 100000, true, "number of steps"},
           {"sides", 12, 3, 100000, true, "number of sides of the column"}}},
         make_spiral},
        {{"gcr1", "floor, wall and a light, in the open: 3 polygons", {}}, make_gcr1},
        {{"gcr2", "gcr1 with two blockers of one polygon: 5 polygons", {}}, make_gcr2},
        {{"cornell", "the measured Cornell box, its front open: 17 polygons", {}}, make_cornell},
        {{"office",
          "a closed office floor, furnished: about nx ny (32 + nfurn (83 + 20 books)) polygons",
          {{"nx", 2, 1, 2000, true, "number of rooms along x"},
           {"ny", 2, 1, 2000, true, "number of rooms along y"},
           {"nfurn", 2, 0, 4, true, "number of work places per room"},
           {"books", 6, 0, 1000, true, "number of books per board"},
           {"seed", 7, 0, 9e15, true, "seed of the random differences between work places"}}},
         make_office},
        {{"carpet",
          "two furnished rooms under a wavy sheet of triangles that emit: u v + cuts^2 (822 + 160 books) triangles",
          {{"u", 76, 2, 4000, true, "number of triangles in a strip of the sheet"},
           {"v", 77, 1, 4000, true, "number of strips of the sheet"},
           {"h", 2.2, 2, 2.6, false, "height of the sheet, metres"},
           {"wave", 0.05, 0, 0.1, false, "height of its waves, metres"},
           {"cuts", 4, 1, 40, true, "number of parts into which a side of the rooms' triangles is cut"},
           {"books", 9, 0, 1000, true, "number of books per board"}}},
         make_carpet},
    };
}

const std::vector<Recipe>& recipes() {
    static const std::vector<Recipe> all = [] {
        std::vector<Recipe> out = study_recipes();
        for (const auto* const more : {&hard_recipes, &building_recipes})
            out.insert(out.end(), more->begin(), more->end());
        return out;
    }();
    return all;
}

Error usage(std::string message, std::string hint) {
    return {ErrorCode::usage, std::move(message), "", std::move(hint)};
}

std::optional<double> number(const std::string& text) {
    double value = 0;
    const char* first = text.data() + (text.starts_with('+') ? 1 : 0);
    const auto [end, error] = std::from_chars(first, text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// Parses "1,2,3"; returns nothing unless there are exactly `count` numbers.
std::optional<std::vector<double>> numbers(const std::string& text, std::size_t count) {
    std::vector<double> out;
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t comma = std::min(text.find(',', from), text.size());
        const auto value = number(text.substr(from, comma - from));
        if (!value) return std::nullopt;
        out.push_back(*value);
        from = comma + 1;
    }
    if (out.size() != count) return std::nullopt;
    return out;
}

/// The transformation that can be applied to a scene of any family.
struct Motion {
    double degrees = 0, scale = 1;
    Vec3 axis{0, 0, 1}, shift;

    /// Rotates by Rodrigues' formula, then scales and translates.
    Point operator()(const Point& p) const {
        const double angle = degrees * pi / 180, c = std::cos(angle), s = std::sin(angle);
        return scale * (c * p + s * cross(axis, p) + (dot(axis, p) * (1 - c)) * axis) + shift;
    }
};

double rounded(double c) {
    const double r = std::round(c * 1e12) / 1e12;
    if (std::abs(c) < 1e3 && std::abs(r - c) < 1e-9 * std::abs(c)) return r + 0.0;
    return std::abs(c) < 1e-15 ? 0 : c;
}

Result<Motion> motion_of(const std::map<std::string, std::string>& parameters) {
    Motion out;
    if (const auto rot = parameters.find("rot"); rot != parameters.end()) {
        const auto v = numbers(rot->second, 4);
        if (!v || norm(Vec3{(*v)[1], (*v)[2], (*v)[3]}) == 0)
            return usage(fmt::format("rot={} is not an angle and an axis", rot->second), "write rot=DEGREES,x,y,z");
        out.degrees = (*v)[0], out.axis = normalized({(*v)[1], (*v)[2], (*v)[3]});
    }
    if (const auto scale = parameters.find("scale"); scale != parameters.end()) {
        const auto v = number(scale->second);
        if (!v || *v <= 0) return usage(fmt::format("scale={} is not a number above 0", scale->second), "");
        out.scale = *v;
    }
    if (const auto shift = parameters.find("shift"); shift != parameters.end()) {
        const auto v = numbers(shift->second, 3);
        if (!v) return usage(fmt::format("shift={} is not a vector", shift->second), "write shift=x,y,z");
        out.shift = {(*v)[0], (*v)[1], (*v)[2]};
    }
    return out;
}

Result<FamilyValues> values_of(const SceneFamily& family, const std::map<std::string, std::string>& parameters) {
    static const std::set<std::string> common = {"name", "rot", "scale", "shift"};
    FamilyValues values;
    for (const FamilyParameter& p : family.parameters) values[p.name] = p.value;
    for (const auto& [name, text] : parameters) {
        if (common.contains(name)) continue;
        const auto known = std::find_if(family.parameters.begin(), family.parameters.end(),
                                        [name = name](const FamilyParameter& p) { return p.name == name; });
        if (known == family.parameters.end()) {
            std::string names;
            for (const FamilyParameter& p : family.parameters) names += p.name + ", ";
            return usage(fmt::format("the family '{}' has no parameter '{}'", family.name, name),
                         "it takes " + names + "name, rot, scale, shift");
        }
        const auto value = number(text);
        if (!value || *value < known->least || *value > known->most || (known->whole && *value != std::floor(*value)))
            return usage(fmt::format("{}={} is not a {}number from {:g} to {:g}", name, text,
                                     known->whole ? "whole " : "", known->least, known->most),
                         known->help);
        values[name] = *value;
    }
    return values;
}

}  // namespace

const std::vector<SceneFamily>& scene_families() {
    static const std::vector<SceneFamily> all = [] {
        std::vector<SceneFamily> out;
        for (const Recipe& r : recipes()) out.push_back(r.family);
        return out;
    }();
    return all;
}

Result<SceneDescription> generate_scene(const std::string& family,
                                        const std::map<std::string, std::string>& parameters) {
    const auto recipe =
        std::find_if(recipes().begin(), recipes().end(), [&](const Recipe& r) { return r.family.name == family; });
    if (recipe == recipes().end()) {
        std::string names;
        for (const Recipe& r : recipes()) names += (names.empty() ? "" : ", ") + r.family.name;
        return usage(fmt::format("there is no scene family '{}'", family), "there are " + names);
    }
    const Result<FamilyValues> values = values_of(recipe->family, parameters);
    if (!values) return values.error();
    const Result<Motion> motion = motion_of(parameters);
    if (!motion) return motion.error();
    if (family == "office") {
        constexpr double max_polygons = 2e7;
        const double polygons =
            values->at("nx") * values->at("ny") * (32 + values->at("nfurn") * (83 + 20 * values->at("books")));
        if (polygons > max_polygons)
            return usage(fmt::format("this office has about {:.0f} polygons, more than {:.0f}", polygons, max_polygons),
                         "");
    }
    if (family == "cove" && values->at("at") + values->at("thick") + values->at("lip") >= values->at("z"))
        return usage("the lips of this cove reach its ceiling", "at + thick + lip is to be less than z");
    SceneDescription out = recipe->make(*values).take();
    const bool moves = parameters.contains("rot") || parameters.contains("scale") || parameters.contains("shift");
    for (Point& p : out.points) {
        if (moves) p = (*motion)(p);
        p = {rounded(p.x), rounded(p.y), rounded(p.z)};
    }
    if (const auto name = parameters.find("name"); name != parameters.end()) out.file = name->second + ".obj";
    return out;
}

}  // namespace exitance
