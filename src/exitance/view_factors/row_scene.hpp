#pragma once

#include <vector>

#include "exitance/view_factors/face_sampler.hpp"
#include "exitance/view_factors/near_faces.hpp"
#include "exitance/view_factors/view_face.hpp"
#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// A scene prepared for computing rows of view factors: faces, samplers, occluders and ray tracer. Immutable; memory
/// O(faces).
struct RowScene {
    explicit RowScene(const Scene& s);

    const Scene& scene;
    Occluders occluders;
    RayTracer tracer;
    std::vector<ViewFace> faces;
    std::vector<FaceSampler> samplers;
    std::vector<Point> middles;  ///< Mean of the corners of each face.
    std::vector<double> radii;   ///< Largest distance of a face's corner from its middle, metres.
    NearFaces near;              ///< Finds the faces that may matter to a face.
    double slack;                ///< Points nearer to a plane than this lie in it, metres.

    RegionId region(std::size_t face) const {
        return scene.surfaces()[SurfaceId(static_cast<std::uint32_t>(face))].region;
    }
};

}  // namespace exitance
