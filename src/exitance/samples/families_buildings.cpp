#include <algorithm>
#include <cmath>

#include "exitance/samples/families.hpp"
#include "exitance/samples/mersenne_twister.hpp"
#include "exitance/samples/room_parts.hpp"

// Parts of buildings: large spaces with thin, repeated or touching parts, in daylight or lamplight.

namespace exitance {
namespace {

/// A rectangle in the plane z = constant.
struct Plan {
    double x0, y0, x1, y1;
    Plan inset(double d) const { return {x0 + d, y0 + d, x1 - d, y1 - d}; }
};

/// Adds a horizontal ring between two rectangles.
void add_ring(PolygonKit& kit, const char* group, const char* material, const Plan& outer, const Plan& inner, double z,
              bool up) {
    add_around(kit, group, material, {outer.x0, outer.y0, z}, {1, 0, 0}, {0, 1, 0}, outer.x1 - outer.x0,
               outer.y1 - outer.y0,
               {inner.x0 - outer.x0, inner.y0 - outer.y0, inner.x1 - outer.x0, inner.y1 - outer.y0},
               {outer.x0, outer.y0, up ? z + 1 : z - 1});
}

/// Adds four upright faces along a rectangle, which face inwards or outwards.
void add_band(PolygonKit& kit, const char* group, const char* material, const Plan& p, double z0, double z1,
              bool inwards) {
    const std::array<Vec2, 4> corner = {Vec2{p.x0, p.y0}, {p.x1, p.y0}, {p.x1, p.y1}, {p.x0, p.y1}};
    const Point middle{(p.x0 + p.x1) / 2, (p.y0 + p.y1) / 2, z0};
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2 a = corner[i], b = corner[(i + 1) % 4];
        const Point seen = inwards ? middle : Point{a.x + b.x - middle.x, a.y + b.y - middle.y, z0};
        kit.facing(seen, group, material, {{a.x, a.y, z0}, {b.x, b.y, z0}, {b.x, b.y, z1}, {a.x, a.y, z1}});
    }
}

}  // namespace

/// A court of several floors below a roof light, with balconies and parapets around it.
PolygonKit make_atrium(const FamilyValues& v) {
    const auto floors = static_cast<int>(v.at("floors"));
    const double x = v.at("x"), y = v.at("y"), deep = v.at("deep"), parapet = v.at("parapet");
    constexpr double rise = 3.2, slab = 0.3, thick = 0.06;
    PolygonKit kit("atrium");
    add_materials(kit, 10);
    const Plan walls{0, 0, x, y};
    const double top = rise * (floors + 1);
    const Plan light = walls.inset(deep + 0.5);
    add_room(kit, {0, 0, 0}, {x, y, top}, "floor", "ceiling", "wall");
    kit.horizontal("roof light", "light", light.x0, light.y0, light.x1, light.y1, top - 0.01, false);
    const Plan edge = walls.inset(deep);
    for (int k = 1; k <= floors; ++k) {
        const double z = rise * k;
        const Plan inner = edge.inset(-thick);
        add_ring(kit, "balcony", "ceiling", walls, edge, z - slab, false);
        add_ring(kit, "balcony", "floor", walls, inner, z, true);
        add_band(kit, "balcony", "wall", edge, z - slab, z + parapet, true);
        add_ring(kit, "balcony", "wall", inner, edge, z + parapet, true);
        add_band(kit, "balcony", "wall", inner, z, z + parapet, false);
    }
    return kit;
}

/// A straight flight of treads between two strings, without risers, in a stairwell.
PolygonKit make_stair(const FamilyValues& v) {
    const auto steps = static_cast<int>(v.at("steps"));
    const double width = v.at("width"), thick = v.at("thick"), side = v.at("side");
    constexpr double rise = 0.18, going = 0.27, tread = 0.3, string = 0.25, string_thick = 0.04;
    PolygonKit kit("stair");
    add_materials(kit, 10);
    const double length = going * steps, height = rise * steps, room_width = width + 2 * side;
    add_room(kit, {0, 0, 0}, {length + 3, room_width, height + 2.6}, "floor", "ceiling", "wall");
    add_lamp(kit, length / 2 + 1.5, room_width / 2, height + 2.4, 0.8, 0.8, 0.05);
    for (int k = 1; k <= steps; ++k) {
        const double x = 1.2 + going * (k - 1), z = rise * k;
        kit.box("tread " + std::to_string(k), "thing", {x, side, z - thick}, {x + tread, side + width, z});
    }
    // The strings touch the ends of the treads and stand clear of the floor.
    const Vec3 across{0, string_thick, 0}, up{0, 0, string};
    for (const double y : {side - string_thick / 2, side + width + string_thick / 2})
        add_beam(kit, y < side ? "left string" : "right string", "wall", {1.2, y, rise - thick / 2},
                 {1.2 + length, y, rise * (steps + 1) - thick / 2}, across, up);
    return kit;
}

/// A row of round columns before a wall, below a roof slab, in the sun.
PolygonKit make_colonnade(const FamilyValues& v) {
    const auto columns = static_cast<int>(v.at("columns")), sides = static_cast<int>(v.at("sides"));
    const double radius = v.at("radius"), apart = v.at("apart");
    constexpr double height = 4, deep = 3, slab = 0.3;
    PolygonKit kit("colonnade");
    add_materials(kit, 1);
    const double length = apart * columns;
    kit.horizontal("ground", "floor", 0, -6, length, deep, 0);
    kit.facing({0, 0, 0}, "wall", "wall", {{0, deep, 0}, {length, deep, 0}, {length, deep, height}, {0, deep, height}});
    kit.box("roof", "ceiling", {0, -radius - 0.2, height}, {length, deep, height + slab});
    for (int k = 0; k < columns; ++k) {
        std::vector<Point> base, top;
        for (int i = 0; i < sides; ++i) {
            const double angle = 2 * pi * i / sides;
            base.push_back({apart * (k + 0.5) + radius * std::cos(angle), radius * std::sin(angle), 0});
            top.push_back({base.back().x, base.back().y, height});
        }
        kit.prism("column " + std::to_string(k + 1), "wall", base, top, PolygonKit::only_sides);
    }
    add_sun(kit, {length / 2, 0, 0}, 100, v.at("azimuth"), v.at("altitude"), 800);
    return kit;
}

/// A gabled frame of thin bars over a floor with beds, in the sun.
PolygonKit make_greenhouse(const FamilyValues& v) {
    const auto ribs = static_cast<int>(v.at("ribs")), purlins = static_cast<int>(v.at("purlins"));
    const double bar = v.at("bar"), length = v.at("length");
    constexpr double half = 1.6, eaves = 1.8, ridge = 2.8;
    PolygonKit kit("greenhouse");
    add_materials(kit, 1);
    kit.material("earth", PolygonKit::Colour{0.25, 0.2, 0.12});
    kit.horizontal("floor", "floor", -half - 1, -1, half + 1, length + 1, 0);
    for (const double side : {-1.0, 1.0})
        kit.box(side < 0 ? "left bed" : "right bed", "earth", {side * 1 - 0.45, 0.3, 0},
                {side * 1 + 0.45, length - 0.3, 0.5}, PolygonKit::no_bottom);
    const double slope = std::hypot(half, ridge - eaves);
    for (int k = 0; k < ribs; ++k) {
        const double y = ribs > 1 ? length * k / (ribs - 1) : length / 2;
        for (const double side : {-1.0, 1.0}) {
            kit.box("posts", "ceiling", {side * half - bar / 2, y - bar / 2, 0},
                    {side * half + bar / 2, y + bar / 2, eaves}, PolygonKit::no_bottom);
            const Vec3 normal{side * (ridge - eaves) / slope, 0, half / slope};
            // Rafters of different width, so that none of their faces coincide.
            const Vec3 along{0, (side < 0 ? 0.8 : 0.7) * bar, 0};
            add_beam(kit, "rafters", "ceiling", {side * half, y, eaves}, {0, y, ridge}, along, bar * normal);
        }
    }
    // Purlins lie on the rafters and touch them.
    for (const double side : {-1.0, 1.0})
        for (int k = 1; k <= purlins; ++k) {
            const double t = static_cast<double>(k) / (purlins + 1);
            const Vec3 normal{side * (ridge - eaves) / slope, 0, half / slope};
            const Vec3 down{side * half / slope, 0, -(ridge - eaves) / slope};
            const Point at = Point{side * half * t, 0, ridge + (eaves - ridge) * t} + bar * normal;
            add_beam(kit, "purlins", "ceiling", at, at + Vec3{0, length, 0}, bar * down, bar * normal);
        }
    add_sun(kit, {0, length / 2, 0}, 100, v.at("azimuth"), v.at("altitude"), 800);
    return kit;
}

/// Cupboards of boards that touch, with boxes that touch on and between them.
PolygonKit make_furniture(const FamilyValues& v) {
    const auto pieces = static_cast<int>(v.at("n"));
    MersenneTwister random(static_cast<std::uint64_t>(v.at("seed")));
    PolygonKit kit("furniture");
    add_materials(kit, 10);
    constexpr double y = 4, z = 2.7, board = 0.025, apart = 0.35;
    const double x = std::max(3.0, 1.4 * pieces + 0.6);
    add_room(kit, {0, 0, 0}, {x, y, z}, "floor", "ceiling", "wall");
    add_lamp(kit, x / 2, 1.4, 2.5, 1, 0.5, 0.05);
    for (int k = 0; k < pieces; ++k) {
        const std::string group = "cupboard " + std::to_string(k + 1);
        const double deep = random.uniform(0.3, 0.6), width = random.uniform(0.6, 1.2), x0 = 0.4 + 1.4 * k;
        const double y1 = y, y0 = y1 - deep;
        const std::uint32_t shelves = 2 + random.below(3);
        const double height = 0.05 + apart * shelves;
        kit.box(group, "thing", {x0, y0, 0}, {x0 + board, y1, height});
        kit.box(group, "thing", {x0 + width - board, y0, 0}, {x0 + width, y1, height});
        kit.box(group, "thing", {x0, y0, height}, {x0 + width, y1, height + board});
        for (std::uint32_t s = 0; s < shelves; ++s) {
            const double bottom = 0.05 + apart * s;
            kit.box(group, "thing", {x0 + board, y0, bottom}, {x0 + width - board, y1, bottom + board});
            // Boxes side by side, the first one against the side of the cupboard.
            double from = x0 + board;
            for (std::uint32_t left = random.below(4); left > 0; --left) {
                const double wide = random.uniform(0.08, 0.16), high = random.uniform(0.1, 0.28);
                kit.box(group + " boxes", "wall", {from, y0 + 0.05, bottom + board},
                        {from + wide, y1 - 0.02, bottom + board + high});
                from += wide;
            }
        }
    }
    return kit;
}

/// Flat roofs with black tops above a wide ground, in the sun or below a lamp. They have no posts.
PolygonKit make_canopy(const FamilyValues& v) {
    const auto roofs = static_cast<int>(v.at("roofs"));
    const double ground = v.at("ground"), size = v.at("size"), height = v.at("height");
    PolygonKit kit("canopy");
    kit.material("ground", 0.3);
    kit.material("roof", 0.7);
    kit.material("tar", 0);
    kit.horizontal("ground", "ground", -ground / 2, -ground / 2, ground / 2, ground / 2, 0);
    for (int k = 0; k < roofs; ++k) {
        const double x = 2.5 * size * (k - 0.5 * (roofs - 1));
        const std::string roof = "roof " + std::to_string(k + 1);
        const Point lo{x - size / 2, -size / 2, height}, hi{x + size / 2, size / 2, height + 0.1};
        kit.box(roof, "roof", lo, hi, {true, false, ~0u});
        kit.horizontal(roof, "tar", lo.x, lo.y, hi.x, hi.y, hi.z);
    }
    if (v.at("sun") > 0) {
        add_sun(kit, {0, 0, 0}, 4 * ground, v.at("azimuth"), v.at("altitude"), 800);
    } else {
        kit.material("light", 0, 100);
        kit.horizontal("lamp", "light", -size / 4, -2 * size, size / 4, -1.5 * size, 2 * height + 2, false);
    }
    return kit;
}

}  // namespace exitance
