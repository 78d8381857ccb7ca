#include "exitance/samples/furniture.hpp"

namespace exitance {
namespace {

using Faces = PolygonKit::Faces;
constexpr Faces apron_x{true, false, 0b0101};  // runs along x: bottom, front and back
constexpr Faces apron_y{true, false, 0b1010};  // board along y: its bottom and both sides
constexpr Faces board_x{true, true, 0b0101};
constexpr Faces board_y{true, true, 0b1010};
constexpr double signs[2] = {-1, 1};

void add_legs(PolygonKit& kit, std::string_view group, std::string_view material, double x, double y, double half_width,
              double height, const Placement& place) {
    for (double sx : signs)
        for (double sy : signs) {
            const double cx = sx * x, cy = sy * y;
            kit.box(group, material, {cx - half_width, cy - half_width, 0}, {cx + half_width, cy + half_width, height},
                    PolygonKit::only_sides, place);
        }
}

}  // namespace

void add_chair27(PolygonKit& kit, std::string_view group, std::string_view material, const Placement& place) {
    const double w = 0.21, h = 0.45, t = 0.04;
    kit.box(group, material, {-w, -w, h - t}, {w, w, h}, PolygonKit::all, place);
    kit.box(group, material, {-w + 0.01, -w + 0.01, h}, {w - 0.01, -w + 0.04, 0.90}, PolygonKit::no_bottom, place);
    add_legs(kit, group, material, w - 0.03, w - 0.03, 0.02, h - t, place);
}

void add_chair36(PolygonKit& kit, std::string_view group, std::string_view material, const Placement& place) {
    add_chair27(kit, group, material, place);
    const double w = 0.21, h = 0.45, t = 0.04, a = w - 0.05, b = w - 0.03, z0 = h - t - 0.05, z1 = h - t;
    kit.box(group, material, {-a, b - 0.01, z0}, {a, b + 0.01, z1}, apron_x, place);
    kit.box(group, material, {-b - 0.01, -a, z0}, {-b + 0.01, a, z1}, apron_y, place);
    kit.box(group, material, {b - 0.01, -a, z0}, {b + 0.01, a, z1}, apron_y, place);
}

void add_chair63(PolygonKit& kit, std::string_view group, std::string_view material, const Placement& place) {
    const double w = 0.23, h = 0.45, t = 0.04, b = w - 0.03;
    kit.box(group, material, {-w, -w, h - t}, {w, w, h}, PolygonKit::all, place);
    add_legs(kit, group, material, b, b, 0.02, h - t, place);
    for (double sx : signs)
        kit.box(group, material, {sx * b - 0.018, -b - 0.018, h}, {sx * b + 0.018, -b + 0.018, 1},
                PolygonKit::no_bottom, place);
    kit.box(group, "cushion", {-w + 0.07, -w + 0.07, h}, {w - 0.03, w - 0.03, h + 0.04}, PolygonKit::no_bottom, place);
    for (double z : {0.58, 0.72, 0.86})
        kit.box(group, material, {-b + 0.018, -b - 0.008, z}, {b - 0.018, -b + 0.008, z + 0.07}, board_x, place);
    for (double sy : signs)
        kit.box(group, material, {-b + 0.02, sy * b - 0.01, h - t - 0.05}, {b - 0.02, sy * b + 0.01, h - t}, apron_x,
                place);
    for (double sx : signs)
        kit.box(group, material, {sx * b - 0.01, -b + 0.02, 0.16}, {sx * b + 0.01, b - 0.02, 0.19}, board_y, place);
}

void add_table32(PolygonKit& kit, std::string_view group, std::string_view material, const Placement& place) {
    const double w = 0.80, d = 0.45, h = 0.74, t = 0.04, x = w - 0.07, y = d - 0.07;
    kit.box(group, material, {-w, -d, h - t}, {w, d, h}, PolygonKit::all, place);
    add_legs(kit, group, material, x, y, 0.03, h - t, place);
    for (double sy : signs)
        kit.box(group, material, {-w + 0.10, sy * y - 0.01, h - t - 0.08}, {w - 0.10, sy * y + 0.01, h - t}, apron_x,
                place);
    kit.box(group, material, {-x - 0.015, -d + 0.10, 0.12}, {-x + 0.015, d - 0.10, 0.15}, board_y, place);
}

void add_desk(PolygonKit& kit, const std::string& group, const Placement& place) {
    const std::string desk = group + "_desk", monitor = group + "_monitor";
    kit.box(desk, "desk", {-0.62, -0.33, 0.70}, {0.62, 0.33, 0.73}, PolygonKit::all, place);
    kit.box(desk, "desk", {-0.58, -0.30, 0}, {-0.55, 0.30, 0.70}, PolygonKit::only_sides, place);
    kit.box(desk, "desk", {0.55, -0.30, 0}, {0.58, 0.30, 0.70}, PolygonKit::only_sides, place);
    kit.box(desk, "desk", {-0.55, -0.25, 0.30}, {0.55, -0.23, 0.70}, apron_x, place);
    kit.polygon(
        desk, "screen",
        {place({-0.2, 0.05, 0.731}), place({0.2, 0.05, 0.731}), place({0.2, 0.2, 0.731}), place({-0.2, 0.2, 0.731})});
    kit.box(monitor, "screen", {-0.1, -0.2, 0.73}, {0.1, -0.08, 0.75}, PolygonKit::no_bottom, place);
    kit.box(monitor, "screen", {-0.28, -0.15, 0.80}, {0.28, -0.13, 1.14}, PolygonKit::all, place);
}

void add_shelf(PolygonKit& kit, const std::string& group, const Placement& place, int books,
               std::span<const std::string> book_materials, MersenneTwister& random) {
    constexpr int boards = 4;
    const double w = 0.6, d = 0.11, h = 1.15, thickness = 0.02;
    const auto board_height = [&](int i) { return 0.05 + i * (h - 0.09) / boards; };
    kit.box(group, "shelf", {-w, -d, 0}, {-w + thickness, d, h}, PolygonKit::no_bottom, place);
    kit.box(group, "shelf", {w - thickness, -d, 0}, {w, d, h}, PolygonKit::no_bottom, place);
    for (int i = 0; i < boards; ++i) {
        const double z = board_height(i);
        kit.box(group, "shelf", {-w + thickness, -d, z}, {w - thickness, d, z + thickness}, board_x, place);
    }
    const double pitch = (2 * w - 0.06) / std::max(books, 1);
    for (int i = 0; i < boards; ++i) {
        const double z = board_height(i) + thickness;
        double x = -w + 0.03;
        for (int b = 0; b < books; ++b, x += pitch) {
            const double width = pitch * random.uniform(0.55, 0.95);
            const double depth = random.uniform(0.14, 0.19), height = random.uniform(0.14, 0.215);
            const std::string& material =
                book_materials[random.below(static_cast<std::uint32_t>(book_materials.size()))];
            kit.box(group + "_books", material, {x, -d + 0.005, z}, {x + width, -d + depth, z + height},
                    PolygonKit::no_bottom, place);
        }
    }
}

}  // namespace exitance
