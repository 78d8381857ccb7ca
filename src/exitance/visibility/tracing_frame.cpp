#include "exitance/visibility/tracing_frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace exitance {
namespace {

/// Numbers of faces that give candidates and of candidates, and number of faces whose boxes are compared; derived from
/// a limit of about a millisecond.
constexpr std::size_t max_giving_faces = 64, max_candidates = 24, max_compared_faces = 512;
/// Another frame must reduce the area of the boxes to this share; derived from the cost of rotating rays, and from the
/// differences of some percent between frames of curved surfaces, which have none that is better.
constexpr double required_share = 0.8;
/// Limit on the cosine between axes that are regarded as perpendicular; derived from coordinates with five digits.
constexpr double same_axes = 1e-5;

/// True if both frames have the same axes, in any order and of either sign.
bool is_same(const TracingFrame& a, const TracingFrame& b) {
    for (const Normal& u : {a.x, a.y, a.z})
        for (const Normal& v : {b.x, b.y, b.z}) {
            const double cosine = std::abs(dot(u, v));
            if (std::min(cosine, 1 - cosine) > same_axes) return false;
        }
    return true;
}

/// The faces that represent a scene: its largest ones, and others at equal distances in its list.
std::vector<SurfaceId> choose_faces(const Scene& scene, std::size_t count) {
    std::vector<SurfaceId> faces(scene.surfaces().ids().begin(), scene.surfaces().ids().end());
    const auto is_larger = [&](SurfaceId a, SurfaceId b) {
        const double area_a = scene.surfaces()[a].area, area_b = scene.surfaces()[b].area;
        return area_a > area_b || (area_a == area_b && a.value < b.value);
    };
    const std::size_t largest = std::min(faces.size(), count / 2);
    std::partial_sort(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(largest), faces.end(), is_larger);
    if (faces.size() <= count) return faces;
    std::sort(faces.begin() + static_cast<std::ptrdiff_t>(largest), faces.end());
    const std::size_t others = faces.size() - largest, kept = count - largest;
    for (std::size_t k = 0; k < kept; ++k) faces[largest + k] = faces[largest + k * others / kept];
    faces.resize(count);
    return faces;
}

/// Half of the area of the boxes of some faces in a frame, m^2; stops above `limit`.
double area_of_boxes(const Scene& scene, std::span<const SurfaceId> faces, const TracingFrame& frame, double limit) {
    double sum = 0;
    for (const SurfaceId s : faces) {
        Box box;
        for (const Point& p : scene.outline(s)) box.add(frame(p));
        sum += box.half_area();
        if (sum > limit) break;
    }
    return sum;
}

/// Adds the frames of a face's edges.
void add_candidates(const Scene& scene, SurfaceId s, std::vector<TracingFrame>& candidates) {
    const Normal& n = scene.surfaces()[s].normal;
    const std::span<const Point> outline = scene.outline(s);
    constexpr std::size_t max_edges = 4;
    for (std::size_t i = 0; i < std::min(outline.size(), max_edges); ++i) {
        const Vec3 edge = outline[(i + 1) % outline.size()] - outline[i], across = cross(n, edge);
        if (!(squared_norm(across) > 0)) continue;
        const Normal y = normalized(across);
        const TracingFrame frame{cross(y, n), y, n, true};
        if (candidates.size() == max_candidates) return;
        if (std::none_of(candidates.begin(), candidates.end(), [&](const auto& c) { return is_same(c, frame); }))
            candidates.push_back(frame);
    }
}

}  // namespace

TracingFrame find_tracing_frame(const Scene& scene) {
    const std::vector<SurfaceId> faces = choose_faces(scene, max_compared_faces);
    std::vector<TracingFrame> candidates{TracingFrame()};
    for (std::size_t k = 0; k < std::min(faces.size(), max_giving_faces); ++k)
        add_candidates(scene, faces[k], candidates);
    TracingFrame best;
    double least = required_share * area_of_boxes(scene, faces, best, HUGE_VAL);
    for (const TracingFrame& frame : std::span(candidates).subspan(1))
        if (const double area = area_of_boxes(scene, faces, frame, least); area < least) least = area, best = frame;
    return best;
}

}  // namespace exitance
