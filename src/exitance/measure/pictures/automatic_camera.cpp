#include "exitance/measure/pictures/automatic_camera.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "exitance/mesh/element_locator.hpp"

namespace exitance {
namespace {

/// Statistics of a camera's view, from a few hundred rays.
struct Outlook {
    double fronts = 0, backs = 0;  ///< Shares of the rays that hit fronts and backs.
    double lit = 0;                ///< Share of the rays that hit a front bright enough to be visible.
    double breadth = 0;            ///< Sum of the distances to fronts, in sizes of the scene, over the number of rays.
    double variety = 0;            ///< Standard deviation of the logarithm of the visible light, without emitters.
    double blocked = 0;            ///< Share of the rays that hit surfaces much nearer than the target.
    double planes = 0;             ///< Number of different planes seen: a bare corner has three.

    double quality() const {
        return lit * breadth * (0.3 + std::min(variety, 1.0)) * (1 - blocked) * std::log2(1 + planes);
    }
    /// Quality of a view from outside: dark fronts count little, and backs reduce it, as they hide surfaces behind
    /// them.
    double quality_outside() const {
        constexpr double weight_of_dark = 0.05;
        return (lit + weight_of_dark * fronts) * (0.5 + std::min(variety, 1.0)) * fronts /
               std::max(fronts + backs, 1e-9);
    }
};

/// Evaluates possible views of a solution.
class Scout {
  public:
    Scout(const Solution& solution, const RayTracer& tracer)
        : solution_(solution), tracer_(tracer), locator_(solution.interpolant.tree, solution.scene.regions().size()) {
        double power = 0, area = 0;
        for (const ElementId leaf : leaves()) power += power_of(leaf), area += solution.interpolant.tree.area(leaf);
        constexpr double worth_seeing = 0.03;  // share of the mean radiosity; darker surfaces appear black
        min_light_ = area > 0 ? worth_seeing * power / area : 0;
    }

    Outlook look(const Camera& camera, PictureSize coarse) const {
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
        Outlook view;
        std::set<RegionId> regions;
        double lit = 0, sum = 0, squares = 0;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            if (hits[i].surface.is_none()) continue;
            if (!hits[i].front) {
                view.backs += 1;
                continue;
            }
            regions.insert(hits[i].region);
            view.fronts += 1, view.breadth += hits[i].distance / solution_.scene.size();
            if (hits[i].distance < near) view.blocked += 1;
            const double light = light_at(hits[i].surface, origins[i] + hits[i].distance * directions[i]);
            const double emitted = mean(solution_.scene.material(hits[i].surface).exitance);
            if (light + emitted > min_light_) view.lit += 1;
            if (light > 0) lit += 1, sum += std::log(light), squares += std::log(light) * std::log(light);
        }
        view.planes = static_cast<double>(regions.size());
        const double all = static_cast<double>(hits.size());
        if (lit > 0) view.variety = std::sqrt(std::max(0.0, squares / lit - sum / lit * (sum / lit)));
        view.fronts /= all, view.backs /= all, view.lit /= all, view.breadth /= all, view.blocked /= all;
        return view;
    }

    /// True if few rays from a point leave the scene, as in a room with windows and open doors.
    bool is_enclosed(const Point& eye) const {
        constexpr double min_fronts = 0.85;  // share of all directions in which a front is visible
        Camera around{eye, eye + Vec3{0, 1, 0}, 360};
        around.projection = Projection::panorama;
        return look(around, {24, 12}).fronts >= min_fronts;
    }

    /// At most `count` points at eye level in front of the surfaces that send most light.
    std::vector<Point> places_in_light(std::size_t count) const {
        const ElementTree& tree = solution_.interpolant.tree;
        double all = 0;
        for (const ElementId leaf : leaves()) all += power_of(leaf);
        std::vector<Point> out;
        double sum = 0;
        for (const ElementId leaf : leaves()) {
            sum += power_of(leaf);
            if (!(sum > all * (static_cast<double>(out.size()) + 0.5) / static_cast<double>(count))) continue;
            const Normal& n = solution_.scene.regions()[tree.region(leaf)].plane.n;
            const Point start = tree.patch(leaf).centre() + 1e-6 * solution_.scene.size() * n;
            RayHit hit;
            tracer_.nearest(std::span(&start, 1), std::span<const Vec3>(&n, 1), RegionId(), std::span(&hit, 1));
            const double free = hit.surface.is_none() ? solution_.scene.size() : hit.distance;
            out.push_back(at_eye_level(start + 0.5 * free * n));
            if (out.size() == count) break;
        }
        return out;
    }

  private:
    /// The place on the vertical through a point that is at eye level above the surface below, or lower if there is
    /// less space.
    Point at_eye_level(const Point& p) const {
        constexpr double eyes = 1.6;  // metres
        const Vec3 down{0, 0, -1};
        RayHit floor, ceiling;
        tracer_.nearest(std::span(&p, 1), std::span<const Vec3>(&down, 1), RegionId(), std::span(&floor, 1));
        if (floor.surface.is_none()) return p;
        const Vec3 up = -down;
        tracer_.nearest(std::span(&p, 1), std::span<const Vec3>(&up, 1), RegionId(), std::span(&ceiling, 1));
        const double free = floor.distance + (ceiling.surface.is_none() ? eyes : ceiling.distance);
        return p + (floor.distance - std::min(0.6 * free, eyes)) * down;
    }
    /// Reflected light, W/m^2; 0 on emitters.
    double light_at(SurfaceId surface, const Point& p) const {
        const Material& material = solution_.scene.material(surface);
        if (material.emits()) return 0;
        const ElementTree::Place place = locator_.find(solution_.scene.surfaces()[surface].region, p);
        return place.element.is_none() ? 0 : mean(material.reflectance * solution_.interpolant.at(place));
    }

    std::vector<ElementId> leaves() const { return solution_.interpolant.tree.leaves(); }
    /// Power that leaves an element, mean over the bands, W.
    double power_of(ElementId leaf) const {
        const ElementTree& tree = solution_.interpolant.tree;
        const Material& material = solution_.scene.material(tree.region(leaf));
        return tree.area(leaf) *
               mean(material.exitance + material.reflectance * solution_.interpolant.at({leaf, {0.5, 0.5}}));
    }

    const Solution& solution_;
    const RayTracer& tracer_;
    ElementLocator locator_;
    double min_light_ = 0;  ///< W/m^2
};

/// Returns the best camera in a closed room: near the four vertical edges of the scene's box, at eye level or higher,
/// looking towards its middle; at places with light; or outside an open side. None if no such camera sees almost only
/// fronts, with light on a third of them.
std::optional<Camera> camera_inside(const Scene& scene, const Scout& scout, PictureSize size) {
    constexpr double min_fronts = 0.95;  // share of fronts in a room: the rest may be windows and open doors
    constexpr double min_lit = 1.0 / 3;
    const Box& box = scene.box();
    const Vec3 extent = box.size();
    const double height = std::min(extent.z, 3.0);  // metres; limited, so that a high hall is viewed like a room
    const double fov = size.width >= size.height ? 75 : 55;
    std::optional<Camera> best;
    double best_quality = 0;
    const auto consider = [&](const Camera& camera) {
        const Outlook view = scout.look(camera, {24, 15});
        if (view.fronts >= min_fronts && view.lit >= min_lit && view.quality() > best_quality)
            best = camera, best_quality = view.quality();
    };
    for (const double inset : {0.06, 0.15, 0.25, 0.35}) {  // a room may not extend into the corners of its box
        for (int corner = 0; corner < 4; ++corner)
            for (const double level : {0.55, 0.68, 0.8}) {
                const double s = corner & 1 ? 1 - inset : inset, t = corner & 2 ? 1 - inset : inset;
                const Point eye = box.lo + Vec3{s * extent.x, t * extent.y, level * height};
                if (scout.is_enclosed(eye))
                    consider({eye, {box.centre().x, box.centre().y, box.lo.z + 0.4 * height}, fov});
            }
        if (best) break;
    }
    for (const Point& eye : scout.places_in_light(24)) {
        if (!scout.is_enclosed(eye)) continue;
        for (int step = 0; step < 8; ++step) {
            const double a = 45 * step * degree, ahead = 0.3 * std::max({extent.x, extent.y, extent.z});
            consider({eye, eye + ahead * Vec3{std::cos(a), std::sin(a), -0.1}, fov});
        }
    }
    for (int side = 0; side < 4; ++side) {
        const Vec3 out = side < 2 ? Vec3{side == 0 ? -1.0 : 1.0, 0, 0} : Vec3{0, side == 2 ? -1.0 : 1.0, 0};
        const double depth = side < 2 ? extent.x : extent.y, width = side < 2 ? extent.y : extent.x;
        const double seen =
            std::min(width, extent.z * size.width / size.height);  // width that the picture shows, metres
        const double away = 0.5 * seen * 0.98 / std::tan(20 * degree);
        consider({box.centre() + (0.5 * depth + away) * out, box.centre(), 40});
    }
    return best;
}

/// Camera looking at the centre of a box from the distance at which the box fills the picture. `back`: unit vector from
/// the centre to the camera.
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

/// Bounding box of the objects on a scene's ground, with some ground around them, if the ground is much wider; else
/// that of the scene.
Box worth_showing(const Scene& scene) {
    const Box& all = scene.box();
    const double low = all.lo.z + 0.01 * all.size().z;
    Box things;
    for (const SurfaceId s : scene.surfaces().ids()) {
        const auto outline = scene.outline(s);
        const bool is_ground = std::all_of(outline.begin(), outline.end(), [&](const Point& p) { return p.z <= low; });
        if (!is_ground)
            for (const Point& p : outline) things.add(p);
    }
    constexpr double much_wider = 3;
    if (things.is_empty()) return all;
    things.lo.z = all.lo.z;
    const double around = std::max(0.3 * std::max(things.size().x, things.size().y), things.size().z);
    things = {max(things.lo - Vec3{around, around, 0}, all.lo), min(things.hi + Vec3{around, around, 0}, all.hi)};
    return all.diagonal() < much_wider * things.diagonal() ? all : things;
}

/// Returns a camera on the side of a scene that shows most light and fewest backs.
Camera camera_outside(const Scene& scene, const Scout& scout, PictureSize size) {
    Camera best;
    double most = -1;
    const Box box = worth_showing(scene);
    for (const int elevation : {25, 50, -8, -25, -50})
        for (int step = 0; step < 8; ++step) {
            const double a = (45 * step - 60) * degree, e = elevation * degree;
            const Camera camera =
                camera_at(box, {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)}, 40, size);
            const Outlook view = scout.look(camera, {24, 24 * size.height / size.width + 1});
            const double quality = view.quality_outside();
            if (quality > most) best = camera, most = quality;
        }
    return best;
}

/// Returns a panoramic camera at a place with a wide view: in the middle of the scene, near it, or where light is.
Camera camera_amid(const Scene& scene, const Scout& scout) {
    const Box& box = scene.box();
    const double height = std::min(0.55 * box.size().z, 1.6);  // eye level, metres
    Camera best;
    double most = -1;
    const auto consider = [&](const Point& eye, double off) {
        Camera camera{eye, eye + Vec3{0, 1, 0}, 360};
        camera.projection = Projection::panorama;
        const Outlook view = scout.look(camera, {24, 12});
        constexpr double weight_of_dark = 0.05;
        const double quality = (view.lit + weight_of_dark * view.fronts) * view.breadth * (1 - off);
        if (quality > most) best = camera, most = quality;
    };
    for (const double s : {0.5, 0.35, 0.65, 0.2, 0.8})
        for (const double t : {0.5, 0.35, 0.65, 0.2, 0.8})
            consider({box.lo.x + s * box.size().x, box.lo.y + t * box.size().y, box.lo.z + height},
                     std::hypot(s - 0.5, t - 0.5));
    constexpr double corner = 0.7;  // treat these positions as equally far from the middle as the corners of the box
    for (const Point& eye : scout.places_in_light(24)) consider(eye, corner);
    return best;
}

/// Plan view of a room from just below its ceiling.
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
