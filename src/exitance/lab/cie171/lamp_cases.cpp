#include <fmt/format.h>

#include <cmath>

#include "exitance/io/photometry/photometry.hpp"
#include "exitance/io/photometry/placed_luminaire.hpp"
#include "exitance/lab/cie171/cases.hpp"
#include "exitance/lab/cie171/cube_table.hpp"
#include "exitance/samples/polygon_kit.hpp"

namespace exitance {
namespace {

using Case = Cie171Case;

constexpr std::array<double, 6> heights{2.75, 2.25, 1.75, 1.25, 0.75, 0.25};
constexpr std::array<double, 8> depths{0.25, 0.75, 1.25, 1.75, 2.25, 2.75, 3.25, 3.75};

void add_point(Case& c, const Point& x, const Normal& n, double exact, std::string name = "") {
    c.names.push_back(name.empty() ? std::string(1, static_cast<char>('A' + c.points.size())) : std::move(name));
    c.points.push_back({x, n}), c.exact.push_back(exact);
}

/// Configuration factor of a rectangle parallel to the plane of x with a corner above x. a, b: its sides divided by its
/// height.
double parallel_corner(double a, double b) {
    const double p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
    return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2 * pi);
}

/// Configuration factor of a rectangle perpendicular to the plane of x: from the plane up to b, and along it from 0 to
/// a, at a distance of 1.
double upright_corner(double a, double b) {
    const double q = std::sqrt(1 + b * b);
    return (std::atan(a) - std::atan(a / q) / q) / (2 * pi);
}

/// Configuration factor of a rectangle x0..x1 by y0..y1 at a height above a point, parallel to its plane.
double parallel_factor(double x0, double x1, double y0, double y1, double height) {
    const auto corner = [&](double x, double y) {
        return std::copysign(1.0, x * y) * parallel_corner(std::abs(x) / height, std::abs(y) / height);
    };
    return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
}

/// Configuration factor of a rectangle perpendicular to the plane of a point, at `distance` from it along the plane:
/// x0..x1 along the plane and h0..h1 above it.
double upright_factor(double x0, double x1, double h0, double h1, double distance) {
    const auto corner = [&](double x, double h) {
        return std::copysign(1.0, x) * upright_corner(std::abs(x) / distance, h / distance);
    };
    return corner(x1, h1) - corner(x0, h1) - corner(x1, h0) + corner(x0, h0);
}

/// A diffuse point source: I = I_0 cos, tabulated in steps of a quarter of a degree.
Photometry diffuse_source(double candela) {
    Photometry p;
    p.file = "diffuse";
    for (int i = 0; i <= 360; ++i) {
        p.theta.push_back(0.25 * i), p.candela.push_back(candela * std::max(0.0, std::cos(0.25 * i * pi / 180)));
    }
    p.candela.back() = 0;
    p.theta.push_back(180), p.candela.push_back(0);
    p.phi = {0};
    return p;
}

void add_isotropic(SceneDescription& scene, const Point& at, double lumens) {
    PunctualLight light;
    light.position = at, light.intensity = Spectrum(lumens / (4 * pi));
    scene.lights.push_back(light);
}

/// Adds the faces of a box seen from inside, except `without`.
void add_room(PolygonKit& kit, double x, double y, double z, const std::string& without = "") {
    const Point middle{x / 2, y / 2, z / 2};
    const auto face = [&](const char* name, std::vector<Point> outline) {
        if (name != without) kit.facing(middle, name, "room", std::move(outline));
    };
    face("floor", {{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}});
    face("ceiling", {{0, 0, z}, {x, 0, z}, {x, y, z}, {0, y, z}});
    face("wall_y0", {{0, 0, 0}, {x, 0, 0}, {x, 0, z}, {0, 0, z}});
    face("wall_y1", {{0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z}});
    face("wall_x0", {{0, 0, 0}, {0, y, 0}, {0, y, z}, {0, 0, z}});
    face("wall_x1", {{x, 0, 0}, {x, y, 0}, {x, y, z}, {x, 0, z}});
}

Case make_case(const char* study, const char* scene) {
    Case c;
    c.study = study, c.scene = scene;
    c.options.bounces = 0;  // all black
    return c;
}

SceneDescription lit(PolygonKit kit) {
    SceneDescription scene = std::move(kit).take();
    scene.photometric = true;
    return scene;
}

/// A diffuse source 3 m above a plane, and a tilted one in a room.
void add_5_2(std::vector<Case>& out) {
    Case c = make_case("5.2", "point_diffuse");
    PolygonKit kit("point_diffuse");
    kit.material("room", 0);
    kit.horizontal("plane", "room", -2, -2, 2, 2, 0);
    c.description = lit(std::move(kit));
    PlacedLuminaire source;
    source.position = {0, 0, 3};
    add_luminaire(diffuse_source(1000), source, c.description);
    for (const Vec2& p :
         {Vec2{0, 0}, {0.5, 0}, {1, 0}, {1.5, 0}, {0.5, 0.5}, {1, 0.5}, {1.5, 0.5}, {1, 1}, {1.5, 1}, {1.5, 1.5}}) {
        const double r2 = 9 + p.x * p.x + p.y * p.y;
        add_point(c, {p.x, p.y, 0}, {0, 0, 1}, 1000 * 9 / (r2 * r2));
    }
    out.push_back(std::move(c));

    Case t = make_case("5.2", "point_tilted");
    PolygonKit room("point_tilted");
    room.material("room", 0);
    add_room(room, 4, 4, 3);
    t.description = lit(std::move(room));
    const Normal axis{0.3, -0.2, -std::sqrt(1 - 0.13)};
    source.position = {1, 1.3, 2.2};
    aim(source, axis, 0);
    add_luminaire(diffuse_source(1000), source, t.description);
    const auto add = [&](const Point& x, const Normal& n) {
        const Vec3 r = source.position - x;
        const double r2 = squared_norm(r), g = std::max(0.0, -dot(r, axis)) * std::max(0.0, dot(r, n)) / (r2 * r2);
        add_point(t, x, n, 1000 * g, fmt::format("{:g},{:g},{:g}", x.x, x.y, x.z));
    };
    for (const double y : depths) {
        add({2, y, 0}, {0, 0, 1}), add({0.5, y, 0}, {0, 0, 1});
        add({4, y, 0.5}, {-1, 0, 0}), add({4, y, 1.5}, {-1, 0, 0});
    }
    for (const double z : {0.25, 0.75, 1.25}) add({1.7, 0, z}, {0, 1, 0}), add({0, 1, z}, {1, 0, 0});
    out.push_back(std::move(t));
}

/// A square metre of 1000 cd/m^2 in the ceiling of a black room.
void add_5_3(std::vector<Case>& out) {
    Case c = make_case("5.3", "area_source");
    PolygonKit kit("area_source");
    kit.material("room", 0), kit.material("source", 0, 1000);
    add_room(kit, 4, 4, 3);
    kit.horizontal("source", "source", 1.5, 1.5, 2.5, 2.5, 3, false);
    c.description = lit(std::move(kit));
    const double M = 1000 * pi;
    for (const double z : heights)  // the wall faces +y; the source is at z = 3 above it
        add_point(c, {2, 0, z}, {0, 1, 0}, M * upright_factor(-0.5, 0.5, 1.5, 2.5, 3 - z));
    for (const double y : depths)
        add_point(c, {2, y, 0}, {0, 0, 1}, M * parallel_factor(-0.5, 0.5, 1.5 - y, 2.5 - y, 3));
    out.push_back(std::move(c));
}

/// Flux on the faces of a black room, by their solid angles from a point source at its centre.
void add_5_4(std::vector<Case>& out) {
    Case c = make_case("5.4", "flux_room");
    PolygonKit kit("flux_room");
    kit.material("room", 0);
    add_room(kit, 4, 4, 3);
    c.description = lit(std::move(kit));
    constexpr double lumens = 10000;
    add_isotropic(c.description, {2, 2, 1.5}, lumens);
    const auto flux = [&](double a, double b, double h) {
        return lumens / (4 * pi) * 4 * std::asin(a * b / std::sqrt((a * a + h * h) * (b * b + h * h)));
    };
    c.fluxes = {{"flux floor", {0, 0, 0}, {4, 0, 0}, {0, 4, 0}, flux(2, 2, 1.5)},
                {"flux ceiling", {0, 0, 3}, {0, 4, 0}, {4, 0, 0}, flux(2, 2, 1.5)},
                {"flux wall_y0", {0, 0, 0}, {0, 0, 3}, {4, 0, 0}, flux(2, 1.5, 2)},
                {"flux wall_y1", {0, 4, 0}, {4, 0, 0}, {0, 0, 3}, flux(2, 1.5, 2)},
                {"flux wall_x0", {0, 0, 0}, {0, 4, 0}, {0, 0, 3}, flux(2, 1.5, 2)},
                {"flux wall_x1", {4, 0, 0}, {0, 0, 3}, {0, 4, 0}, flux(2, 1.5, 2)}};
    for (const double y : depths) {
        const double r2 = 1.5 * 1.5 + (y - 2) * (y - 2);
        add_point(c, {2, y, 0}, {0, 0, 1}, lumens / (4 * pi) * 1.5 / (r2 * std::sqrt(r2)));
    }
    out.push_back(std::move(c));
}

/// Light of a horizontal diffuse square of M = 100 lm/m^2 on a wall and a ceiling: illuminance is the factor in per
/// cent. The factors assume no blockers. Therefore wall and ceiling are separate scenes: the wall would hide a part of
/// the largest square from the ceiling.
void add_5_6(std::vector<Case>& out) {
    for (const auto& [name, h] : {std::pair{"s1_50cm", 0.25}, {"s2_4m", 2.0}, {"s3_500m", 250.0}})
        for (const bool is_wall : {true, false}) {
            Case c = make_case("5.6", name);
            c.parameter = is_wall ? "wall" : "ceiling";
            PolygonKit kit(name);
            kit.material("s2", 0, 100 / pi), kit.material("s1", 0);
            kit.horizontal("s2", "s2", 2 - h, 2 - h, 2 + h, 2 + h, 0);
            if (is_wall)
                kit.facing({2, 2, 1}, "s1_v", "s1", {{0, 0, 0.5}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0.5}});
            else
                kit.facing({2, 2, 1}, "s1_hz", "s1", {{0, 0, 3}, {0, 4, 3}, {4, 4, 3}, {4, 0, 3}});
            c.description = lit(std::move(kit));
            const double near_edge = std::max(0.0, 2 - h);  // the part behind the wall's plane is not seen
            for (std::size_t i = is_wall ? 5 : 0; i-- > 0;)
                add_point(c, {2, 0, heights[i]}, {0, 1, 0}, 100 * upright_factor(-h, h, near_edge, 2 + h, heights[i]),
                          std::string(1, static_cast<char>('F' - i)));
            for (std::size_t i = 0; i < (is_wall ? 0 : depths.size()); ++i)
                add_point(c, {2, depths[i], 3}, {0, 0, -1},
                          100 * parallel_factor(-h, h, 2 - h - depths[i], 2 + h - depths[i], 3),
                          std::string(1, static_cast<char>('G' + i)));
            out.push_back(std::move(c));
        }
}

/// Light from a wall, with a black obstruction in between.
void add_5_7(std::vector<Case>& out) {
    Case c = make_case("5.7", "obstruction");
    PolygonKit kit("obstruction");
    kit.material("s2", 0, 100 / pi), kit.material("room", 0);
    kit.facing({2, 2, 1.5}, "s2", "s2", {{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
    kit.facing({2, 2, 1.5}, "s1_v", "room", {{0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}});
    kit.facing({2, 2, 1.5}, "s1_hz", "room", {{0, 0, 0}, {4, 0, 0}, {4, 2.5, 0}, {0, 2.5, 0}});
    const std::vector<Point> base{{0, 2.5, 0}, {4, 2.5, 0}, {4, 2.7, 0}, {0, 2.7, 0}};
    std::vector<Point> top = base;
    for (Point& p : top) p.z = 1;
    kit.prism("obstruction", "room", base, top, PolygonKit::no_bottom);
    c.description = lit(std::move(kit));
    // The visible part of the wall starts at the higher of the shadows of the obstruction's two upper edges.
    const auto lowest = [](const Point& p) {
        double z = 0;
        for (const double edge : {2.5, 2.7}) z = std::max(z, p.z + (1 - p.z) * (4 - p.y) / (edge - p.y));
        return std::min(z, 3.0);
    };
    for (const double z : heights) {
        const Point x{2, 0, z};
        add_point(c, x, {0, 1, 0}, 100 * parallel_factor(-2, 2, lowest(x) - z, 3 - z, 4));
    }
    for (std::size_t i = 0; i < 5; ++i) {
        const Point x{2, depths[i], 0};
        add_point(c, x, {0, 0, 1}, 100 * upright_factor(-2, 2, lowest(x), 3, 4 - depths[i]));
    }
    out.push_back(std::move(c));
}

/// A closed cube with reflections; solves for one reflectance per band at a time.
void add_5_8(const Cie171Options& options, std::vector<Case>& out) {
    constexpr double lumens = 10000, area = 96;
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < cube_reflectances.size(); ++i)
        if (!options.quick || i == 1 || i == 6 || i + 1 == cube_reflectances.size()) chosen.push_back(i);
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        Case c = make_case("5.8", "cube");
        const double rho = cube_reflectances[chosen[k]];
        c.parameter = fmt::format("rho={:g}", rho), c.band = k % bands;
        const std::size_t first = k - c.band;
        Spectrum reflectance;
        for (std::size_t b = 0; b < bands; ++b)
            reflectance[b] = cube_reflectances[chosen[std::min(first + b, chosen.size() - 1)]];
        PolygonKit kit("cube");
        kit.material("room", 0);
        add_room(kit, 4, 4, 4);
        c.description = lit(std::move(kit));
        for (Material& m : c.description.materials) m.reflectance = reflectance;
        add_isotropic(c.description, {2, 2, 2}, lumens);
        c.options = {};
        c.options.error = options.error_of_cube;
        for (const CubePlace& place : cube_places)
            add_point(c, {place.at.x, place.at.y, 0}, {0, 0, 1}, place.lux[chosen[k]],
                      fmt::format("floor {:g},{:g}", place.at.x, place.at.y));
        // All faces are equal: a sixth of the total arriving flux, as in the report's formula.
        c.fluxes = {{"flux floor", {0, 0, 0}, {4, 0, 0}, {0, 4, 0}, lumens / (1 - rho) / 6},
                    {"flux wall", {0, 0, 0}, {0, 4, 0}, {0, 0, 4}, lumens / (1 - rho) / 6}};
        static_assert(area == 96);
        out.push_back(std::move(c));
    }
}

}  // namespace

std::vector<Cie171Case> cie171_lamp_cases(const Cie171Options& options) {
    std::vector<Case> out;
    add_5_2(out), add_5_3(out), add_5_4(out), add_5_6(out), add_5_7(out), add_5_8(options, out);
    return out;
}

}  // namespace exitance
