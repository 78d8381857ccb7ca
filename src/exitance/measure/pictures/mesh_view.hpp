#pragma once

#include <optional>
#include <vector>

#include "exitance/measure/pictures/camera.hpp"
#include "exitance/mesh/discontinuity/six_node_mesh.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// View of a discontinuity mesh through the centres of a camera's pixels, rows from top to bottom.
struct MeshView {
    struct Pixel {
        RegionId region;  ///< Region whose front is visible; none: a back, or nothing.
        std::uint32_t triangle = SixNodeLocator::none;
        Point at;  ///< Metres.
    };
    PictureSize size;
    std::vector<Pixel> pixels;
};

/// Traces a ray through every pixel's centre. O(pixels log triangles). Deterministic on any number of threads.
MeshView view_mesh(const SixNodeMesh& mesh, const Scene& scene, const RayTracer& tracer, const Camera& camera,
                   PictureSize size);

/// Order of the edge between two points of one region, the first in triangle `a`, the second in triangle `b`: the
/// stronger one of the edge where the line between them leaves `a` and the edge where it enters `b`. If the triangles
/// are not neighbours, edges between them are ignored.
CurveOrder order_between(const SixNodeMesh& mesh, std::uint32_t a, const Point& in_a, std::uint32_t b,
                         const Point& in_b);

/// Edges of the mesh, at pixels whose right or lower neighbour shows another triangle. Empty where there is no edge,
/// CurveOrder::none at edges that are not discontinuities, CurveOrder::border between surfaces.
std::vector<std::optional<CurveOrder>> mesh_edges(const SixNodeMesh& mesh, const MeshView& view);

}  // namespace exitance
