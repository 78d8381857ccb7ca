#include <cmath>

#include "exitance/samples/families.hpp"
#include "exitance/samples/mersenne_twister.hpp"
#include "exitance/samples/room_parts.hpp"

// Closed rooms with light paths that are hard to find: only by reflection, through small openings, in gaps, or behind
// thousands of thin objects.

namespace exitance {

/// Emitters on shelves along two walls face up to the ceiling, hidden behind lips: all light in the room is reflected.
PolygonKit make_cove(const FamilyValues& v) {
    const double x = v.at("x"), y = v.at("y"), z = v.at("z"), deep = v.at("deep"), thick = v.at("thick");
    const double top = v.at("at") + thick, lip = v.at("lip"), lamp = v.at("lamp");
    PolygonKit kit("cove");
    kit.material("floor", v.at("floor"));
    kit.material("ceiling", v.at("ceiling"));
    kit.material("wall", v.at("wall"));
    kit.material("light", 0, 40);
    add_room(kit, {0, 0, 0}, {x, y, z}, "floor", "ceiling", "wall");
    const Point above{x / 2, y / 2, z}, below{x / 2, y / 2, 0};
    for (const double side : {1.0, -1.0}) {
        // `across` adds a strip along the shelf, from a to b metres inwards from the wall at x = `wall`.
        const double wall = side > 0 ? 0 : x;
        const auto across = [&](double a, double b, double height, const Point& seen, const char* material) {
            kit.facing(seen, material == std::string_view("light") ? "lamps" : "shelves", material,
                       {{wall + side * a, 0, height},
                        {wall + side * b, 0, height},
                        {wall + side * b, y, height},
                        {wall + side * a, y, height}});
        };
        const auto upright = [&](double at, double from, double to, double seen_x) {
            kit.facing({seen_x, y / 2, from}, "shelves", "wall",
                       {{wall + side * at, 0, from},
                        {wall + side * at, y, from},
                        {wall + side * at, y, to},
                        {wall + side * at, 0, to}});
        };
        constexpr double edge = 0.02;  // thickness of the lip, metres
        const double first = std::max(0.0, (deep - edge - lamp) / 2), last = std::min(deep - edge, first + lamp);
        across(0, deep, v.at("at"), below, "wall");
        if (first > 0) across(0, first, top, above, "wall");
        across(first, last, top, above, "light");
        if (last < deep - edge) across(last, deep - edge, top, above, "wall");
        upright(deep - edge, top, top + lip, wall);
        across(deep - edge, deep, top + lip, above, "wall");
        upright(deep, v.at("at"), top + lip, x / 2);
    }
    return kit;
}

/// An emitting window behind the slats of a blind.
PolygonKit make_blinds(const FamilyValues& v) {
    const auto slats = static_cast<int>(v.at("slats"));
    const double tilt = v.at("tilt") * pi / 180, deep = v.at("deep"), away = v.at("away");
    PolygonKit kit("blinds_" + in_a_name(v.at("slats")));
    add_materials(kit, 10);
    add_room(kit, {0, 0, 0}, {5, 4, 3}, "floor", "ceiling", "wall");
    constexpr double y0 = 1, y1 = 3, z0 = 0.9, z1 = 2.4, out = 0.001;
    kit.facing({2, 2, 1}, "window", "light", {{out, y0, z0}, {out, y1, z0}, {out, y1, z1}, {out, y0, z1}});
    for (int i = 0; i < slats; ++i) {
        const double z = z0 + (i + 0.5) / slats * (z1 - z0), dx = deep / 2 * std::cos(tilt),
                     dz = deep / 2 * std::sin(tilt);
        const Point a{away - dx, y0, z - dz}, b{away + dx, y0, z + dz}, c{away + dx, y1, z + dz},
            d{away - dx, y1, z - dz};
        kit.polygon("slats", "ceiling", {a, b, c, d});
        kit.polygon("slats", "ceiling", {d, c, b, a});
    }
    return kit;
}

/// Random thin triangles under a lamp.
PolygonKit make_clutter(const FamilyValues& v) {
    const auto n = static_cast<int>(v.at("n"));
    MersenneTwister random(static_cast<std::uint64_t>(v.at("seed")));
    PolygonKit kit("clutter_" + in_a_name(v.at("n")));
    add_materials(kit, 10);
    add_room(kit, {0, 0, 0}, {4, 4, 3}, "floor", "ceiling", "wall");
    add_lamp(kit, 2, 2, 2.9, 1.2, 1.2, 0.05);
    for (int i = 0; i < n; ++i) {
        const Point p{random.uniform(0.5, 3.5), random.uniform(0.5, 3.5), random.uniform(0.3, 2.4)};
        const Vec3 along = random_direction(random), other = random_direction(random);
        const double length = random.uniform(0.1, 0.4), width = v.at("thin") * length;
        add_sheet(kit, "clutter", "thing", p, p + length * along, p + 0.5 * length * along + width * other);
    }
    return kit;
}

/// A lamp just below a ceiling, a board just off a wall, and two boxes with a narrow gap.
PolygonKit make_gaps(const FamilyValues& v) {
    const double lamp = v.at("lamp"), board = v.at("board"), boxes = v.at("boxes");
    PolygonKit kit("gaps");
    add_materials(kit, 10);
    add_room(kit, {0, 0, 0}, {4, 3, 2.6}, "floor", "ceiling", "wall");
    constexpr double thick = 0.04;
    add_lamp(kit, 2, 1.5, 2.6 - lamp - thick, 1, 0.5, thick);
    kit.box("board", "thing", {board, 0.6, 0.9}, {board + 0.02, 2.4, 1.9});
    kit.box("boxes", "thing", {1.4, 1.2, 0}, {2 - boxes / 2, 1.9, 0.7}, PolygonKit::no_bottom);
    kit.box("boxes", "thing", {2 + boxes / 2, 1.2, 0}, {2.6, 1.8, 0.9}, PolygonKit::no_bottom);
    return kit;
}

/// Two rooms joined by a door; the only lamp is in the first room, a centimetre below its ceiling.
PolygonKit make_door(const FamilyValues& v) {
    const double width = v.at("width"), height = v.at("height"), x = v.at("x");
    constexpr double y = 4, z = 2.7, thick = 0.12;
    PolygonKit kit("door");
    add_materials(kit, 10);
    kit.horizontal("floor", "floor", 0, 0, x, y, 0);
    kit.horizontal("floor", "floor", x + thick, 0, 2 * x + thick, y, 0);
    const double y0 = 0.5 * (y - width), y1 = y0 + width;
    kit.horizontal("floor", "floor", x, y0, x + thick, y1, 0);
    for (const double from : {0.0, x + thick}) {
        kit.horizontal("ceiling", "ceiling", from, 0, from + x, y, z, false);
        const Point middle{from + x / 2, y / 2, z / 2};
        for (const double side : {0.0, y})
            kit.facing(middle, "walls", "wall",
                       {{from, side, 0}, {from + x, side, 0}, {from + x, side, z}, {from, side, z}});
        const double end = from > 0 ? from + x : 0, inner = from > 0 ? from : x;
        kit.facing(middle, "walls", "wall", {{end, 0, 0}, {end, y, 0}, {end, y, z}, {end, 0, z}});
        add_around(kit, "walls", "wall", {inner, 0, 0}, {0, 1, 0}, {0, 0, 1}, y, z, {y0, 0, y1, height}, middle);
    }
    const Point in_door{x + thick / 2, y / 2, height / 2};
    for (const double side : {y0, y1})
        kit.facing(in_door, "frame", "wall",
                   {{x, side, 0}, {x + thick, side, 0}, {x + thick, side, height}, {x, side, height}});
    kit.horizontal("frame", "wall", x, y0, x + thick, y1, height, false);
    add_lamp(kit, x / 2, y / 2, z - v.at("lamp") - 0.04, 0.6, 1.2, 0.04);
    return kit;
}

/// A lit box with a small hole in its wall, in a dark room.
PolygonKit make_keyhole(const FamilyValues& v) {
    const double hole = v.at("hole");
    constexpr double thick = 0.05;
    PolygonKit kit("keyhole");
    add_materials(kit, 20);
    add_room(kit, {0, 0, 0}, {5, 4, 3}, "floor", "ceiling", "wall");
    // The box has edges of 1 m and is in a corner of the room; its inside is smaller by the walls.
    const Point lo{0.5, 0.5, 0}, hi{1.5, 1.5, 1}, in_lo = lo + Vec3{thick, thick, thick},
                                                  in_hi = hi - Vec3{thick, thick, thick};
    kit.box("box", "thing", lo, hi, {false, true, 0b1101});
    const Point outside{3, 1, 0.5}, inside{1, 1, 0.5};
    const double from = 0.5 - hole / 2, to = 0.5 + hole / 2;
    add_around(kit, "box", "thing", {hi.x, lo.y, lo.z}, {0, 1, 0}, {0, 0, 1}, 1, 1, {from, from, to, to}, outside);
    const double inner = 1 - 2 * thick;
    add_around(kit, "inside", "wall", {in_hi.x, in_lo.y, in_lo.z}, {0, 1, 0}, {0, 0, 1}, inner, inner,
               {from - thick, from - thick, to - thick, to - thick}, inside);
    kit.horizontal("inside", "wall", in_lo.x, in_lo.y, in_hi.x, in_hi.y, in_lo.z);
    kit.horizontal("inside", "light", in_lo.x, in_lo.y, in_hi.x, in_hi.y, in_hi.z, false);
    kit.facing(inside, "inside", "wall",
               {{in_lo.x, in_lo.y, in_lo.z},
                {in_lo.x, in_hi.y, in_lo.z},
                {in_lo.x, in_hi.y, in_hi.z},
                {in_lo.x, in_lo.y, in_hi.z}});
    for (const double side : {in_lo.y, in_hi.y})
        kit.facing(
            inside, "inside", "wall",
            {{in_lo.x, side, in_lo.z}, {in_hi.x, side, in_lo.z}, {in_hi.x, side, in_hi.z}, {in_lo.x, side, in_hi.z}});
    // The four side walls of the hole.
    const double y0 = lo.y + from, y1 = lo.y + to;
    const Point in_hole{hi.x - thick / 2, 1, 0.5};
    for (const double side : {y0, y1})
        kit.facing(in_hole, "hole", "thing",
                   {{in_hi.x, side, from}, {hi.x, side, from}, {hi.x, side, to}, {in_hi.x, side, to}});
    for (const double side : {from, to})
        kit.facing(in_hole, "hole", "thing",
                   {{in_hi.x, y0, side}, {hi.x, y0, side}, {hi.x, y1, side}, {in_hi.x, y1, side}});
    return kit;
}

/// A furnished room with one high reflectance: light is reflected about a hundred times.
PolygonKit make_bright(const FamilyValues& v) {
    PolygonKit kit("bright_r" + in_a_name(v.at("rho")));
    for (const char* name : {"floor", "ceiling", "wall", "thing"}) kit.material(name, v.at("rho"));
    kit.material("light", 0, 10);
    add_room(kit, {0, 0, 0}, {5, 4, 3}, "floor", "ceiling", "wall");
    add_lamp(kit, 2.5, 2, 2.6, 1, 0.4, 0.06);
    kit.box("boxes", "thing", {-0.4, -0.3, 0}, {0.4, 0.3, 1.2}, PolygonKit::no_bottom, Placement::at(1.4, 1.2, 0, 25));
    kit.box("boxes", "thing", {-0.8, -0.45, 0}, {0.8, 0.45, 0.72}, PolygonKit::no_bottom,
            Placement::at(3.4, 2.6, 0, -10));
    return kit;
}

/// Two-sided leaves at random positions in a ball above a trunk, under a lamp.
PolygonKit make_tree(const FamilyValues& v) {
    const auto leaves = static_cast<int>(v.at("leaves"));
    MersenneTwister random(static_cast<std::uint64_t>(v.at("seed")));
    PolygonKit kit("tree_" + in_a_name(v.at("leaves")));
    add_materials(kit, 20);
    kit.material("leaf", PolygonKit::Colour{0.2, 0.45, 0.1});
    add_room(kit, {0, 0, 0}, {6, 6, 5}, "floor", "ceiling", "wall");
    add_lamp(kit, 3, 3, 4.8, 1, 1, 0.06);
    kit.box("trunk", "thing", {2.9, 2.9, 0}, {3.1, 3.1, 1.6}, PolygonKit::no_bottom);
    const double size = v.at("size");
    for (int i = 0; i < leaves; ++i) {
        const double r = 1.3 * std::cbrt(random.uniform(0, 1));
        const Point p = Point{3, 3, 2.6} + r * random_direction(random);
        const Vec3 a = random_direction(random), b = random_direction(random);
        add_sheet(kit, "leaves", "leaf", p, p + size * a, p + size * b);
    }
    return kit;
}

/// A shaft into a room, lit at its top.
PolygonKit make_lightwell(const FamilyValues& v) {
    const double width = v.at("width"), length = v.at("length");
    constexpr double x = 5, y = 4, z = 2.8;
    PolygonKit kit("lightwell");
    add_materials(kit, 10);
    kit.horizontal("floor", "floor", 0, 0, x, y, 0);
    const Point middle{x / 2, y / 2, z / 2};
    for (const double side : {0.0, y})
        kit.facing(middle, "walls", "wall", {{0, side, 0}, {x, side, 0}, {x, side, z}, {0, side, z}});
    for (const double side : {0.0, x})
        kit.facing(middle, "walls", "wall", {{side, 0, 0}, {side, y, 0}, {side, y, z}, {side, 0, z}});
    const double x0 = (x - width) / 2, x1 = x0 + width, y0 = (y - width) / 2, y1 = y0 + width, top = z + length;
    add_around(kit, "ceiling", "ceiling", {0, 0, z}, {1, 0, 0}, {0, 1, 0}, x, y, {x0, y0, x1, y1}, middle);
    const Point in_shaft{x / 2, y / 2, z + length / 2};
    for (const double side : {y0, y1})
        kit.facing(in_shaft, "shaft", "wall", {{x0, side, z}, {x1, side, z}, {x1, side, top}, {x0, side, top}});
    for (const double side : {x0, x1})
        kit.facing(in_shaft, "shaft", "wall", {{side, y0, z}, {side, y1, z}, {side, y1, top}, {side, y0, top}});
    kit.horizontal("sky", "light", x0, y0, x1, y1, top, false);
    return kit;
}

}  // namespace exitance
