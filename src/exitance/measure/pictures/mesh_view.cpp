#include "exitance/measure/pictures/mesh_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/measure/pictures/pixel_hits.hpp"

namespace exitance {
namespace {

/// Barycentric coordinates of a point, projected onto the triangle's plane; all 0 if the triangle has no area.
std::array<double, 3> barycentric(const SixNodeMesh& mesh, std::uint32_t triangle, const Point& p) {
    const auto& n = mesh.nodes[triangle];
    const Point& o = mesh.points[n[0]];
    const Vec3 a = mesh.points[n[1]] - o, b = mesh.points[n[2]] - o, w = p - o;
    const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), det = aa * bb - ab * ab;
    if (!(det > 0)) return {};
    const double s = (bb * dot(a, w) - ab * dot(b, w)) / det, t = (aa * dot(b, w) - ab * dot(a, w)) / det;
    return {1 - s - t, s, t};
}

/// Order of the edge at which the line from a point within a triangle to one outside leaves it.
CurveOrder order_at_exit(const SixNodeMesh& mesh, std::uint32_t triangle, const Point& within, const Point& outside) {
    const auto from = barycentric(mesh, triangle, within), to = barycentric(mesh, triangle, outside);
    double nearest = HUGE_VAL;
    CurveOrder order = CurveOrder::none;
    for (std::size_t k = 0; k < 3; ++k) {
        if (!(to[k] < 0)) continue;
        const double start = std::max(from[k], 0.0), crossing = start / (start - to[k]);
        // The edge that is opposite to corner k.
        if (crossing < nearest) nearest = crossing, order = mesh.edge_order[triangle][(k + 1) % 3];
    }
    return order;
}

}  // namespace

MeshView view_mesh(const SixNodeMesh& mesh, const Scene& scene, const RayTracer& tracer, const Camera& camera,
                   PictureSize size) {
    const SixNodeLocator locator(mesh, scene);
    MeshView view{size, std::vector<MeshView::Pixel>(size.pixels())};
    for_visible_fronts(tracer, camera, size, [&](std::size_t pixel, const RayHit& hit, const Point& at) {
        view.pixels[pixel] = {hit.region, locator.find(hit.region, at).triangle, at};
    });
    return view;
}

CurveOrder order_between(const SixNodeMesh& mesh, std::uint32_t a, const Point& in_a, std::uint32_t b,
                         const Point& in_b) {
    return std::min(order_at_exit(mesh, a, in_a, in_b), order_at_exit(mesh, b, in_b, in_a));
}

std::vector<std::optional<CurveOrder>> mesh_edges(const SixNodeMesh& mesh, const MeshView& view) {
    const auto width = static_cast<std::size_t>(view.size.width);
    std::vector<std::optional<CurveOrder>> edges(view.pixels.size());
    const auto compare = [&](std::size_t i, std::size_t j) {
        const MeshView::Pixel &p = view.pixels[i], &q = view.pixels[j];
        if (p.region == q.region && p.triangle == q.triangle) return;
        const bool inside =
            p.region == q.region && p.triangle != SixNodeLocator::none && q.triangle != SixNodeLocator::none;
        const CurveOrder order = inside ? order_between(mesh, p.triangle, p.at, q.triangle, q.at) : CurveOrder::border;
        edges[i] = std::min(edges[i].value_or(CurveOrder::none), order);
    };
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if ((i + 1) % width != 0) compare(i, i + 1);
        if (i + width < edges.size()) compare(i, i + width);
    }
    return edges;
}

}  // namespace exitance
