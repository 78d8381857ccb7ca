#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/view_factors/face_bodies.hpp"
#include "exitance/view_factors/view_face.hpp"
#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// A convex part of a face that neither sends nor receives light.
struct HiddenPart {
    std::vector<Point> outline;  ///< In the face's plane, counter-clockwise seen from its front, metres.
    Box body;                    ///< Box of the closed body that hides it; infinite if no closed body does.
    bool is_covered = true;      ///< True if a face covers the part in the sense of Occluders::is_covered().
    bool by_solid = true;        ///< True if no ray from a visible point enters the body that hides it.
    std::uint32_t by = 0;        ///< The face that covers it, or the face itself.
};

/// Finds the parts of faces that other faces cover (a box that stands on the floor or touches another box, a poster on
/// a wall) or that are inside a closed convex body which pierces the face. Points there are on or behind the surface of
/// the body, where neither rays nor visible parts can decide whether light passes: it never does. Immutable. O(n log n)
/// in faces and touching pairs.
class HiddenParts {
  public:
    HiddenParts() = default;
    /// `slack`: points nearer to a plane than this are in it, metres.
    HiddenParts(const Occluders& occluders, std::span<const ViewFace> faces, double slack);

    bool has(std::size_t face) const { return !parts_.empty() && !parts_[face].empty(); }
    std::span<const HiddenPart> of(std::size_t face) const { return parts_[face]; }

    /// True if a ray from a point that is not hidden may hit a hidden part of the face. Solids shield the parts that
    /// they hide.
    bool can_be_met(std::size_t face) const { return !is_met_.empty() && is_met_[face]; }
    /// True if a point of the face is in a hidden part that Occluders::is_covered() does not recognize.
    bool contains_uncovered(std::size_t face, const Point& x) const;

    /// True if some hidden part of face i may be taken for visible from face j: it is in front of j, and the body that
    /// hides it touches j. Other bodies hide it from j like any blocker.
    bool matter(std::size_t i, std::size_t j) const;
    /// Returns the convex pieces of face i without its hidden parts that matter to face j.
    std::vector<std::vector<Point>> pieces(std::size_t i, std::size_t j) const;

  private:
    bool matters(const HiddenPart& part, const ViewFace& other) const;
    void add_covers(const Occluders& occluders, const Bvh& tree);
    void add_sections(const Occluders& occluders, const Bvh& tree, const FaceBodies& bodies);

    std::span<const ViewFace> faces_;
    double slack_ = 0;
    std::vector<std::vector<HiddenPart>> parts_;        ///< One list per face; empty if no face has hidden parts.
    std::vector<std::uint8_t> is_met_, has_uncovered_;  ///< One entry per face; empty like `parts_`.
};

}  // namespace exitance
