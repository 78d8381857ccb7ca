#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/view_factors/view_face.hpp"
#include "exitance/visibility/convex_blockers.hpp"

namespace exitance {

/// Groups of faces that are joined along edges, and which of them are closed. Bodies that touch along whole edges are
/// one group.
class FaceBodies {
  public:
    /// `slack`: corners nearer to each other than about this are equal, metres. O(n log n) in corners.
    FaceBodies(std::span<const ViewFace> faces, double slack);

    struct Body {
        Box box;
        std::vector<std::uint32_t> faces;
        bool is_closed = true;  ///< True if every edge is traversed equally often in both directions.
    };
    const std::vector<Body>& all() const { return all_; }
    const Body& of(std::size_t face) const { return all_[body_[face]]; }

    /// True if all faces of some group are inside a solid, like a room in its outer shell. Such a solid is hollow.
    bool has_body_inside(const ConvexBlocker& solid, std::span<const ViewFace> faces, double slack) const;

  private:
    std::vector<Body> all_;
    std::vector<std::uint32_t> body_;  ///< Index of each face's body.
};

}  // namespace exitance
