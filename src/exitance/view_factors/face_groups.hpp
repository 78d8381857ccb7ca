#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/view_factors/view_face.hpp"
#include "exitance/visibility/convex_blockers.hpp"

namespace exitance {

/// Faces that are joined along edges. Boxes that touch along whole edges are in one group.
struct FaceGroup {
    Box box;
    std::vector<std::uint32_t> faces;  ///< In ascending order.
    bool is_closed = true;             ///< True if every edge is traversed equally often in both directions.
    bool is_flat = true;               ///< True if all faces are parallel, as those of a sheet.

    /// True if the group bounds a solid, so that no light is inside it.
    bool bounds_solid() const { return is_closed && !is_flat; }
};

/// The groups of faces that are joined along edges. The faces must outlive this object. Immutable.
class FaceGroups {
  public:
    /// `slack`: points nearer to a plane than this are in it, metres. O(n log n) in corners.
    FaceGroups(std::span<const ViewFace> faces, double slack);

    const std::vector<FaceGroup>& all() const { return all_; }
    const FaceGroup& of(std::size_t face) const { return all_[group_[face]]; }

    /// True if all faces of some group are inside a solid, like a room in its outer shell. Such a solid is hollow.
    bool is_hollow(const ConvexBlocker& solid) const;

  private:
    std::span<const ViewFace> faces_;
    double slack_;
    std::vector<FaceGroup> all_;        ///< Sorted by first face.
    std::vector<std::uint32_t> group_;  ///< Index of each face's group.
    Bvh tree_;                          ///< Boxes of the groups.
};

}  // namespace exitance
