#include "exitance/reconstruct/pictures/automatic_camera.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include "exitance/mesh/element_locator.hpp"

namespace exitance {
namespace {

constexpr double degree = pi / 180;

/// What a camera has in view, by a few hundred rays.
struct View {
    double fronts = 0;   ///< Share of the rays that meet a front.
    double breadth = 0;  ///< Their distances, in sizes of the scene, added up and divided by all rays.
    double variety = 0;  ///< Standard deviation of the logarithm of the light that they show, emitters left out.
    double blocked = 0;  ///< Share that meets something much nearer than the target.
    double quality() const { return breadth * (0.3 + std::min(variety, 1.0)) * (1 - blocked); }
};

/// Looks around in a solution.
class Scout {
  public:
    Scout(const Solution& solution, const RayTracer& tracer)
        : solution_(solution), tracer_(tracer), locator_(solution.interpolant.tree, solution.scene.regions().size()) {}

    View look(const Camera& camera, PictureSize coarse) const {
        const CameraRays rays(camera, coarse);
        std::vector<Point> origins;
        std::vector<Vec3> directions;
        Point origin;
        Vec3 direction;
        for (int y = 0; y < coarse.height; ++y)
            for (int x = 0; x < coarse.width; ++x)
                if (rays.ray(x + 0.5, y + 0.5, origin, direction))
                    origins.push_back(origin), directions.push_back(normalized(direction));
        std::vector<RayHit> hits(directions.size());
        tracer_.nearest(origins, directions, RegionId(), hits);
        const double near = 0.3 * norm(camera.target - camera.eye);
        View view;
        double lit = 0, sum = 0, squares = 0;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            if (hits[i].surface.is_none() || !hits[i].front) continue;
            view.fronts += 1, view.breadth += hits[i].distance / solution_.scene.size();
            if (hits[i].distance < near) view.blocked += 1;
            const double light = light_at(hits[i].surface, origins[i] + hits[i].distance * directions[i]);
            if (light > 0) lit += 1, sum += std::log(light), squares += std::log(light) * std::log(light);
        }
        const double all = static_cast<double>(hits.size());
        if (lit > 0) view.variety = std::sqrt(std::max(0.0, squares / lit - sum / lit * (sum / lit)));
        view.fronts /= all, view.breadth /= all, view.blocked /= all;
        return view;
    }

  private:
    /// Reflected light, W/m^2; 0 on emitters.
    double light_at(SurfaceId surface, const Point& p) const {
        const Material& material = solution_.scene.material(surface);
        if (material.emits()) return 0;
        const ElementTree::Place place = locator_.find(solution_.scene.surfaces()[surface].region, p);
        return place.element.is_none() ? 0 : mean(material.reflectance * solution_.interpolant.at(place));
    }

    const Solution& solution_;
    const RayTracer& tracer_;
    ElementLocator locator_;
};

/// The best camera in a closed room: from near the four upright edges of the scene's box, at the height of eyes or
/// above, towards its middle, or from outside through a side that is open. None where no camera sees fronts alone.
std::optional<Camera> camera_inside(const Scene& scene, const Scout& scout, PictureSize size) {
    constexpr double closed = 0.95;  // share of fronts that makes a room: the rest may be windows and open doors
    const Box& box = scene.box();
    const Vec3 extent = box.size();
    const double height = std::min(extent.z, 3.0);  // metres; in a hall one looks as in a room
    const double fov = size.width >= size.height ? 75 : 55;
    std::optional<Camera> best;
    double best_quality = 0;
    const auto consider = [&](const Camera& camera) {
        const View view = scout.look(camera, {24, 15});
        if (view.fronts >= closed && view.quality() > best_quality) best = camera, best_quality = view.quality();
    };
    for (const double inset : {0.06, 0.15, 0.25, 0.35}) {  // a room need not reach into the corners of its box
        for (int corner = 0; corner < 4; ++corner)
            for (const double level : {0.55, 0.68, 0.8}) {
                const double s = corner & 1 ? 1 - inset : inset, t = corner & 2 ? 1 - inset : inset;
                consider({box.lo + Vec3{s * extent.x, t * extent.y, level * height},
                          {box.centre().x, box.centre().y, box.lo.z + 0.4 * height},
                          fov});
            }
        if (best) break;
    }
    for (int side = 0; side < 4; ++side) {
        const Vec3 out = side < 2 ? Vec3{side == 0 ? -1.0 : 1.0, 0, 0} : Vec3{0, side == 2 ? -1.0 : 1.0, 0};
        const double depth = side < 2 ? extent.x : extent.y, width = side < 2 ? extent.y : extent.x;
        const double seen = std::min(width, extent.z * size.width / size.height);  // across the opening, metres
        const double away = 0.5 * seen * 0.98 / std::tan(20 * degree);
        consider({box.centre() + (0.5 * depth + away) * out, box.centre(), 40});
    }
    return best;
}

/// From so far that the scene's box fills the picture, towards its middle.
Camera camera_at(const Box& box, const Vec3& back, double fov, PictureSize size) {
    const double half_width = std::tan(0.5 * fov * degree), half_height = half_width * size.height / size.width;
    const Vec3 right = normalized(cross(back, {0, 0, -1})), up = cross(back, right);
    double distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 half = 0.5 * box.size();
        const Vec3 p = {corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z};
        const double aside = std::max(std::abs(dot(p, right)) / half_width, std::abs(dot(p, up)) / half_height);
        distance = std::max(distance, dot(p, back) + 1.04 * aside);
    }
    return {box.centre() + distance * back, box.centre(), fov};
}

/// On the side of a scene that shows most fronts and most variety of light.
Camera camera_outside(const Scene& scene, const Scout& scout, PictureSize size) {
    Camera best;
    double most = -1;
    for (const int elevation : {25, 50, -25})
        for (int step = 0; step < 8; ++step) {
            const double a = (45 * step - 60) * degree, e = elevation * degree;
            const Camera camera =
                camera_at(scene.box(), {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)}, 40, size);
            const View view = scout.look(camera, {24, 24 * size.height / size.width + 1});
            const double quality = view.fronts * (0.5 + std::min(view.variety, 1.0));
            if (quality > most) best = camera, most = quality;
        }
    return best;
}

/// Where one can look around: from the middle of the scene or near it, not from within something.
Camera camera_amid(const Scene& scene, const Scout& scout) {
    const Box& box = scene.box();
    const double height = std::min(0.55 * box.size().z, 1.6);  // metres: of eyes
    Camera best;
    double most = -1;
    for (const double s : {0.5, 0.35, 0.65, 0.2, 0.8})
        for (const double t : {0.5, 0.35, 0.65, 0.2, 0.8}) {
            const Point eye = {box.lo.x + s * box.size().x, box.lo.y + t * box.size().y, box.lo.z + height};
            Camera camera{eye, eye + Vec3{0, 1, 0}, 360};
            camera.projection = Projection::panorama;
            const View view = scout.look(camera, {24, 12});
            const double off = std::hypot(s - 0.5, t - 0.5);
            const double quality = view.fronts * view.breadth * (1 - off);
            if (quality > most) best = camera, most = quality;
        }
    return best;
}

/// A plan of a room, seen from below its ceiling.
Camera plan(const Scene& scene, PictureSize size) {
    const Vec3 extent = scene.box().size();
    Point eye = scene.box().centre();
    eye.z = scene.box().lo.z + 0.95 * extent.z;
    return {eye, eye - Vec3{0, 0, 1}, 1.02 * std::max(extent.x, extent.y * size.width / size.height)};
}

}  // namespace

Camera automatic_camera(const Solution& solution, const RayTracer& tracer, Projection projection, PictureSize size) {
    const Scene& scene = solution.scene;
    const Scout scout(solution, tracer);
    if (projection == Projection::panorama) return camera_amid(scene, scout);
    const std::optional<Camera> inside = camera_inside(scene, scout, size);
    Camera camera = inside ? *inside : camera_outside(scene, scout, size);
    if (projection == Projection::orthographic) {
        if (inside)
            camera = plan(scene, size);
        else
            camera.fov = scene.size() * std::max(1.0, static_cast<double>(size.width) / size.height);
    }
    if (projection == Projection::fisheye) camera.fov = 180;
    camera.projection = projection;
    return camera;
}

}  // namespace exitance
