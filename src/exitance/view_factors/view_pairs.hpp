#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/view_factors/view_face.hpp"
#include "exitance/visibility/convex_blockers.hpp"
#include "exitance/visibility/joint_shadow.hpp"
#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// All faces of a scene and what may stand between any two of them. Immutable once made, shared by all rows.
class ViewPairs {
  public:
    /// Where a blocker stands to a plane, as bits.
    enum Standing : std::uint8_t { in_front = 1, behind = 2 };

    /// O(faces x blockers) time, five bytes a pair of them. Of no use when a stop is requested meanwhile.
    ViewPairs(const Scene& scene, const StopRequest& stop);

    /// Finds pairs of faces that blockers hide from each other for certain, one alone or several together. A byte a
    /// pair of faces. Of no use when a stop is requested meanwhile.
    void find_hidden(std::size_t first, std::size_t last, const StopRequest& stop);
    /// Is it certain that two faces do not see each other? Known after find_hidden of the larger number.
    bool is_hidden(std::size_t i, std::size_t j) const { return hidden_[i * faces_.size() + j] != 0; }

    const std::vector<ViewFace>& faces() const { return faces_; }
    const std::vector<ConvexBlocker>& blockers() const { return blockers_; }
    /// Metres: what lies nearer to a plane than this lies in it.
    double slack() const { return slack_; }

    /// Is some of each in front of the other? `cut` when only some of one is.
    bool face_each_other(std::size_t i, std::size_t j, bool& cut) const {
        return exitance::face_each_other(faces_[i], faces_[j], slack_, cut);
    }
    /// Blockers with some part in front of a face.
    void find_blockers(std::size_t face, std::vector<std::uint32_t>& found) const;
    /// Those of them that may hide some of j from some of i: not kept apart from both by one of their own faces, and
    /// not outside the shaft between the boxes.
    void find_blockers(std::size_t i, std::size_t j, std::span<const std::uint32_t> before_i,
                       std::vector<std::uint32_t>& found) const;
    /// Does a blocker cross the plane of a face?
    bool crosses(std::size_t face, std::uint32_t b) const {
        return standing_[face * blockers_.size() + b] == (in_front | behind);
    }
    std::uint8_t standing(const ConvexBlocker& blocker, const Plane& plane) const;

  private:
    Occluders occluders_;
    double slack_;
    std::vector<ViewFace> faces_;
    std::vector<ConvexBlocker> blockers_;
    std::vector<Box> boxes_;
    std::vector<std::uint32_t> sides_;    ///< A row a face, a column a blocker.
    std::vector<std::uint8_t> standing_;  ///< Likewise.
    BlockerPlanes planes_;
    std::vector<std::uint8_t> hidden_;  ///< A row and a column a face.
};

}  // namespace exitance
