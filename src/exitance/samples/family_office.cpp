#include <fmt/format.h>

#include <array>
#include <functional>

#include "exitance/samples/families.hpp"
#include "exitance/samples/furniture.hpp"

namespace exitance {
namespace {

constexpr double room = 4.0;    // width and depth of a room, metres
constexpr double height = 2.8;  // height of the ceiling, metres
constexpr double half_wall = 0.06;
constexpr double door_from = 0.45, door_width = 0.9, door_height = 2.1;

/// Maps wall coordinates to a point: u along the wall, v out of it, z up.
using WallMap = std::function<Point(double u, double v, double z)>;

/// Joins a name and numbers by underscores: "room_2_0".
template <class... Ints>
std::string numbered(const std::string& what, Ints... numbers) {
    std::string out = what;
    ((out += fmt::format("_{}", numbers)), ...);
    return out;
}

void add_room(PolygonKit& kit, int i, int j) {
    const double x0 = i * room, y0 = j * room;
    const std::string name = numbered("room", i, j);
    kit.horizontal(name + "_floor", "floor", x0, y0, x0 + room, y0 + room, 0);
    kit.horizontal(name + "_ceiling", "ceiling", x0, y0, x0 + room, y0 + room, height, false);
    for (double a : {0.27, 0.73})
        for (double b : {0.27, 0.73}) {
            const double cx = x0 + a * room, cy = y0 + b * room, z = height - 0.06;
            kit.box(name + "_lum", "housing", {cx - 0.6, cy - 0.075, z}, {cx + 0.6, cy + 0.075, height},
                    PolygonKit::only_sides);
            kit.horizontal(name + "_lum", "luminaire", cx - 0.6, cy - 0.075, cx + 0.6, cy + 0.075, z, false);
        }
}

/// Adds the outer wall of one room around an emitting window panel.
void add_bay(PolygonKit& kit, const std::string& group, const WallMap& wall, const Point& inside) {
    const double a0 = 0.9, a1 = 3.1, z0 = 0.95, z1 = 2.15;
    const auto add = [&](const char* material, std::initializer_list<Vec2> outline) {
        std::vector<Point> points;
        for (const auto& [u, z] : outline) points.push_back(wall(u, 0, z));
        kit.facing(inside, group, material, std::move(points));
    };
    add("wall", {{0, 0}, {room, 0}, {room, z0}, {a1, z0}, {a0, z0}, {0, z0}});
    add("wall", {{0, z1}, {a0, z1}, {a1, z1}, {room, z1}, {room, height}, {0, height}});
    add("wall", {{0, z0}, {a0, z0}, {a0, z1}, {0, z1}});
    add("wall", {{a1, z0}, {room, z0}, {room, z1}, {a1, z1}});
    add("window", {{a0, z0}, {a1, z0}, {a1, z1}, {a0, z1}});
}

/// Adds an inner wall from u0 to u1 with a door opening: both faces are concave outlines, and the opening has jambs.
void add_inner_wall(PolygonKit& kit, const std::string& group, const WallMap& wall, double u0, double u1) {
    const double a = door_from, b = door_from + door_width, t = half_wall, top = door_height;
    for (double v : {t, -t}) {
        std::vector<Point> outline;
        for (const auto& [u, z] : {Vec2{u0, 0}, Vec2{a, 0}, Vec2{a, top}, Vec2{b, top}, Vec2{b, 0}, Vec2{u1, 0},
                                   Vec2{u1, height}, Vec2{u0, height}})
            outline.push_back(wall(u, v, z));
        kit.facing(wall(2, v > 0 ? 1 : -1, 1), group, "wall", std::move(outline));
    }
    const Point c = wall((a + b) / 2, 0, 1);
    kit.facing(c, group, "wall", {wall(a, -t, 0), wall(a, t, 0), wall(a, t, top), wall(a, -t, top)});
    kit.facing(c, group, "wall", {wall(b, -t, 0), wall(b, t, 0), wall(b, t, top), wall(b, -t, top)});
    kit.facing(c, group, "wall", {wall(a, -t, top), wall(a, t, top), wall(b, t, top), wall(b, -t, top)});
}

void add_walls(PolygonKit& kit, int nx, int ny) {
    const double X = nx * room, Y = ny * room;
    const Point inside{X / 2, Y / 2, 1};
    for (int i = 0; i < nx; ++i) {
        add_bay(
            kit, fmt::format("outer_s{}", i),
            [=](double u, double, double z) {
                return Point{i * room + u, 0, z};
            },
            inside);
        add_bay(
            kit, fmt::format("outer_n{}", i),
            [=](double u, double, double z) {
                return Point{i * room + u, Y, z};
            },
            inside);
    }
    for (int j = 0; j < ny; ++j) {
        add_bay(
            kit, fmt::format("outer_w{}", j),
            [=](double u, double, double z) {
                return Point{0, j * room + u, z};
            },
            inside);
        add_bay(
            kit, fmt::format("outer_e{}", j),
            [=](double u, double, double z) {
                return Point{X, j * room + u, z};
            },
            inside);
    }
    const auto first = [](int k) { return k == 0 ? 0 : half_wall; };  // start of a wall: at the facade or at a crossing
    const auto last = [](int k, int n) { return k == n - 1 ? room : room - half_wall; };
    for (int i = 1; i < nx; ++i)
        for (int j = 0; j < ny; ++j)
            add_inner_wall(
                kit, numbered(fmt::format("wall_x{}", i), j),
                [=](double u, double v, double z) {
                    return Point{i * room + v, j * room + u, z};
                },
                first(j), last(j, ny));
    for (int j = 1; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
            add_inner_wall(
                kit, numbered(fmt::format("wall_y{}", j), i),
                [=](double u, double v, double z) {
                    return Point{i * room + u, j * room + v, z};
                },
                first(i), last(i, nx));
}

void add_materials(PolygonKit& kit) {
    kit.material("floor", {0.22, 0.20, 0.18});
    kit.material("wall", {0.50, 0.50, 0.48});
    kit.material("ceiling", 0.80);
    kit.material("luminaire", {0.5, 0.5, 0.5}, {95, 90, 80});
    kit.material("housing", 0.7);
    kit.material("window", {0.08, 0.08, 0.08}, {22, 25, 30});
    kit.material("desk", {0.55, 0.42, 0.28});
    kit.material("shelf", {0.60, 0.58, 0.55});
    kit.material("screen", 0.05);
    kit.material("book0", {0.5, 0.1, 0.1});
    kit.material("book1", {0.1, 0.25, 0.5});
    kit.material("book2", {0.15, 0.4, 0.15});
    kit.material("book3", {0.6, 0.5, 0.2});
    kit.material("book4", {0.35, 0.3, 0.3});
    kit.material("seat0", {0.15, 0.15, 0.17});
    kit.material("seat1", {0.2, 0.3, 0.45});
}

}  // namespace

/// A closed office floor of nx by ny rooms; windows are emitting panels. 1e3 to 1e6 polygons.
PolygonKit make_office(const FamilyValues& values) {
    const auto value = [&](const char* name) { return static_cast<int>(values.at(name)); };
    const int nx = value("nx"), ny = value("ny"), places = value("nfurn"), books = value("books");
    PolygonKit kit(fmt::format("office_{}x{}x{}", nx, ny, places));
    add_materials(kit);
    for (int i = 0; i < nx; ++i)
        for (int j = 0; j < ny; ++j) add_room(kit, i, j);
    add_walls(kit, nx, ny);
    struct Spot {
        double x, y, degrees;
    };
    constexpr std::array<Spot, 4> spots = {{{1.35, 3.2, 180}, {3.1, 0.85, 0}, {3.1, 3.2, 180}, {2.05, 1.9, 90}}};
    const std::array<std::string, 5> book_materials = {"book0", "book1", "book2", "book3", "book4"};
    MersenneTwister random(static_cast<std::uint64_t>(values.at("seed")));
    for (int i = 0; i < nx; ++i)
        for (int j = 0; j < ny; ++j)
            for (int k = 0; k < places; ++k) {
                const Spot& spot = spots[static_cast<std::size_t>(k)];
                const double x = i * room + spot.x + random.uniform(-0.05, 0.05);
                const double y = j * room + spot.y + random.uniform(-0.05, 0.05);
                const Placement place = Placement::at(x, y, 0, spot.degrees);
                const std::string name = numbered("w", i, j, k);
                add_desk(kit, name, place);
                const double turned = random.uniform(-25, 25), aside = random.uniform(-0.1, 0.1);
                add_chair27(kit, name + "_chair", fmt::format("seat{}", (i + j + k) % 2),
                            place.after(Placement::at(aside, 0.56, 0, 180 + turned)));
                add_shelf(kit, name + "_shelf", place.after(Placement::at(0, -0.42, 0)), books, book_materials, random);
            }
    return kit;
}

}  // namespace exitance
