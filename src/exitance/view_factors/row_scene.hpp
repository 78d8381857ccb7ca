#pragma once

#include <vector>

#include "exitance/view_factors/face_sampler.hpp"
#include "exitance/view_factors/hidden_parts.hpp"
#include "exitance/view_factors/near_faces.hpp"
#include "exitance/view_factors/view_face.hpp"
#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// A scene prepared for computing rows of view factors: faces, samplers, occluders and ray tracer. Immutable; memory
/// O(faces).
struct RowScene {
    /// After a stop request the object is unusable.
    RowScene(const Scene& s, const StopRequest& stop);

    const Scene& scene;
    Occluders occluders;
    RayTracer tracer;
    std::vector<ViewFace> faces;
    std::vector<FaceSampler> samplers;
    std::vector<Point> middles;  ///< Mean of the corners of each face.
    std::vector<double> radii;   ///< Largest distance of a face's corner from its middle, metres.
    NearFaces near;              ///< Finds the faces that may matter to a face.
    double slack;                ///< Points nearer to a plane than this lie in it, metres.
    HiddenParts hidden_parts;    ///< Parts of faces that neither send nor receive light.

    /// True if a point of a face can neither send nor receive light: another face covers it, or a body contains it.
    bool is_hidden(const Point& x, std::size_t face) const {
        return occluders.is_covered(x, faces[face].plane.n, region(face)) || hidden_parts.contains_uncovered(face, x);
    }
    /// True if a ray along `direction` hits a face where it is hidden.
    bool ends_hidden(const RayHit& hit, const Point& origin, const Vec3& direction) const {
        return !hit.surface.is_none() && hidden_parts.can_be_met(hit.surface.value) &&
               is_hidden(place_of(scene, hit, origin, direction), hit.surface.value);
    }

    RegionId region(std::size_t face) const {
        return scene.surfaces()[SurfaceId(static_cast<std::uint32_t>(face))].region;
    }
};

}  // namespace exitance
