#pragma once

#include <functional>
#include <memory>

#include "exitance/direct/direct_light.hpp"
#include "exitance/discontinuity/face_lights.hpp"
#include "exitance/shadow_lines/shadow_events.hpp"

namespace exitance {

/// Finds which sources illuminate regions and faces and which polygons may block them, in place of the search by shafts
/// and a tree of boxes that the engine uses (`DirectLight::prepare`, `prepare_face_lights`). Any two searches lead to
/// the same light up to rounding; they differ in their cost and in the number of candidates.
class BlockerSearch {
  public:
    /// Work of a search. Every thread counts its own.
    struct Counts {
        std::size_t plane_tests = 0;  ///< Tests of a polygon against a plane.
        std::size_t listed = 0;       ///< Number of candidates of the faces in penumbra.
        std::size_t faces = 0;        ///< Number of faces in penumbra.
    };

    virtual ~BlockerSearch() = default;

    /// Finds the sources that illuminate any part of an outline on a region, with their candidate blockers.
    virtual ReceiverLight look(std::span<const Point> outline, RegionId region, DirectLight::Workspace& workspace,
                               Counts& counts) const = 0;
    /// Like `look` above, for each face of a region. `whole` is the light of the whole region; `lights` has one entry
    /// per face.
    virtual void look(const FaceOutlines& outlines, const ReceiverLight& whole, std::span<ReceiverLight> lights,
                      const StopRequest& stop, DirectLight::Workspace& workspace, Counts& counts) const = 0;
    /// Polygons that can clip the wedges of an emitter on a region.
    virtual WedgeLists wedge_lists(std::uint32_t emitter, RegionId region) const = 0;
    /// Number of polygons in the search's own structure.
    virtual std::size_t fragments() const = 0;
};

/// Makes a search over the emitters and occluders of a scene, which must outlive this object.
using MakeBlockerSearch = std::function<std::unique_ptr<BlockerSearch>(const DirectLight&)>;

}  // namespace exitance
