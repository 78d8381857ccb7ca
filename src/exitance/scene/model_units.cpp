#include "exitance/scene/model_units.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cmath>

namespace exitance {
namespace {

/// Area of faces at the six sides of the scene's box, by orientation: side 2 k is the lower one of axis k, side 2 k + 1
/// the upper.
struct BoxSides {
    std::array<double, 6> inwards{}, outwards{};  ///< m^2

    explicit BoxSides(const Scene& scene) {
        const Box& box = scene.box();
        constexpr double near_side =  // relative to the box's extent: windows and panelling are slightly off the walls
            0.02;
        for (const SurfaceId s : scene.surfaces().ids()) {
            const Surface& surface = scene.surfaces()[s];
            for (std::size_t k = 0; k < 3; ++k)
                for (const bool upper : {false, true}) {
                    const double side = upper ? box.hi[k] : box.lo[k], reach = near_side * (box.hi[k] - box.lo[k]);
                    bool lies_there = reach > 0;
                    for (const Point& p : scene.outline(s)) lies_there &= std::abs(p[k] - side) <= reach;
                    if (!lies_there) continue;
                    const double look = upper ? -surface.normal[k] : surface.normal[k];
                    (look > 0 ? inwards : outwards)[2 * k + (upper ? 1 : 0)] += surface.area;
                }
        }
    }

    bool is_inwards(std::size_t side) const { return inwards[side] > outwards[side]; }
    /// True if most sides have their fronts inside, even if one or two sides are open.
    bool is_room() const {
        int inside = 0, outside = 0;
        for (std::size_t side = 0; side < 6; ++side)
            inside += is_inwards(side), outside += outwards[side] > inwards[side];
        return inside >= 3 && outside <= 1;
    }
    /// Returns the only side without faces; 6 if there is none or more than one.
    std::size_t open_side() const {
        std::size_t open = 6;
        for (std::size_t side = 0; side < 6; ++side) {
            if (inwards[side] + outwards[side] > 0) continue;
            if (open != 6) return 6;
            open = side;
        }
        return open;
    }
};

bool contains_word(const std::string& name, std::string_view word) {
    std::string lower;
    for (const char c : name) lower.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
    return lower.find(word) != lower.npos;
}

/// Returns the upward direction according to the scene's lamps, floors and ceilings, weighted by flux or area; zero if
/// there are none.
Vec3 upwards(const Scene& scene) {
    Vec3 by_lamps, by_names;
    for (const SurfaceId s : scene.surfaces().ids()) {
        const Surface& surface = scene.surfaces()[s];
        const Material& material = scene.material(s);
        if (material.emits()) by_lamps -= mean(material.exitance) * surface.area * surface.normal;
        for (const std::string& name : {scene.groups()[surface.group], material.name}) {
            if (contains_word(name, "floor")) by_names += surface.area * surface.normal;
            if (contains_word(name, "ceiling")) by_names -= surface.area * surface.normal;
        }
    }
    return norm(by_names) > 0 ? by_names : by_lamps;
}

bool is_y_up(const Scene& scene, const BoxSides& sides) {
    constexpr double min_cosine = 0.9;  // cosine: clearly along one axis
    const Vec3 up = upwards(scene);
    if (norm(up) > 0) return up.y > min_cosine * norm(up);
    constexpr std::size_t upper_y = 3;
    return sides.is_room() && sides.open_side() == upper_y;
}

/// Returns the unit in which a room of this height is nearest to a typical one; null if metres are plausible.
const char* unit_of_room(double height) {
    constexpr double max_height = 30;  // metres: an atrium or a nave
    if (height <= max_height) return nullptr;
    constexpr std::array<std::pair<const char*, double>, 3> units{{{"mm", 1e-3}, {"cm", 1e-2}, {"in", 0.0254}}};
    constexpr double typical_height = 2.7;  // metres
    const char* best = nullptr;
    double least = std::log(max_height / typical_height);
    for (const auto& [name, metres] : units)
        if (const double off = std::abs(std::log(height * metres / typical_height)); off < least)
            best = name, least = off;
    return best;
}

}  // namespace

ModelUnits guess_units(const Scene& scene) {
    ModelUnits out;
    const BoxSides sides(scene);
    out.y_is_up = is_y_up(scene, sides);
    const Vec3 extent = scene.box().size();
    const double height = out.y_is_up ? extent.y : extent.z;
    const double widest = std::max({extent.x, extent.y, extent.z});
    constexpr double min_room_height = 0.5, min_model_size = 0.01;  // metres
    if (sides.is_room()) {
        out.unit = unit_of_room(height);
        out.is_too_small = height < min_room_height && widest < min_room_height;
        return out;
    }
    // Furniture modelled in millimetres is a thousand units wide and, unlike a landscape, nearly as high.
    constexpr double max_model_width = 500, min_height_share = 0.3;
    const double narrowest = std::min({extent.x, extent.y, extent.z});
    if (widest > max_model_width && narrowest > min_height_share * widest) out.unit = "mm";
    out.is_too_small = widest < min_model_size;
    return out;
}

std::vector<Finding> findings_of(const ModelUnits& guess, const Scene& scene, bool unit_given, bool axis_given) {
    std::vector<Finding> out;
    const Vec3 size = scene.box().size();
    const std::string extent = fmt::format("the scene is {:.4g} x {:.4g} x {:.4g} m", size.x, size.y, size.z);
    const auto warn = [&](std::string message, std::string hint) {
        out.push_back({Finding::Kind::warning, scene.file(), 0, std::move(message), std::move(hint)});
    };
    const auto name = [&] {
        const std::string_view unit = guess.unit;
        return unit == "mm" ? "millimetres" : unit == "cm" ? "centimetres" : "inches";
    };
    if (guess.unit && !unit_given)
        warn(fmt::format("{}: in {}?", extent, name()),
             fmt::format("--length-unit {} reads it so; --length-unit m confirms metres", guess.unit));
    if (guess.is_too_small && !unit_given)
        warn(fmt::format("{}, which is small: in a larger unit than metres?", extent),
             "scale it where it was modelled; --length-unit m confirms metres");
    if (guess.y_is_up && !axis_given)
        warn("lamps, floors or an open top look as if Y were up; the scene is read with Z up",
             "--up y reads it so; --up z confirms Z");
    return out;
}

}  // namespace exitance
