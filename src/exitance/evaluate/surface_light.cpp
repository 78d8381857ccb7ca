#include "exitance/evaluate/surface_light.hpp"

#include "exitance/base/bvh.hpp"

namespace exitance {
namespace {

/// Clips a face to a convex leaf; the result may have edges that coincide in opposite directions along the leaf's
/// edges.
void clip_to_leaf(std::span<const Point> face, const std::vector<Point>& leaf, const Normal& n,
                  std::vector<Point>& out) {
    out.assign(face.begin(), face.end());
    std::vector<Point> rest;
    for (std::size_t i = 0; i < leaf.size() && !out.empty(); ++i) {
        const Vec3 edge = leaf[(i + 1) % leaf.size()] - leaf[i];
        const double length = norm(edge);
        if (!(length > 0)) continue;
        const Normal inwards = cross(n, edge) / length;
        clip(out, {inwards, dot(inwards, leaf[i])}, rest);
        out.swap(rest);
    }
}

}  // namespace

Spectrum integral(const ElementFunction& function, ElementId leaf, std::span<const Point> outline, const Normal& n) {
    const Patch& patch = function.tree.patch(leaf);
    Spectrum sum;
    for (std::size_t i = 2; i < outline.size(); ++i) {
        const Point corner[3] = {outline[0], outline[i - 1], outline[i]};
        const double area = 0.5 * dot(n, cross(corner[1] - corner[0], corner[2] - corner[0]));  // signed
        for (int k = 0; k < 3; ++k) {
            const Point middle = 0.5 * (corner[k] + corner[(k + 1) % 3]);
            sum += (area / 3) * function.at({leaf, patch.coordinates(middle)});
        }
    }
    return sum;
}

Field<SurfaceId, SurfaceLight> mean_light(const Solution& solution) {
    const Scene& scene = solution.scene;
    const ElementTree& tree = solution.interpolant.tree;
    Field<SurfaceId, SurfaceLight> light(scene.surfaces().size());
    Field<RegionId, Bvh> faces(scene.regions().size());  // trees of the faces of regions that consist of several faces
    for (RegionId r : scene.regions().ids()) {
        const std::vector<SurfaceId>& members = scene.regions()[r].surfaces;
        if (members.size() < 2) continue;
        std::vector<Box> boxes(members.size());
        for (std::size_t i = 0; i < members.size(); ++i)
            for (const Point& p : scene.outline(members[i])) boxes[i].add(p);
        faces[r] = Bvh(boxes);
    }

    std::vector<Point> part;
    for (ElementId e : tree.ids()) {
        if (!tree.is_leaf(e)) continue;
        const Region& region = scene.regions()[tree.region(e)];
        const std::vector<Point> outline = tree.outline(e);
        if (region.surfaces.size() < 2) {
            light[region.surfaces.front()].irradiance += integral(solution.interpolant, e, outline, region.plane.n);
            continue;
        }
        Box box;
        for (const Point& p : outline) box.add(p);
        const Vec3 rounding = Vec3{1, 1, 1} * (1e-9 * scene.size());  // derived from the rounding of positions
        box.lo -= rounding, box.hi += rounding;
        faces[tree.region(e)].visit_box(box, [&](std::uint32_t i) {
            const SurfaceId s = region.surfaces[i];
            clip_to_leaf(scene.outline(s), outline, region.plane.n, part);
            light[s].irradiance += integral(solution.interpolant, e, part, region.plane.n);
        });
    }
    for (SurfaceId s : scene.surfaces().ids()) {
        light[s].irradiance *= 1 / scene.surfaces()[s].area;
        light[s].radiosity = scene.material(s).exitance + scene.material(s).reflectance * light[s].irradiance;
    }
    return light;
}

}  // namespace exitance
