#include "exitance/io/photometry/luminaire_body.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/polygon.hpp"

namespace exitance {
namespace {

using Shape = Opening::Shape;
using Polygons = std::vector<std::vector<Point>>;

/// Sides of a round edge: their normals are at angles that tables of 1, 3, 5 and 15 degrees contain.
constexpr int sides = 24;
constexpr int bands_of_sphere = 8, sides_of_sphere = 16;

/// A regular polygon with the area of a circle of diameter 1. The normals of its edges are at multiples of 360 / n
/// degrees.
std::vector<Vec2> round_outline(int n) {
    const double radius = 0.5 * std::sqrt(2 * pi / (n * std::sin(2 * pi / n)));
    std::vector<Vec2> out;
    for (int i = 0; i < n; ++i) {
        const double a = 2 * pi * (i + 0.5) / n;
        out.push_back({radius * std::cos(a), radius * std::sin(a)});
    }
    return out;
}

std::vector<Vec2> square_outline() {
    return {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
}

/// Prism with the given outline along z from -1/2 to 1/2: sides and both ends.
Polygons prism(const std::vector<Vec2>& outline) {
    Polygons out;
    const std::size_t n = outline.size();
    std::vector<Point> bottom, top;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 &a = outline[i], &b = outline[(i + 1) % n];
        out.push_back({{a.x, a.y, -0.5}, {b.x, b.y, -0.5}, {b.x, b.y, 0.5}, {a.x, a.y, 0.5}});
        top.push_back({a.x, a.y, 0.5});
        bottom.push_back({outline[n - 1 - i].x, outline[n - 1 - i].y, -0.5});
    }
    out.push_back(std::move(bottom)), out.push_back(std::move(top));
    return out;
}

/// Polyhedron with the surface area of a sphere of diameter 1: bands of trapezia and two caps of triangles.
Polygons ball() {
    const auto at = [](int band, int i) {
        const double t = pi * band / bands_of_sphere, p = 2 * pi * (i + 0.5) / sides_of_sphere;
        return Point{0.5 * std::sin(t) * std::cos(p), 0.5 * std::sin(t) * std::sin(p), -0.5 * std::cos(t)};
    };
    Polygons out;
    double area = 0;
    for (int band = 0; band < bands_of_sphere; ++band)
        for (int i = 0; i < sides_of_sphere; ++i) {
            std::vector<Point> face{at(band, i), at(band, i + 1), at(band + 1, i + 1), at(band + 1, i)};
            if (band == 0) face.erase(face.begin());
            if (band == bands_of_sphere - 1) face.erase(face.begin() + 2);
            area += norm(area_vector(face));
            out.push_back(std::move(face));
        }
    const double scale = std::sqrt(pi / area);
    for (std::vector<Point>& face : out)
        for (Point& p : face) p *= scale;
    return out;
}

/// Number of cyclic rotations of the axes that turn a cylinder along z into this shape. Rotations keep the orientation
/// of faces.
int turns_of(Shape shape) {
    return shape == Shape::cylinder_x ? 1 : shape == Shape::cylinder_y ? 2 : 0;
}

bool is_flat(Shape shape) {
    return shape == Shape::rectangle || shape == Shape::ellipse;
}

bool is_cylinder(Shape shape) {
    return shape == Shape::cylinder_x || shape == Shape::cylinder_y || shape == Shape::cylinder_z;
}

Polygons polygons_of(Shape shape, const Vec3& size) {
    Polygons out;
    switch (shape) {
        case Shape::rectangle:
        case Shape::ellipse: {
            std::vector<Point> up, down;
            for (const Vec2& v : shape == Shape::rectangle ? square_outline() : round_outline(sides))
                up.push_back({v.x, v.y, 0});
            down.assign(up.rbegin(), up.rend());
            out = {down, up};
            break;
        }
        case Shape::ellipsoid:
            out = ball();
            break;
        case Shape::point:
        case Shape::box:
            out = prism(square_outline());
            break;
        default:
            out = prism(round_outline(sides));
    }
    for (std::vector<Point>& face : out)
        for (Point& p : face) {
            for (int i = 0; i < turns_of(shape); ++i) p = {p.z, p.x, p.y};
            p = {p.x * size.x, p.y * size.y, p.z * size.z};
        }
    return out;
}

/// Cuts the dark upper parts off the sides of a box. The luminous parts stay in `faces`; returns the dark parts.
Polygons cut_dark_sides(const Opening& opening, const Vec3& size, Polygons& faces) {
    Polygons dark;
    for (std::vector<Point>& face : faces) {
        const Vec3 n = area_vector(face);
        if (std::abs(n.z) > std::max(std::abs(n.x), std::abs(n.y))) continue;
        const double height = std::abs(n.x) > std::abs(n.y) ? opening.dark_x : opening.dark_y;
        if (!(height > 0)) continue;
        const double cut = 0.5 * size.z - std::min(height, size.z);
        std::vector<Point>& upper = dark.emplace_back(face);
        for (Point& p : upper) p.z = std::max(p.z, cut);
        for (Point& p : face) p.z = std::min(p.z, cut);
    }
    std::erase_if(faces, [](const std::vector<Point>& face) { return norm(area_vector(face)) == 0; });
    return dark;
}

/// Size of a box without dark parts whose sides have the areas of the luminous parts, so that its projected area is the
/// same in every direction. A pair of dark sides gets a millionth of the bottom's area, so the light exactly in its
/// direction is lost, as for a plane opening.
Vec3 box_of_same_areas(const Opening& opening, const Vec3& size) {
    if (!(opening.dark_x > 0 || opening.dark_y > 0)) return size;
    const double z = size.x * size.y, min_area = 1e-6 * z;
    const double x = std::max(min_area, size.y * (size.z - opening.dark_x));
    const double y = std::max(min_area, size.x * (size.z - opening.dark_y));
    return {std::sqrt(y * z / x), std::sqrt(x * z / y), std::sqrt(x * y / z)};
}

/// Projected area of a convex body in direction d.
double projected_area(const std::vector<Vec3>& areas, const Vec3& d) {
    double sum = 0;
    for (const Vec3& a : areas) sum += std::max(0.0, dot(a, d));
    return sum;
}

/// Merges the table's angles with a regular grid.
std::vector<double> refined(const std::vector<double>& at, double last, double step) {
    std::vector<double> out = at.size() > 1 ? at : std::vector<double>{0, last};
    for (int i = 0; i * step <= last; ++i) out.push_back(i * step);
    std::sort(out.begin(), out.end());
    constexpr double angle_tolerance = 1e-7;
    out.erase(std::unique(out.begin(), out.end(), [](double a, double b) { return b - a < angle_tolerance; }),
              out.end());
    return out;
}

/// Angles from a cylinder's axis, degrees, including those of `table`. They are denser near the axis, where the
/// projected area, end + side sin a, changes fast, so that its inverse is nearly linear between neighbouring angles.
std::vector<double> graded(const std::vector<double>& table, double end, double side, double step) {
    constexpr double growth = 0.04;  // the error of linear interpolation is below 4e-4
    const double bend = end / side / degree;
    std::vector<double> rise{0};
    while (rise.back() < 90) rise.push_back(rise.back() + std::min(step, growth * (rise.back() + bend)));
    std::vector<double> out;
    for (const double a : rise) out.push_back(a * 90 / rise.back());
    for (std::size_t i = rise.size() - 1; i-- > 0;) out.push_back(180 - out[i]);
    // Move the nearest angle to each angle of the table, which avoids tiny steps.
    for (const double t : table) {
        const auto after = std::lower_bound(out.begin(), out.end(), t);
        if (after == out.begin() || after == out.end()) continue;
        const auto nearest = *after - t < t - *(after - 1) ? after : after - 1;
        const bool is_fixed = nearest == out.begin() || nearest + 1 == out.end() || *nearest == 90;
        if (!is_fixed) *nearest = t;
    }
    return out;
}

/// Tabulates the radiance: intensity over the body's projected area, on a grid on which this area is nearly linear
/// between angles.
void bake(const Photometry& p, const std::vector<Vec3>& areas, double step, bool is_cylinder, LuminaireBody& body) {
    EmissionProfile& out = body.profile;
    // In the frame of a horizontal cylinder, the table's angles are not grid lines.
    const bool is_own = body.axis_z == p.axis_z;
    const std::vector<double> none;
    out.axes[0] = {EmissionProfile::Angle::phi, 0, refined(is_own ? p.phi : none, 360, step)};
    out.axes[1] = {EmissionProfile::Angle::theta, 0, refined(is_own ? p.theta : none, 180, step)};
    if (is_cylinder)
        out.axes[1].at = graded(is_own ? p.theta : none, projected_area(areas, body.axis_z),
                                projected_area(areas, body.axis_x), step);
    for (const double phi : out.axes[0].at)
        for (const double theta : out.axes[1].at) {
            const double a = theta * degree, b = phi * degree;
            const Vec3 d =
                std::sin(a) * (std::cos(b) * body.axis_x + std::sin(b) * body.axis_y) - std::cos(a) * body.axis_z;
            out.values.push_back(p.intensity(d) / projected_area(areas, d));
        }
}

void add_profile(const Photometry& p, const Vec3& size, const std::vector<Vec3>& areas, LuminaireBody& body) {
    const Shape shape = p.opening.shape;
    EmissionProfile& out = body.profile;
    body.axis_x = p.axis_x, body.axis_y = p.axis_y, body.axis_z = p.axis_z;
    // EmissionProfile::Body::box measures the box along the axes of the table, which are the body's in type C.
    const bool is_box = (shape == Shape::box || shape == Shape::point) && p.type == Photometry::Type::c;
    if (!is_flat(shape) && !is_box) {
        // Step in degrees: smaller if the body's edges deviate from grid lines or are sharp.
        const double step = shape == Shape::cylinder_z || shape == Shape::box ? 1
                            : shape == Shape::ellipsoid                       ? 0.25
                                                                              : 0.5;
        if (is_cylinder(shape) && p.type == Photometry::Type::c)
            for (Vec3* axis : {&body.axis_x, &body.axis_y, &body.axis_z})
                for (int i = 0; i < turns_of(shape); ++i) *axis = {axis->z, axis->x, axis->y};
        bake(p, areas, step, is_cylinder(shape) && p.type == Photometry::Type::c, body);
        return;
    }
    out.axes[0] = {EmissionProfile::Angle::phi, 0, p.phi};
    out.axes[1] = {EmissionProfile::Angle::theta, 0, p.theta};
    out.values = p.candela;
    out.body = is_flat(shape) ? EmissionProfile::Body::flat : EmissionProfile::Body::box;
    out.size = is_box ? box_of_same_areas(p.opening, size) : Vec3{1, 1, 1};
    const double area = is_flat(shape) ? norm(areas[0]) : 1;
    for (double& v : out.values) v /= area;
}

}  // namespace

double LuminaireBody::flux() const {
    double sum = 0;
    for (const Face& face : faces) sum += face.exitance * norm(area_vector(face.corners));
    return sum;
}

Vec3 body_size(const Opening& opening) {
    const double missing = opening.shape == Shape::point ? point_opening_size : strip_width;
    const auto extent = [&](double v) { return v > 0 ? v : missing; };
    return {extent(opening.size.x), extent(opening.size.y), is_flat(opening.shape) ? 0 : extent(opening.size.z)};
}

LuminaireBody make_luminaire_body(const Photometry& p) {
    LuminaireBody out;
    const Shape shape = p.opening.shape;
    const Vec3 size = body_size(p.opening);
    Polygons polygons = polygons_of(shape, size);
    const Polygons dark = shape == Shape::box ? cut_dark_sides(p.opening, size, polygons) : Polygons();
    std::vector<Vec3> areas;
    for (const std::vector<Point>& face : polygons) areas.push_back(area_vector(face));
    add_profile(p, size, areas, out);
    const bool is_upright = p.type == Photometry::Type::c;
    double most = 0;
    for (std::size_t i = 0; i < polygons.size(); ++i) {
        const Normal n = normalized(areas[i]);
        const double exitance = is_flat(shape) && is_upright
                                    ? (n.z < 0 ? p.flux(0, 90) : p.flux(90, 180)) / norm(areas[i])
                                    : exitance_of(out.profile, out.in_frame(n));
        most = std::max(most, exitance);
        out.faces.push_back({polygons[i], exitance});
    }
    // A table that ends at 90 degrees gives upper faces only rounding errors, which are set to 0. The dark side of a
    // plane opening is removed, since the other side alone blocks light.
    constexpr double negligible = 1e-7;
    for (LuminaireBody::Face& face : out.faces)
        if (face.exitance < negligible * most) face.exitance = 0;
    if (is_flat(shape)) std::erase_if(out.faces, [](const LuminaireBody::Face& face) { return face.exitance == 0; });
    for (const std::vector<Point>& face : dark) out.faces.push_back({face, 0});
    return out;
}

}  // namespace exitance
