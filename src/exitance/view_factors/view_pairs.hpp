#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/view_factors/hidden_parts.hpp"
#include "exitance/view_factors/view_face.hpp"
#include "exitance/visibility/convex_blockers.hpp"
#include "exitance/visibility/joint_shadow.hpp"
#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// All faces of a scene and the possible blockers between any two of them. Immutable after find_hidden; shared by all
/// rows.
class ViewPairs {
  public:
    /// Position of a blocker relative to a plane, as bits.
    enum Standing : std::uint8_t { in_front = 1, behind = 2 };

    /// O(faces x blockers) time, five bytes per pair. After a stop request the object is unusable.
    ViewPairs(const Scene& scene, const StopRequest& stop);

    /// Finds pairs of faces, the larger index in [first, last), that are certainly hidden from each other, by one
    /// blocker or several together. One byte per pair of faces. After a stop request the result is unusable.
    void find_hidden(std::size_t first, std::size_t last, const StopRequest& stop);
    /// True if two faces are certainly hidden from each other. Requires find_hidden for the larger index.
    bool is_hidden(std::size_t i, std::size_t j) const { return hidden_[i * faces_.size() + j] != 0; }

    const std::vector<ViewFace>& faces() const { return faces_; }
    const std::vector<ConvexBlocker>& blockers() const { return blockers_; }
    const HiddenParts& hidden_parts() const { return hidden_parts_; }
    /// Points nearer to a plane than this lie in it, metres.
    double slack() const { return slack_; }

    /// True if each face is at least partly in front of the other. Sets `cut` if part of one is behind the other's
    /// plane.
    bool face_each_other(std::size_t i, std::size_t j, bool& cut) const {
        return exitance::face_each_other(faces_[i], faces_[j], slack_, cut);
    }
    /// Finds blockers that are at least partly in front of a face.
    void find_blockers(std::size_t face, std::vector<std::uint32_t>& found) const;
    /// Finds those blockers in `before_i` that may hide part of j from part of i: not separated from both by one of
    /// their own faces, and not outside the shaft between the bounding boxes.
    void find_blockers(std::size_t i, std::size_t j, std::span<const std::uint32_t> before_i,
                       std::vector<std::uint32_t>& found) const;
    /// True if a blocker crosses the plane of a face.
    bool crosses(std::size_t face, std::uint32_t b) const {
        return standing_[face * blockers_.size() + b] == (in_front | behind);
    }
    std::uint8_t standing(const ConvexBlocker& blocker, const Plane& plane) const;

  private:
    Occluders occluders_;
    double slack_;
    std::vector<ViewFace> faces_;
    FaceGroups groups_;
    HiddenParts hidden_parts_;
    std::vector<ConvexBlocker> blockers_;
    std::vector<Box> boxes_;
    std::vector<std::uint32_t> sides_;    ///< One row per face, one column per blocker.
    std::vector<std::uint8_t> standing_;  ///< One row per face, one column per blocker.
    BlockerPlanes planes_;
    std::vector<std::uint8_t> hidden_;  ///< 1 for hidden pairs: one row and one column per face.
};

}  // namespace exitance
