#include "exitance/evaluate/surface_levels.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/triangulation.hpp"
#include "exitance/transport/open_points.hpp"

namespace exitance {
namespace {

/// Radical inverse of i in base 2, in [0, 1).
double mirrored(std::uint32_t i) {
    double out = 0, digit = 0.5;
    for (; i > 0; i >>= 1, digit *= 0.5) out += (i & 1u) * digit;
    return out;
}

/// Points of a face, one in each of `count` shares of equal area.
std::vector<Point> spread(std::span<const Point> outline, const Normal& n, std::size_t count) {
    struct Triangle {
        Point a, b, c;
        double area;
    };
    std::vector<Triangle> triangles;
    double area = 0;
    for (const auto& [i, j, k] : triangulate(outline, n)) {
        triangles.push_back(
            {outline[i], outline[j], outline[k], 0.5 * norm(cross(outline[j] - outline[i], outline[k] - outline[i]))});
        area += triangles.back().area;
    }
    std::vector<Point> points;
    std::size_t t = 0;
    double before = 0;  // area of the triangles before t
    for (std::size_t i = 0; i < count && !triangles.empty(); ++i) {
        const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(count) * area;
        while (t + 1 < triangles.size() && at >= before + triangles[t].area) before += triangles[t++].area;
        const Triangle& of = triangles[t];
        const double s = std::sqrt(std::clamp((at - before) / of.area, 0.0, 1.0));
        const double r = mirrored(static_cast<std::uint32_t>(i));
        points.push_back(of.a + s * (1 - r) * (of.b - of.a) + s * r * (of.c - of.a));
    }
    return points;
}

}  // namespace

std::vector<SurfacePoints> measure_surfaces(const RadiosityFunction& light, std::span<const SurfaceId> faces,
                                            std::size_t total, Progress& progress, const StopRequest& stop) {
    progress.phase("measure");
    const Scene& scene = light.solution().scene;
    double area = 0;
    for (const SurfaceId s : faces) area += scene.surfaces()[s].area;
    std::vector<SurfacePoints> out(faces.size());
    constexpr std::size_t at_once = 64;
    for (std::size_t first = 0; first < faces.size() && !stop.requested(); first += at_once) {
        progress.advance(static_cast<double>(first) / static_cast<double>(faces.size()));
        const std::size_t last = std::min(first + at_once, faces.size());
        std::vector<ProbePoint> points;
        std::vector<std::size_t> face_of;
        for (std::size_t f = first; f < last; ++f) {
            const Surface& face = scene.surfaces()[faces[f]];
            out[f].surface = faces[f];
            const double share = face.area / area * static_cast<double>(total);
            const auto count = static_cast<std::size_t>(std::clamp(std::ceil(share), 16.0, 1024.0));
            const Point middle = centroid(scene.outline(faces[f]));
            for (const Point& p : spread(scene.outline(faces[f]), face.normal, count))
                points.push_back({light.places().find(p, face.normal, &middle).x, face.normal}), face_of.push_back(f);
        }
        std::vector<std::uint8_t> open(points.size());
        parallel_for(points.size(), 64, [&](std::size_t i) {
            const RegionId region = scene.surfaces()[faces[face_of[i]]].region;
            open[i] = is_in_open(light.stage(), points[i].x, points[i].n, region);
        });
        const std::vector<Light> found = light.at_until(stop, points);
        if (found.size() < points.size()) break;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (open[i] && found[i].on_surface) out[face_of[i]].light.push_back(found[i]);
    }
    return out;
}

}  // namespace exitance
