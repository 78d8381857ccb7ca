#include "exitance/io/photometry/glare_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/io/photometry/luminaire_body.hpp"
#include "exitance/measure/glare/glare_rules.hpp"

namespace exitance {
namespace {

constexpr double height = 2, spacing = 0.25 * height;  ///< Mounting height H and distance of luminaires, metres.

constexpr std::array<std::pair<double, double>, 19> rooms{{{2, 2},
                                                           {2, 3},
                                                           {2, 4},
                                                           {2, 6},
                                                           {2, 8},
                                                           {2, 12},
                                                           {4, 2},
                                                           {4, 3},
                                                           {4, 4},
                                                           {4, 6},
                                                           {4, 8},
                                                           {4, 12},
                                                           {8, 4},
                                                           {8, 6},
                                                           {8, 8},
                                                           {8, 12},
                                                           {12, 4},
                                                           {12, 6},
                                                           {12, 8}}};
constexpr std::array<std::array<double, 3>, 5> reflectances{
    {{0.7, 0.5, 0.2}, {0.7, 0.3, 0.2}, {0.5, 0.5, 0.2}, {0.5, 0.3, 0.2}, {0.3, 0.3, 0.2}}};

/// Converts a direction to the luminaire's frame; the line of sight is y.
Vec3 in_luminaire(const Vec3& d, bool crosswise) {
    return crosswise ? Vec3{d.y, -d.x, d.z} : d;
}

/// A sample of a luminaire's flux, lm, and the offset of the point at which it meets the plane of the eye, metres.
struct Ray {
    double dx = 0, dy = 0, flux = 0;
};

struct Emission {
    std::vector<Ray> down;
    double up = 0;
};

Emission emission_of(const Photometry& p, bool crosswise) {
    constexpr double step_theta = 1, step_phi = 2.5;
    Emission out;
    for (double theta = step_theta / 2; theta < 180; theta += step_theta)
        for (double phi = step_phi / 2; phi < 360; phi += step_phi) {
            const double a = theta * degree, b = phi * degree;
            const Vec3 d{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), -std::cos(a)};
            const double solid_angle =
                (std::cos((theta - step_theta / 2) * degree) - std::cos((theta + step_theta / 2) * degree)) * step_phi *
                degree;
            const double flux = p.intensity(in_luminaire(d, crosswise)) * solid_angle;
            if (d.z < 0)
                out.down.push_back({-height * d.x / d.z, -height * d.y / d.z, flux});
            else
                out.up += flux;
        }
    return out;
}

/// Positions of luminaires along a side of the room, metres.
std::vector<double> places(double length) {
    std::vector<double> out;
    for (double at = spacing / 2; at < length; at += spacing) out.push_back(at);
    return out;
}

/// Share of luminaire positions from which an offset ends inside the room.
double share_within(const std::vector<double>& at, double offset, double length) {
    const auto within =
        std::count_if(at.begin(), at.end(), [&](double a) { return a + offset >= 0 && a + offset <= length; });
    return static_cast<double>(within) / static_cast<double>(at.size());
}

/// Form factor between opposite rectangles of a x b at distance c.
double opposite_factor(double a, double b, double c) {
    const double x = a / c, y = b / c, u = std::sqrt(1 + x * x), v = std::sqrt(1 + y * y);
    return 2 / (pi * x * y) *
           (std::log(u * v / std::sqrt(1 + x * x + y * y)) + x * v * std::atan(x / v) + y * u * std::atan(y / u) -
            x * std::atan(x) - y * std::atan(y));
}

/// Mean indirect illuminance of the walls, lx, including all interreflections between ceiling, walls and floor.
double wall_light(const GlareTableRow& room, double width, double length, double to_floor, double to_walls,
                  double to_ceiling) {
    const double across = opposite_factor(width, length, height);
    const double floor_area = width * length, wall_area = 2 * height * (width + length);
    const double wall_to_floor = (1 - across) * floor_area / wall_area;
    const std::array<double, 3> rho{room.ceiling, room.walls, room.floor};
    const std::array<double, 3> direct{to_ceiling / floor_area, to_walls / wall_area, to_floor / floor_area};
    std::array<double, 3> indirect{};
    constexpr int rounds = 200;
    for (int round = 0; round < rounds; ++round) {
        std::array<double, 3> B{};
        for (std::size_t i = 0; i < 3; ++i) B[i] = rho[i] * (direct[i] + indirect[i]);
        indirect = {across * B[2] + (1 - across) * B[1], wall_to_floor * (B[0] + B[2]) + (1 - 2 * wall_to_floor) * B[1],
                    across * B[0] + (1 - across) * B[1]};
    }
    return indirect[1];
}

/// Projected area of a luminaire's opening in a direction, m^2.
class OpeningArea {
  public:
    explicit OpeningArea(const Photometry& p) : is_point_(p.opening.shape == Opening::Shape::point) {
        for (const LuminaireBody::Face& face : make_luminaire_body(p).faces)
            if (face.exitance > 0) faces_.push_back(area_vector(face.corners));
    }
    double towards(const Vec3& d) const {
        if (is_point_) return small_source_area;
        double sum = 0;
        for (const Vec3& face : faces_) sum += std::max(0.0, dot(face, d));
        return sum;
    }

  private:
    bool is_point_;
    std::vector<Vec3> faces_;
};

/// Sum of L^2 omega / p^2 over the luminaires in view that CIE 117 counts.
double glare_sum(const Photometry& p, const OpeningArea& opening, const std::vector<double>& xs,
                 const std::vector<double>& ys, double width, bool crosswise) {
    constexpr Normal view{0, 1, 0};
    double sum = 0;
    for (const double y : ys)
        for (const double x : xs) {
            const Vec3 d{x - width / 2, y, height};  // vector from the eye to the luminaire
            if (glare_limit(view, d, true) != GlareLimit::none) continue;
            const Vec3 towards_eye = in_luminaire(normalized(Vec3() - d), crosswise);
            const double area = opening.towards(towards_eye);
            const double intensity = p.intensity(towards_eye), index = guth_position(view, d);
            if (area > 0) sum += intensity * intensity / (area * dot(d, d) * index * index);
        }
    return sum;
}

/// Quantities of a room that do not depend on its reflectances.
struct DirectLightOfRoom {
    double to_floor = 0, to_walls = 0, to_ceiling = 0;  ///< lm
    double glare = 0;                                   ///< sum of L^2 omega / p^2
};

DirectLightOfRoom direct_light(const Photometry& p, const Emission& light, const OpeningArea& opening, double width,
                               double length, bool crosswise) {
    const std::vector<double> xs = places(width), ys = places(length);
    const double count = static_cast<double>(xs.size() * ys.size());
    DirectLightOfRoom out;
    double down = 0;
    for (const Ray& ray : light.down) {
        out.to_floor += count * ray.flux * share_within(xs, ray.dx, width) * share_within(ys, ray.dy, length);
        down += count * ray.flux;
    }
    out.to_walls = down - out.to_floor, out.to_ceiling = count * light.up;
    out.glare = glare_sum(p, opening, xs, ys, width, crosswise);
    return out;
}

double rating(const DirectLightOfRoom& direct, const GlareTableRow& room) {
    const double E =
        wall_light(room, room.x * height, room.y * height, direct.to_floor, direct.to_walls, direct.to_ceiling);
    return 8 * std::log10(0.25 * pi / E * direct.glare);
}

}  // namespace

std::vector<GlareTableRow> make_glare_table(const Photometry& p) {
    const OpeningArea opening(p);
    const Emission across = emission_of(p, true), along = emission_of(p, false);
    std::vector<std::pair<DirectLightOfRoom, DirectLightOfRoom>> direct;
    for (const auto& [x, y] : rooms)
        direct.emplace_back(direct_light(p, across, opening, x * height, y * height, true),
                            direct_light(p, along, opening, x * height, y * height, false));
    std::vector<GlareTableRow> out;
    for (const auto& rho : reflectances)
        for (std::size_t i = 0; i < rooms.size(); ++i) {
            GlareTableRow row{rooms[i].first, rooms[i].second, rho[0], rho[1], rho[2], 0, 0};
            row.crosswise = rating(direct[i].first, row), row.endwise = rating(direct[i].second, row);
            out.push_back(row);
        }
    return out;
}

std::string glare_table_csv(const std::vector<GlareTableRow>& table) {
    std::string text = "ceiling,walls,floor,X,Y,crosswise,endwise\n";
    const auto cell = [](double v) { return std::isfinite(v) ? fmt::format("{:.1f}", v) : std::string(); };
    for (const GlareTableRow& row : table)
        text += fmt::format("{:.0f},{:.0f},{:.0f},{:g},{:g},{},{}\n", 100 * row.ceiling, 100 * row.walls,
                            100 * row.floor, row.x, row.y, cell(row.crosswise), cell(row.endwise));
    return text;
}

}  // namespace exitance
