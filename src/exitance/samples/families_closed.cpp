#include <algorithm>
#include <cmath>
#include <cstdio>

#include "exitance/samples/families.hpp"
#include "exitance/samples/furniture.hpp"

namespace exitance {

std::string in_a_name(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    std::string out = text;
    std::replace(out.begin(), out.end(), '.', 'p');
    return out;
}

/// A source over a receiver with a blocker in between: all black, so that the light has an analytic solution.
PolygonKit make_blocker(const FamilyValues& values) {
    const double h = values.at("h");
    PolygonKit kit("blocker_h" + in_a_name(h));
    kit.material("black", 0);
    kit.material("light", 0, 10);
    kit.horizontal("receiver", "black", -2, -2, 2, 2, 0);
    kit.horizontal("blocker", "black", -0.5, -0.5, 0.5, 0.5, h);
    kit.horizontal("source", "light", -0.75, -0.75, 0.75, 0.75, 2, false);
    return kit;
}

PolygonKit make_tube(const FamilyValues& values) {
    const double rho = values.at("rho"), length = values.at("length");
    PolygonKit kit("tube_r" + in_a_name(rho));
    kit.material("light", 0, 10);
    kit.material("wall", rho);
    const Point c{length / 2, 0.5, 0.5};
    kit.facing(c, "light", "light", {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
    kit.facing(c, "end", "wall", {{length, 0, 0}, {length, 1, 0}, {length, 1, 1}, {length, 0, 1}});
    kit.facing(c, "floor", "wall", {{0, 0, 0}, {length, 0, 0}, {length, 1, 0}, {0, 1, 0}});
    kit.facing(c, "ceiling", "wall", {{0, 0, 1}, {length, 0, 1}, {length, 1, 1}, {0, 1, 1}});
    kit.facing(c, "side0", "wall", {{0, 0, 0}, {length, 0, 0}, {length, 0, 1}, {0, 0, 1}});
    kit.facing(c, "side1", "wall", {{0, 1, 0}, {length, 1, 0}, {length, 1, 1}, {0, 1, 1}});
    return kit;
}

/// Every face emits 1 W/m^2 and reflects rho: B = E = 1 / (1 - rho) everywhere.
PolygonKit make_furnace(const FamilyValues& values) {
    const double rho = values.at("rho");
    PolygonKit kit("furnace_r" + in_a_name(rho));
    kit.material("furnace", rho, 1 / pi);
    const Point c{1.5, 1, 1.25};
    const std::vector<Point> base = {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}};
    std::vector<Point> top = base;
    for (Point& p : top) p.z = 2.5;
    kit.facing(c, "room", "furnace", base);
    kit.facing(c, "room", "furnace", top);
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t j = (i + 1) % 4;
        kit.facing(c, "room", "furnace", {base[i], base[j], top[j], top[i]});
    }
    if (values.at("inner") != 0)
        kit.box("box", "furnace", {-0.5, -0.3, 0}, {0.5, 0.3, 0.7}, PolygonKit::all, Placement::at(1.4, 1, 0.6, 30));
    return kit;
}

namespace {

/// Returns positions for m chairs on a triangular lattice in the triangle of the given corners; surplus positions are
/// omitted at even intervals.
std::vector<Vec2> lattice(std::size_t m, const std::array<Vec2, 3>& corner) {
    std::size_t rows = 1;
    while (rows * (rows + 1) / 2 < m) ++rows;
    std::vector<Vec2> places;
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t column = 0; column <= row; ++column) {
            if (rows == 1) return {{0, 0}};
            const double f = static_cast<double>(row) / static_cast<double>(rows - 1);
            const double u = row > 0 ? static_cast<double>(column) / static_cast<double>(row) : 0.5;
            const Vec2 a = corner[0] + f * (corner[1] - corner[0]), b = corner[0] + f * (corner[2] - corner[0]);
            places.push_back(a + u * (b - a));
        }
    const std::size_t surplus = places.size() - m;
    std::vector<char> dropped(places.size(), 0);
    for (std::size_t i = 0; i < surplus; ++i)
        dropped[static_cast<std::size_t>((static_cast<double>(i) + 0.5) * static_cast<double>(places.size()) /
                                         static_cast<double>(surplus))] = 1;
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (!dropped[i]) out.push_back(places[i]);
    return out;
}

}  // namespace

/// m chairs in a closed triangular room with walls leaning inwards under a triangular light. The room's size grows with
/// sqrt(m), its area with m.
PolygonKit make_complex(const FamilyValues& values) {
    const int m = static_cast<int>(values.at("m"));
    PolygonKit kit("complex_m" + std::to_string(m));
    kit.material("floor", {0.30, 0.28, 0.25});
    kit.material("wall", {0.60, 0.60, 0.55});
    kit.material("light", 0, 12);
    kit.material("chair0", {0.55, 0.35, 0.20});
    kit.material("chair1", {0.25, 0.40, 0.55});
    kit.material("chair2", {0.50, 0.50, 0.45});
    constexpr int whole_room = 36;  // number of chairs for which an unscaled room is designed
    const double k = std::sqrt(values.at("scaled") > 0 ? m : std::max(m, whole_room)), outer = 2.4 * k, inner = 0.7 * k,
                 height = 2.4 * k;
    // Circumradius of the triangle of chairs, which keeps a distance from the walls.
    const double chairs = 2 * (outer / 2 - 0.75);
    std::vector<Point> floor, ceiling;
    std::array<Vec2, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) {
        const double angle = (90 + 120.0 * static_cast<double>(i)) * pi / 180;
        floor.push_back({outer * std::cos(angle), outer * std::sin(angle), 0});
        ceiling.push_back({inner * std::cos(angle), inner * std::sin(angle), height});
        corner[i] = {chairs * std::cos(angle), chairs * std::sin(angle)};
    }
    const Point c{0, 0, height / 2};
    kit.facing(c, "floor", "floor", floor);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        kit.facing(c, "wall" + std::to_string(i), "wall", {floor[i], floor[j], ceiling[j], ceiling[i]});
    }
    kit.facing(c, "light", "light", ceiling);
    MersenneTwister random(1000 + static_cast<std::uint64_t>(m));
    const std::vector<Vec2> places = lattice(static_cast<std::size_t>(m), corner);
    for (std::size_t i = 0; i < places.size(); ++i)
        add_chair27(kit, "chair_" + std::to_string(i), "chair" + std::to_string(i % 3),
                    Placement::at(places[i].x, places[i].y, 0, 12.5 + random.uniform(0, 360)));
    return kit;
}

namespace {

PolygonKit gcr(const char* name) {
    PolygonKit kit(name);
    kit.material("floor", {0.4, 0.5, 0.4});
    kit.material("wall", {0.6, 0.5, 0.5});
    kit.material("light", 0, 15);
    kit.horizontal("floor", "floor", 0, 0, 2, 2, 0);
    kit.polygon("wall", "wall", {{0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2}});
    kit.horizontal("light", "light", 0.8, 0.8, 1.2, 1.2, 2, false);
    return kit;
}

}  // namespace

PolygonKit make_gcr1(const FamilyValues&) {
    return gcr("gcr1");
}

PolygonKit make_gcr2(const FamilyValues&) {
    PolygonKit kit = gcr("gcr2");
    kit.material("blocker", 0.4);
    kit.polygon("blocker0", "blocker", {{0.35, 0.9, 1.55}, {1.05, 0.9, 1.55}, {1.05, 1.5, 1.55}, {0.35, 1.5, 1.55}});
    kit.polygon("blocker1", "blocker",
                {{1.35, 0.55, 1.35}, {1.75, 0.75, 1.35}, {1.55, 1.25, 1.35}, {1.15, 1.05, 1.35}});
    return kit;
}

/// The measured Cornell box. The corners of the red wall, which are not coplanar as measured, are moved to a plane. The
/// ceiling has a hole for the light, which is in its plane.
PolygonKit make_cornell(const FamilyValues&) {
    PolygonKit kit("cornell");
    kit.material("white", {0.76, 0.75, 0.74});
    kit.material("red", {0.63, 0.06, 0.05});
    kit.material("green", {0.12, 0.45, 0.09});
    kit.material("light", {0.78, 0.78, 0.78}, {17, 12, 4});
    const auto metres = [](const Point& mm) { return Point{mm.x / 1000, (559.2 - mm.z) / 1000, mm.y / 1000}; };
    const Point middle = metres({278, 274, 279});
    const auto add = [&](const char* group, const char* material, std::vector<Point> outline) {
        std::transform(outline.begin(), outline.end(), outline.begin(), metres);
        kit.facing(middle, group, material, std::move(outline));
    };
    const double h = 548.8, d = 559.2;
    add("floor", "white", {{552.8, 0, 0}, {0, 0, 0}, {0, 0, d}, {552.8, 0, d}});
    add("ceiling", "white",
        {{0, h, 0},
         {213, h, 0},
         {213, h, 227},
         {213, h, 332},
         {343, h, 332},
         {343, h, 227},
         {343, h, 0},
         {556, h, 0},
         {556, h, d},
         {0, h, d}});
    add("ceiling", "white", {{213, h, 0}, {343, h, 0}, {343, h, 227}, {213, h, 227}});
    add("back", "white", {{552.8, 0, d}, {0, 0, d}, {0, h, d}, {556, h, d}});
    add("right", "green", {{0, 0, d}, {0, 0, 0}, {0, h, 0}, {0, h, d}});
    add("left", "red", {{552.8, 0, 0}, {552.8, 0, d}, {556, h, d}, {556, h, 0}});
    add("light", "light", {{343, h, 227}, {343, h, 332}, {213, h, 332}, {213, h, 227}});
    const auto block = [&](const char* group, double height, std::initializer_list<Vec2> outline) {
        std::vector<Point> base, top;
        for (const auto& [x, z] : outline) base.push_back(metres({x, 0, z})), top.push_back(metres({x, height, z}));
        if (area_vector(base).z < 0) std::reverse(base.begin(), base.end()), std::reverse(top.begin(), top.end());
        kit.prism(group, "white", base, top, PolygonKit::no_bottom);
    };
    block("short_block", 165, {{130, 65}, {82, 225}, {240, 272}, {290, 114}});
    block("tall_block", 330, {{423, 247}, {265, 296}, {314, 456}, {472, 406}});
    return kit;
}

}  // namespace exitance
