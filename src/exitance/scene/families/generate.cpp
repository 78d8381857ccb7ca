#include "exitance/scene/families/generate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "exitance/scene/families/families.hpp"

namespace exitance {
namespace {

/// A family and how it is made.
struct Recipe {
    SceneFamily family;
    PolygonKit (*make)(const FamilyValues&);
};

const FamilyParameter lights = {"lights", 1, 1, 4, true, "square lights, together of the same power"};
const FamilyParameter reflectance = {"rho", 0.5, 0, 0.999999, false, "reflectance of the walls"};

const std::vector<Recipe>& recipes() {
    static const std::vector<Recipe> all = {
        {{"blocker",
          "a blocker between a source and a receiver, all black, so that the light is analytic: 3 polygons",
          {{"h", 0.7, -1e6, 1e6, false, "height of the blocker; the source is at 2, the umbra vanishes at 4/3"}}},
         make_blocker},
        {{"tube",
          "a closed tube of 1 by 1 with a light at one end: 6 polygons",
          {reflectance, {"length", 8, 1e-3, 1e6, false, "of the tube, metres"}}},
         make_tube},
        {{"furnace",
          "every face emits 1 W/m^2 and reflects rho, so that B = 1/(1-rho) everywhere: 12 polygons",
          {reflectance, {"inner", 1, 0, 1, true, "1: with a box that floats inside"}}},
         make_furnace},
        {{"complex",
          "chairs in a closed triangular room under a triangular light: 5 + 27 m polygons",
          {{"m", 6, 1, 500000, true, "chairs; the room's area grows with them"}}},
         make_complex},
        {{"flat", "lights over a receiver, in the open: 1 + lights polygons", {lights}}, make_flat},
        {{"boxes", "two floating boxes over a floor, in the open: 13 + lights polygons", {lights}}, make_boxes},
        {{"table", "a table on a floor, in the open: 33 + lights polygons", {lights}}, make_table},
        {{"chair", "a detailed chair on a floor, in the open: 64 + lights polygons", {lights}}, make_chair},
        {{"float", "a table, four chairs at it and one above, in the open: 213 + lights polygons", {lights}},
         make_float},
        {{"spiral",
          "a spiral staircase, in the open: 4 + sides + 6 steps polygons",
          {{"steps", 16, 1, 100000, true, "steps"}, {"sides", 12, 3, 100000, true, "sides of the column"}}},
         make_spiral},
        {{"gcr1", "floor, wall and a light, in the open: 3 polygons", {}}, make_gcr1},
        {{"gcr2", "gcr1 with two blockers of one polygon: 5 polygons", {}}, make_gcr2},
        {{"cornell", "the measured Cornell box, its front open: 17 polygons", {}}, make_cornell},
        {{"office",
          "a closed office floor, furnished: about nx ny (32 + nfurn (83 + 20 books)) polygons",
          {{"nx", 2, 1, 2000, true, "rooms along x"},
           {"ny", 2, 1, 2000, true, "rooms along y"},
           {"nfurn", 2, 0, 4, true, "work places a room"},
           {"books", 6, 0, 1000, true, "books a board"},
           {"seed", 7, 0, 9e15, true, "of what differs from place to place"}}},
         make_office},
        {{"carpet",
          "two furnished rooms under a wavy sheet of triangles that emit: u v + cuts^2 (822 + 160 books) triangles",
          {{"u", 76, 2, 4000, true, "triangles in a strip of the sheet"},
           {"v", 77, 1, 4000, true, "strips of the sheet"},
           {"h", 2.2, 2, 2.6, false, "height of the sheet, metres"},
           {"wave", 0.05, 0, 0.1, false, "how high its waves are, metres"},
           {"cuts", 4, 1, 40, true, "parts that a side of the rooms' triangles is cut into"},
           {"books", 9, 0, 1000, true, "books a board"}}},
         make_carpet},
    };
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

/// "1,2,3" as numbers; nothing unless there are as many as `count`.
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

/// What is done to a scene of any family.
struct Motion {
    double degrees = 0, scale = 1;
    Vec3 axis{0, 0, 1}, shift;

    /// Turned by Rodrigues' formula, scaled, shifted.
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
                                        [&](const FamilyParameter& p) { return p.name == name; });
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
        constexpr double most = 2e7;
        const double polygons =
            values->at("nx") * values->at("ny") * (32 + values->at("nfurn") * (83 + 20 * values->at("books")));
        if (polygons > most)
            return usage(fmt::format("this office has about {:.0f} polygons, more than {:.0f}", polygons, most), "");
    }
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
