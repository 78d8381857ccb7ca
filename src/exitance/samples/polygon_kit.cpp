#include "exitance/samples/polygon_kit.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// Converts a colour of three bands to the bands of this build.
Spectrum spectrum(const PolygonKit::Colour& c) {
    Spectrum out;
    if (bands == 1) return Spectrum((c[0] + c[1] + c[2]) / 3);
    for (std::size_t b = 0; b < bands; ++b) out[b] = c[b * 3 / bands];
    return out;
}

}  // namespace

Placement Placement::at(double x, double y, double z, double degrees) {
    const double angle = degrees * pi / 180;
    Placement out{{x, y, z}, std::cos(angle), std::sin(angle)};
    if (std::fmod(degrees, 90) == 0) out.cosine = std::round(out.cosine), out.sine = std::round(out.sine);
    return out;
}

void PolygonKit::material(const std::string& name, const Colour& reflectance, const Colour& radiance) {
    const Material m{name, spectrum(reflectance), exitance_of_radiance(spectrum(radiance))};
    const auto [known, is_new] = materials_.try_emplace(name, static_cast<std::uint32_t>(scene_.materials.size()));
    if (is_new)
        scene_.materials.push_back(m);
    else
        scene_.materials[known->second] = m;
}

std::uint32_t PolygonKit::point(Point p) {
    p += Point{0, 0, 0};  // turns -0 into 0
    const std::uint64_t key =
        hash(std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y), std::bit_cast<std::uint64_t>(p.z));
    const auto [first, last] = points_.equal_range(key);
    for (auto known = first; known != last; ++known)
        if (scene_.points[known->second] == p) return known->second;
    const auto id = static_cast<std::uint32_t>(scene_.points.size());
    scene_.points.push_back(p);
    points_.emplace(key, id);
    return id;
}

void PolygonKit::polygon(std::string_view group, std::string_view material, std::span<const Point> outline) {
    const auto [known, is_new] =
        groups_.try_emplace(std::string(group), static_cast<std::uint32_t>(scene_.groups.size()));
    if (is_new) scene_.groups.emplace_back(group);
    SceneDescription::Face face;
    for (const Point& p : outline) face.corners.push_back(point(p));
    face.material = materials_.at(std::string(material));
    face.group = known->second;
    scene_.faces.push_back(std::move(face));
}

void PolygonKit::facing(const Point& seen, std::string_view group, std::string_view material,
                        std::vector<Point> outline) {
    Vec3 sum;
    for (const Point& p : outline) sum += p;
    const Point middle = sum / static_cast<double>(outline.size());
    if (dot(area_vector(outline), seen - middle) < 0) std::reverse(outline.begin(), outline.end());
    polygon(group, material, outline);
}

void PolygonKit::horizontal(std::string_view group, std::string_view material, double x0, double y0, double x1,
                            double y1, double z, bool up) {
    if (up)
        polygon(group, material, {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}});
    else
        polygon(group, material, {{x0, y1, z}, {x1, y1, z}, {x1, y0, z}, {x0, y0, z}});
}

void PolygonKit::prism(std::string_view group, std::string_view material, const std::vector<Point>& base,
                       const std::vector<Point>& top, const Faces& faces) {
    if (faces.bottom) polygon(group, material, std::vector<Point>(base.rbegin(), base.rend()));
    if (faces.top) polygon(group, material, top);
    for (std::size_t i = 0; i < base.size(); ++i) {
        const std::size_t j = (i + 1) % base.size();
        if (i >= 32 || (faces.sides >> i & 1u) != 0) polygon(group, material, {base[i], base[j], top[j], top[i]});
    }
}

void PolygonKit::box(std::string_view group, std::string_view material, const Point& lo, const Point& hi,
                     const Faces& faces, const Placement& place) {
    std::vector<Point> base, top;
    for (const auto& [x, y] : {Vec2{lo.x, lo.y}, Vec2{hi.x, lo.y}, Vec2{hi.x, hi.y}, Vec2{lo.x, hi.y}}) {
        base.push_back(place({x, y, lo.z}));
        top.push_back(place({x, y, hi.z}));
    }
    prism(group, material, base, top, faces);
}

}  // namespace exitance
