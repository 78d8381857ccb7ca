#include "exitance/io/scenes/textures/normal_file.hpp"

#include <algorithm>

#include "exitance/base/triangulation.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/gltf/gltf_model.hpp"
#include "exitance/io/scenes/textures/obj_match.hpp"
#include "exitance/scene/face_parts.hpp"
#include "exitance/scene/locator.hpp"

namespace exitance {
namespace {

/// Adds a triangle if all of its normals have a length, reversed if they point to its back.
void add_triangle(NormalTriangle triangle, const Normal& front, std::vector<NormalTriangle>& out) {
    Vec3 sum;
    for (Vec3& n : triangle.normal) {
        const double length = norm(n);
        if (!(length > 0)) return;
        n = n / length, sum += n;
    }
    if (dot(sum, front) < 0)
        for (Vec3& n : triangle.normal) n = -1 * n;
    out.push_back(triangle);
}

std::vector<NormalTriangle> load_gltf_normals(const Scene& scene, const std::string& path) {
    std::vector<NormalTriangle> out;
    std::vector<Finding> findings;  // reported when the scene was read for solving
    const Result<GltfModel> model = load_gltf_model(path, findings, true);
    if (!model) return out;
    const Locator locator(scene);
    const FaceParts parts(scene);
    for_each_triangle(*model, [&](const GltfTriangle& triangle) {
        if (triangle.primitive->normals.size() == 0) return;
        const std::array<Point, 3>& c = triangle.corners;
        const Normal n = normalized(cross(c[1] - c[0], c[2] - c[0]));
        for (const Normal& front : {n, Normal(-1 * n)}) {
            for (const SurfaceId part : parts.find(locator, c, front))
                add_triangle({part, c, triangle.normals}, front, out);
        }
    });
    return out;
}

std::vector<NormalTriangle> load_obj_normals(const Scene& scene, const std::string& path) {
    std::vector<NormalTriangle> out;
    Result<std::vector<ObjPlaces>> faces = read_obj_places(path);
    if (!faces) return out;
    if (std::all_of(faces->begin(), faces->end(), [](const ObjPlaces& face) { return face.normals.empty(); }))
        return out;
    const ObjMatch match(scene, std::move(*faces));
    if (!match.is_aligned()) return out;
    for (const SurfaceId s : scene.surfaces().ids()) {
        const ObjPlaces* face = match.face_of(s);
        if (!face || face->normals.empty()) continue;
        const std::optional<std::vector<CornerMean>> corners = match.corners(s);
        if (!corners) return {};
        std::vector<Vec3> normals;
        std::vector<Point> outline(scene.outline(s).begin(), scene.outline(s).end());
        if (scene.surfaces()[s].whole > 0) {  // a part is curved as the whole face is
            outline = match.outline(*face);
            for (const Vec3& n : face->normals) normals.push_back(match.direction(n));
        } else {
            for (const CornerMean& mean : *corners)
                normals.push_back(match.direction(mean.of(std::span(face->normals))));
        }
        const Normal& front = scene.surfaces()[s].normal;
        for (const auto& [i, j, k] : triangulate(outline, front))
            add_triangle({s, {outline[i], outline[j], outline[k]}, {normals[i], normals[j], normals[k]}}, front, out);
    }
    return out;
}

}  // namespace

std::vector<NormalTriangle> load_normals(const Scene& scene, const std::string& path) {
    const std::string kind = ending(path);
    if (kind == ".glb" || kind == ".gltf") return load_gltf_normals(scene, path);
    if (kind == ".obj") return load_obj_normals(scene, path);
    return {};
}

}  // namespace exitance
