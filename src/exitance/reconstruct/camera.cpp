#include "exitance/reconstruct/camera.hpp"

#include <optional>
#include <vector>

namespace exitance {
namespace {

constexpr double degree = pi / 180;

/// What a camera has in view, by a few hundred rays.
struct View {
    double fronts = 0;   ///< Share of the rays that meet a front.
    double breadth = 0;  ///< Their distances, in sizes of the scene, added up and divided by all rays.
};

View look(const Scene& scene, const RayTracer& tracer, const Camera& camera) {
    constexpr PictureSize coarse{24, 15};
    const CameraRays rays(camera, coarse);
    std::vector<Vec3> directions;
    for (int y = 0; y < coarse.height; ++y)
        for (int x = 0; x < coarse.width; ++x) directions.push_back(normalized(rays.direction(x + 0.5, y + 0.5)));
    std::vector<RayHit> hits(directions.size());
    tracer.nearest(directions, camera.eye, RegionId(), hits);
    View view;
    for (const RayHit& hit : hits)
        if (!hit.surface.is_none() && hit.front) view.fronts += 1, view.breadth += hit.distance / scene.size();
    const double all = static_cast<double>(hits.size());
    return {view.fronts / all, view.breadth / all};
}

/// From near the four upright edges of the scene's box, above head height, towards its middle.
std::optional<Camera> camera_inside(const Scene& scene, const RayTracer& tracer) {
    constexpr double closed = 0.95;  // share of fronts that makes a room: the rest may be windows and open doors
    const Box& box = scene.box();
    const Vec3 size = box.size();
    const double height = std::min(size.z, 3.0);  // metres; in a hall one looks as in a room
    for (const double inset : {0.06, 0.15, 0.25, 0.35}) {  // a room need not reach into the corners of its box
        std::optional<Camera> best;
        double best_breadth = 0;
        for (int corner = 0; corner < 4; ++corner) {
            const double s = corner & 1 ? 1 - inset : inset, t = corner & 2 ? 1 - inset : inset;
            const Camera camera{box.lo + Vec3{s * size.x, t * size.y, 0.68 * height},
                                {box.centre().x, box.centre().y, box.lo.z + 0.36 * height},
                                75};
            const View view = look(scene, tracer, camera);
            if (view.fronts >= closed && view.breadth > best_breadth) best = camera, best_breadth = view.breadth;
        }
        if (best) return best;
    }
    return std::nullopt;
}

Camera camera_outside(const Scene& scene, const RayTracer& tracer, PictureSize size) {
    constexpr double fov = 40;
    const double half_width = std::tan(0.5 * fov * degree);
    const double half_height = half_width * size.height / size.width;
    const double distance = 0.5 * scene.size() / std::sin(std::atan(std::min(half_width, half_height)));
    Camera best;
    double most = -1;
    for (int elevation : {25, 50, -25})
        for (int step = 0; step < 8; ++step) {
            const double a = (45 * step - 60) * degree, e = elevation * degree;
            const Vec3 back{std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
            const Point middle = scene.box().centre();
            const Camera camera{middle + distance * back, middle, fov};
            if (const double fronts = look(scene, tracer, camera).fronts; fronts > most) best = camera, most = fronts;
        }
    return best;
}

}  // namespace

CameraRays::CameraRays(const Camera& camera, PictureSize size) {
    const Vec3 ahead = normalized(camera.target - camera.eye);
    const Vec3 up = std::abs(ahead.z) < 0.9999 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};  // straight up or down: north is up
    const Vec3 right = normalized(cross(ahead, up)), down = cross(ahead, right);
    const double half_width = std::tan(0.5 * camera.fov * degree), pixel = 2 * half_width / size.width;
    right_ = pixel * right;
    down_ = pixel * down;
    corner_ = ahead - half_width * right - 0.5 * size.height * down_;
}

Camera automatic_camera(const Scene& scene, const RayTracer& tracer, PictureSize size) {
    if (const std::optional<Camera> inside = camera_inside(scene, tracer)) return *inside;
    return camera_outside(scene, tracer, size);
}

}  // namespace exitance
