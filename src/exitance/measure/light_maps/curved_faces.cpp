#include "exitance/measure/light_maps/curved_faces.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// Angles between a corner's normal and its face above which the surface is curved. Derived from the rounding of
/// normals in single precision and in text of four digits.
constexpr double min_angle = 0.1 * pi / 180;
/// Angle above which a mesh is too coarse to approximate a surface: derived from a tube of eight sides at its corners,
/// which are 22.5 degrees off, and from a cube with the mean normals of its corners, which are 54.7 degrees off.
constexpr double max_angle = pi / 4;

/// The largest angle between a normal of the triangle and that of its face, radians.
double largest_turn(const NormalTriangle& triangle, const Normal& front) {
    double largest = 0;
    for (const Normal& n : triangle.normal)
        largest = std::max(largest, std::atan2(norm(cross(n, front)), dot(n, front)));
    return largest;
}

/// Control point of a boundary curve next to corner `i`, towards corner `j`.
Point control(const NormalTriangle& t, std::size_t i, std::size_t j) {
    const double w = std::min(0.0, dot(t.corner[j] - t.corner[i], t.normal[i]));
    return (2 * t.corner[i] + t.corner[j] - w * t.normal[i]) / 3;
}

/// Point of the cubic patch at barycentric coordinates b.
Point patch_point(const NormalTriangle& t, const std::array<double, 3>& b) {
    Point sum, edges;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const Point from = control(t, i, j), to = control(t, j, i);
        edges += from + to;
        sum += b[i] * b[i] * b[i] * t.corner[i] + 3 * b[i] * b[j] * (b[i] * from + b[j] * to);
    }
    const Point E = edges / 6, V = (t.corner[0] + t.corner[1] + t.corner[2]) / 3;
    return sum + 6 * b[0] * b[1] * b[2] * (E + (E - V) / 2);
}

/// Barycentric coordinates of the projection of a point to the triangle's plane.
std::array<double, 3> coordinates(const NormalTriangle& t, const Point& x) {
    const Vec3 a = t.corner[1] - t.corner[0], b = t.corner[2] - t.corner[0], d = x - t.corner[0], n = cross(a, b);
    const double area = squared_norm(n);
    if (!(area > 0)) return {1, 0, 0};
    const double second = dot(cross(d, b), n) / area, third = dot(cross(a, d), n) / area;
    return {1 - second - third, second, third};
}

}  // namespace

CurvedFaces::CurvedFaces(const Scene& scene, std::span<const NormalTriangle> triangles)
    : first_(scene.surfaces().size()), count_(scene.surfaces().size()), is_curved_(scene.regions().size()) {
    Field<RegionId, std::uint8_t> is_coarse(scene.regions().size());
    for (const NormalTriangle& t : triangles) {
        const Surface& face = scene.surfaces()[t.surface];
        const double angle = largest_turn(t, face.normal);
        is_curved_[face.region] |= angle > min_angle;
        is_coarse[face.region] |= !(angle <= max_angle);
    }
    for (const RegionId r : scene.regions().ids())
        if (is_coarse[r] || scene.material(r).emits() || !scene.behind(r).is_none()) is_curved_[r] = 0;
    std::copy_if(triangles.begin(), triangles.end(), std::back_inserter(triangles_),
                 [&](const NormalTriangle& t) { return is_curved_[scene.surfaces()[t.surface].region] != 0; });
    std::stable_sort(triangles_.begin(), triangles_.end(),
                     [](const NormalTriangle& a, const NormalTriangle& b) { return a.surface < b.surface; });
    for (std::size_t t = triangles_.size(); t-- > 0;) {
        first_[triangles_[t].surface] = static_cast<std::uint32_t>(t);
        ++count_[triangles_[t].surface];
    }
}

CurvedPlace CurvedFaces::at(std::size_t triangle, const std::array<double, 3>& weight) const {
    const NormalTriangle& t = triangles_[triangle];
    Point on_face;
    Vec3 n;
    for (std::size_t k = 0; k < 3; ++k) on_face += weight[k] * t.corner[k], n += weight[k] * t.normal[k];
    const Vec3 front = cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
    const Point on_patch = patch_point(t, weight);
    const double side = dot(front, n) < 0 ? -1 : 1;  // corners may be clockwise, as in glTF files
    return {side * dot(front, on_patch - on_face) > 0 ? on_patch : on_face, normalized(n), triangle, weight};
}

std::optional<CurvedPlace> CurvedFaces::find(SurfaceId surface, const Point& x) const {
    if (surface.is_none() || count_[surface] == 0) return std::nullopt;
    double best = -HUGE_VAL;
    std::size_t found = 0;
    std::array<double, 3> weight{};
    for (std::size_t t = first_[surface]; t < first_[surface] + count_[surface]; ++t) {
        const std::array<double, 3> b = coordinates(triangles_[t], x);
        const double least = *std::min_element(b.begin(), b.end());
        if (least > best) best = least, found = t, weight = b;
    }
    double sum = 0;
    for (double& b : weight) b = std::max(b, 0.0), sum += b;  // points on a border may be outside by rounding
    for (double& b : weight) b /= sum;
    return at(found, weight);
}

}  // namespace exitance
