#include "exitance/view_factors/view_face.hpp"

#include <algorithm>

#include "exitance/base/triangulation.hpp"
#include "exitance/visibility/narrow_gaps.hpp"

namespace exitance {
namespace {

/// Limits on the distance of stacked faces, as shares of the scene's size and of a face's box, and on the cosine of
/// their normals; derived from ConvexPiece::thickness and Occluders::is_covered().
constexpr double stacked_share = 2 * coplanar_share, stacked_share_of_face = 2 * coplanar_share_of_face;
constexpr double stacked_cosine = -parallel_cosine;

ViewFace make_face(const Scene& scene, SurfaceId s) {
    const Surface& surface = scene.surfaces()[s];
    ViewFace face{
        scene.outline(s), {surface.normal, dot(surface.normal, scene.outline(s)[0])}, surface.area, {}, {}, 0, false};
    for (const Point& p : face.outline) face.box.add(p);
    face.diameter = face.box.diagonal();
    face.thickness = std::min(stacked_share * scene.size(), stacked_share_of_face * face.diameter);
    std::vector<Point> corners;
    for (const auto& piece : convex_pieces(face.outline, surface.normal)) {
        corners.clear();
        for (const std::uint32_t c : piece) corners.push_back(face.outline[c]);
        add_parts(corners, face.pieces);
    }
    face.is_quad = face.pieces.size() == 1 && face.outline.size() <= 4;
    return face;
}

/// True if the faces are opposed and lie in one plane, up to rounding in files.
bool are_stacked(const ViewFace& a, const ViewFace& b) {
    if (dot(a.plane.n, b.plane.n) > stacked_cosine) return false;
    const double thickness = std::min(a.thickness, b.thickness);
    return is_within(b.outline, a.plane, thickness) || is_within(a.outline, b.plane, thickness);
}

}  // namespace

std::vector<ViewFace> make_view_faces(const Scene& scene) {
    std::vector<ViewFace> faces;
    faces.reserve(scene.surfaces().size());
    for (SurfaceId s : scene.surfaces().ids()) faces.push_back(make_face(scene, s));
    return faces;
}

bool face_each_other(const ViewFace& a, const ViewFace& b, double slack, bool& cut) {
    if (are_stacked(a, b)) return false;
    bool any = false, all = true;
    for (const Point& p : b.outline) {
        const double d = a.plane.signed_distance(p);
        any |= d > slack, all &= d >= -slack;
    }
    if (!any) return false;
    any = false;
    for (const Point& p : a.outline) {
        const double d = b.plane.signed_distance(p);
        any |= d > slack, all &= d >= -slack;
    }
    cut = !all;
    return any;
}

double box_distance(const ViewFace& a, const ViewFace& b) {
    return norm(max(max(b.box.lo - a.box.hi, a.box.lo - b.box.hi), Vec3{}));
}

}  // namespace exitance
