#include "exitance/io/solution/stored_scene_check.hpp"

namespace exitance {
namespace {

constexpr double max_value = 1e60;  ///< Limit of coordinates and exitances; squares of areas stay finite.
constexpr double tolerance = 1e-3;  ///< Relative; faces of one region may be tilted by this much (Tolerances::tilt).

bool is_sane(const Point& p) {
    return std::abs(p.x) < max_value && std::abs(p.y) < max_value && std::abs(p.z) < max_value;
}

bool is_sane(const Material& material) {
    bool sane = true;
    for (std::size_t b = 0; b < bands; ++b)
        sane &= material.reflectance[b] >= 0 && material.reflectance[b] < 1 && material.exitance[b] >= 0 &&
                material.exitance[b] < max_value;
    return sane;
}

/// True if a face's area and normal match its corners and it is in the plane of its region.
bool is_sane(const Scene& scene, SurfaceId s) {
    const Surface& face = scene.surfaces()[s];
    const std::span<const Point> outline = scene.outline(s);
    const Vec3 area = area_vector(outline);
    if (!(face.area > 0) || !(std::abs(norm(area) - face.area) <= tolerance * face.area)) return false;
    if (!(dot(area, face.normal) >= (1 - tolerance) * face.area)) return false;
    const Region& region = scene.regions()[face.region];
    if (face.material != region.material || !(dot(face.normal, region.plane.n) > 1 - tolerance)) return false;
    for (const Point& p : outline)
        if (!(std::abs(region.plane.signed_distance(p)) <= tolerance * scene.size())) return false;
    return true;
}

/// True if a region's area matches its loops and these are in its plane.
bool is_sane(const Scene& scene, RegionId r) {
    const Region& region = scene.regions()[r];
    if (!(region.area > 0) || !(std::abs(norm(region.plane.n) - 1) <= 1e-6)) return false;
    double area = 0;
    for (const auto& loop : region.loops) {
        area += dot(area_vector(loop), region.plane.n);
        for (const Point& p : loop)
            if (!is_sane(p) || !(std::abs(region.plane.signed_distance(p)) <= tolerance * scene.size())) return false;
    }
    if (!(std::abs(area - region.area) <= tolerance * region.area)) return false;
    for (SurfaceId s : region.surfaces)
        if (scene.surfaces()[s].region != r) return false;
    return true;
}

}  // namespace

std::optional<std::string> find_nonsense(const ElementTree& tree, const Scene& scene) {
    const double slack = tolerance * scene.size();
    const Point lo = scene.box().lo - Vec3{slack, slack, slack}, hi = scene.box().hi + Vec3{slack, slack, slack};
    for (ElementId root : tree.roots()) {
        const Patch& patch = tree.patch(root);
        for (int i = 0; i < patch.corner_count(); ++i) {
            const Point p = patch.corner(i);
            const bool inside = min(p, lo) == lo && max(p, hi) == hi;
            const Plane& plane = scene.regions()[tree.region(root)].plane;
            if (!inside || !(std::abs(plane.signed_distance(p)) <= slack))
                return "the patch of root " + std::to_string(root.value) + " does not lie on its region";
        }
    }
    return {};
}

std::optional<std::string> find_nonsense(const Scene& scene) {
    const Box& box = scene.box();
    if (!is_sane(box.lo) || !is_sane(box.hi) || !(scene.size() > 0) || min(box.lo, box.hi) != box.lo)
        return "the box is invalid";
    const double slack = tolerance * scene.size();
    for (const Material& m : scene.materials())
        if (!is_sane(m)) return "material '" + m.name + "' has an impossible reflectance or emission";
    for (SurfaceId s : scene.surfaces().ids()) {
        for (const Point& p : scene.outline(s))
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (!(p[axis] >= box.lo[axis] - slack && p[axis] <= box.hi[axis] + slack))
                    return "face " + std::to_string(s.value) + " lies outside the scene's box";
        if (!is_sane(scene, s))
            return "face " + std::to_string(s.value) + " does not match its area, plane or material";
    }
    for (RegionId r : scene.regions().ids())
        if (!is_sane(scene, r)) return "region " + std::to_string(r.value) + " does not match its borders and faces";
    for (const PunctualLight& light : scene.lights())
        if (!is_sane(light.position)) return "light '" + light.name + "' is too far away";
    return {};
}

}  // namespace exitance
