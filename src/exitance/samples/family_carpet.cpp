#include <fmt/format.h>

#include <array>
#include <cmath>

#include "exitance/base/triangulation.hpp"
#include "exitance/samples/families.hpp"

namespace exitance {
namespace {

/// Splits every face into triangles, and each of these into `cuts` x `cuts` similar ones, like modelling programs do.
void cut_faces(PolygonKit& to, const SceneDescription& from, int cuts) {
    std::vector<Point> outline;
    for (const auto& face : from.faces) {
        outline.clear();
        for (std::uint32_t corner : face.corners) outline.push_back(from.points[corner]);
        for (const auto& [a, b, c] : triangulate(outline, normalized(area_vector(outline)))) {
            const Point origin = outline[a];
            const Vec3 u = outline[b] - origin, v = outline[c] - origin;
            const auto at = [&](int i, int k) {
                return origin + static_cast<double>(i) / cuts * u + static_cast<double>(k) / cuts * v;
            };
            const std::string &group = from.groups[face.group], &material = from.materials[face.material].name;
            for (int i = 0; i < cuts; ++i)
                for (int k = 0; i + k < cuts; ++k) {
                    to.polygon(group, material, {at(i, k), at(i + 1, k), at(i, k + 1)});
                    if (i + k + 1 < cuts) to.polygon(group, material, {at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
                }
        }
    }
}

/// Adds v strips of u triangles each that face down, with heights that vary as waves in both directions. If u is odd,
/// lines of u/2 - 1/2 and u/2 + 1/2 parts alternate.
void add_wavy_sheet(PolygonKit& kit, const Vec2& lo, const Vec2& hi, double height, double wave, int u, int v) {
    constexpr double waves = 4;  // number of waves across the sheet
    const auto parts = [&](int line) { return line % 2 == 0 ? (u + 1) / 2 : std::max(u / 2, 1); };
    const auto at = [&](int line, int i) {
        const double s = static_cast<double>(i) / parts(line), t = static_cast<double>(line) / v;
        const double z = height + wave * std::sin(2 * pi * waves * s) * std::cos(2 * pi * waves * t);
        return Point{lo.x + s * (hi.x - lo.x), lo.y + t * (hi.y - lo.y), z};
    };
    for (int strip = 0; strip < v; ++strip) {
        const int first = parts(strip), second = parts(strip + 1);
        for (int i = 0, k = 0, count = 0; count < u && (i < first || k < second); ++count) {
            // Advance on the line that lags behind, so that all triangles have similar sizes.
            if (k == second || (i < first && (2 * i + 1) * second <= (2 * k + 1) * first)) {
                kit.polygon("carpet", "carpet", {at(strip, i), at(strip + 1, k), at(strip, i + 1)});
                ++i;
            } else {
                kit.polygon("carpet", "carpet", {at(strip, i), at(strip + 1, k), at(strip + 1, k + 1)});
                ++k;
            }
        }
    }
}

}  // namespace

/// Two furnished office rooms, all triangulated, with their own lamps off. A wavy sheet of triangles that emit
/// downwards hangs under the ceiling of the first room.
PolygonKit make_carpet(const FamilyValues& values) {
    const auto value = [&](const char* name) { return static_cast<int>(values.at(name)); };
    const int u = value("u"), v = value("v");
    FamilyValues office = {{"nx", 2}, {"ny", 1}, {"nfurn", 2}, {"seed", 7}};
    office["books"] = values.at("books");
    const SceneDescription furnished = make_office(office).take();
    PolygonKit kit(fmt::format("carpet_{}x{}", u, v));
    for (const Material& m : furnished.materials) {
        PolygonKit::Colour reflectance;
        for (std::size_t i = 0; i < reflectance.size(); ++i) reflectance[i] = m.reflectance[std::min(i, bands - 1)];
        kit.material(m.name, reflectance);
    }
    kit.material("carpet", {0.5, 0.5, 0.5}, {9.5, 9.0, 8.0});
    cut_faces(kit, furnished, value("cuts"));
    add_wavy_sheet(kit, {0.3, 0.3}, {3.7, 3.7}, values.at("h"), values.at("wave"), u, v);
    return kit;
}

}  // namespace exitance
