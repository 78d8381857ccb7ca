#pragma once

#include <optional>
#include <vector>

#include "exitance/measure/pictures/camera.hpp"
#include "exitance/mesh/discontinuity/six_node_mesh.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// What a camera sees of a discontinuity mesh through the middles of its pixels, rows from top to bottom.
struct MeshView {
    struct Pixel {
        RegionId region;  ///< Whose front is seen; none: a back, or nothing.
        std::uint32_t triangle = SixNodeLocator::none;
        Point at;  ///< Metres.
    };
    PictureSize size;
    std::vector<Pixel> pixels;
};

/// Looks through every pixel's middle. O(pixels log triangles), the same on any number of threads.
MeshView view_mesh(const SixNodeMesh& mesh, const Scene& scene, const RayTracer& tracer, const Camera& camera,
                   PictureSize size);

/// The order of the edge that lies between two places of one region, of which the first is in triangle `a` and the
/// second in triangle `b`: the strongest of the one by which the way from one to the other leaves `a` and the one by
/// which it enters `b`. What lies between, if the two are no neighbours, is not seen.
CurveOrder order_between(const SixNodeMesh& mesh, std::uint32_t a, const Point& in_a, std::uint32_t b,
                         const Point& in_b);

/// Edges of the mesh, at the pixels whose right or lower neighbour shows another triangle; none where there is no edge,
/// CurveOrder::none at edges that no event made, CurveOrder::border between surfaces.
std::vector<std::optional<CurveOrder>> mesh_edges(const SixNodeMesh& mesh, const MeshView& view);

}  // namespace exitance
