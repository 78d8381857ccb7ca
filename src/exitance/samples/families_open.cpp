#include <array>
#include <cmath>

#include "exitance/samples/families.hpp"
#include "exitance/samples/furniture.hpp"

namespace exitance {
namespace {

std::string name_with_lights(const char* family, const FamilyValues& values) {
    const int lights = static_cast<int>(values.at("lights"));
    return lights == 1 ? family : family + std::string("_l") + std::to_string(lights);
}

/// Adds square lights that face down; their total power does not depend on their number.
void add_lights(PolygonKit& kit, const FamilyValues& values, double z, double size, double spread) {
    static const std::array<std::vector<Vec2>, 4> places = {{{{0, 0}},
                                                             {{-1, 0.2}, {1, -0.2}},
                                                             {{-1, -0.6}, {1, -0.6}, {0.1, 1}},
                                                             {{-1, -1}, {1, -0.9}, {1.1, 1}, {-0.9, 1.1}}}};
    const auto& chosen = places[static_cast<std::size_t>(values.at("lights")) - 1];
    kit.material("light", 0, 20 / static_cast<double>(chosen.size()));
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const double x = chosen[i].x * spread, y = chosen[i].y * spread;
        kit.horizontal("light" + std::to_string(i), "light", x - size / 2, y - size / 2, x + size / 2, y + size / 2, z,
                       false);
    }
}

void add_floor(PolygonKit& kit, double half_width) {
    kit.horizontal("floor", "floor", -half_width, -half_width, half_width, half_width, 0);
}

}  // namespace

PolygonKit make_flat(const FamilyValues& values) {
    PolygonKit kit(name_with_lights("flat", values));
    kit.material("receiver", 0.5);
    kit.horizontal("receiver", "receiver", -1.5, -1.5, 1.5, 1.5, 0);
    add_lights(kit, values, 1.2, 0.8, 0.6);
    return kit;
}

PolygonKit make_boxes(const FamilyValues& values) {
    PolygonKit kit(name_with_lights("boxes", values));
    kit.material("floor", 0.6);
    kit.material("low", {0.6, 0.4, 0.25});
    kit.material("high", {0.3, 0.45, 0.6});
    add_floor(kit, 2.5);
    kit.box("low", "low", {-0.7, -0.5, 0}, {0.7, 0.5, 0.4}, PolygonKit::all, Placement::at(0.25, 0.1, 0.3, 20));
    kit.box("high", "high", {-0.45, -0.35, 0}, {0.45, 0.35, 0.35}, PolygonKit::all,
            Placement::at(-0.35, -0.15, 1.25, -25));
    add_lights(kit, values, 3.0, 0.5, 0.9);
    return kit;
}

PolygonKit make_table(const FamilyValues& values) {
    PolygonKit kit(name_with_lights("table", values));
    kit.material("floor", 0.5);
    kit.material("wood", {0.55, 0.38, 0.22});
    add_floor(kit, 2);
    add_table32(kit, "table", "wood", Placement::at(0.05, -0.1, 0, 15));
    add_lights(kit, values, 2.2, 0.5, 0.8);
    return kit;
}

PolygonKit make_chair(const FamilyValues& values) {
    PolygonKit kit(name_with_lights("chair", values));
    kit.material("floor", 0.5);
    kit.material("wood", {0.50, 0.36, 0.22});
    kit.material("cushion", {0.20, 0.35, 0.60});
    add_floor(kit, 1.5);
    add_chair63(kit, "chair", "wood", Placement::at(0, 0.05, 0, 25));
    add_lights(kit, values, 2.2, 0.4, 0.7);
    return kit;
}

PolygonKit make_float(const FamilyValues& values) {
    PolygonKit kit(name_with_lights("float", values));
    kit.material("floor", 0.5);
    kit.material("wood", {0.55, 0.38, 0.22});
    kit.material("blue", {0.20, 0.35, 0.60});
    kit.material("red", {0.60, 0.22, 0.18});
    add_floor(kit, 2.5);
    add_table32(kit, "table", "wood", {});
    const std::array<Vec3, 4> chairs = {{{-0.35, -0.75, 4},
                                         {0.38, -0.80, -7},
                                         {-0.40, 0.78, 176},
                                         {0.36, 0.74, 185}}};  // x and y in metres, turned by z degrees
    for (std::size_t i = 0; i < chairs.size(); ++i)
        add_chair36(kit, "chair" + std::to_string(i), "blue", Placement::at(chairs[i].x, chairs[i].y, 0, chairs[i].z));
    add_chair36(kit, "chair_float", "red", Placement::at(0.1, 0.05, 1.15, 33));
    add_lights(kit, values, 3.2, 0.5, 0.9);
    return kit;
}

PolygonKit make_spiral(const FamilyValues& values) {
    const int steps = static_cast<int>(values.at("steps")), sides = static_cast<int>(values.at("sides"));
    PolygonKit kit(steps == 16 ? "spiral" : "spiral_n" + std::to_string(steps));
    kit.material("floor", {0.35, 0.33, 0.30});
    kit.material("wall", 0.6);
    kit.material("column", 0.7);
    kit.material("step", {0.50, 0.38, 0.26});
    const double rise = 0.19, column = 0.15, inner = column + 0.001, outer = 1.05, top = rise * (steps + 1);
    add_floor(kit, 2);
    kit.facing({0, 0, top / 2}, "wall", "wall", {{-2, 2, 0}, {2, 2, 0}, {2, 2, top + 1}, {-2, 2, top + 1}});
    std::vector<Point> base, cap;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * pi * i / sides;
        base.push_back({column * std::cos(angle), column * std::sin(angle), 0});
        cap.push_back({base.back().x, base.back().y, top + 0.3});
    }
    kit.prism("column", "column", base, cap, PolygonKit::no_bottom);
    const double wedge = pi / 6;
    for (int i = 0; i < steps; ++i) {
        const double from = i * wedge * 0.8, to = from + wedge, z1 = rise * (i + 1), z0 = z1 - 0.05;
        std::vector<Point> lower, upper;
        for (const auto& [radius, angle] : {Vec2{inner, from}, Vec2{outer, from}, Vec2{outer, to}, Vec2{inner, to}}) {
            lower.push_back({radius * std::cos(angle), radius * std::sin(angle), z0});
            upper.push_back({lower.back().x, lower.back().y, z1});
        }
        kit.prism("step" + std::to_string(i), "step", lower, upper);
    }
    kit.material("light", 0, 25);
    kit.horizontal("light", "light", 0.9 - 0.3, -0.6 - 0.3, 0.9 + 0.3, -0.6 + 0.3, top + 1.0, false);
    return kit;
}

}  // namespace exitance
