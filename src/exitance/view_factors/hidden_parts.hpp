#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/base/progress.hpp"
#include "exitance/view_factors/convex_parts.hpp"
#include "exitance/view_factors/face_groups.hpp"
#include "exitance/view_factors/view_face.hpp"
#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// A convex part of a face that neither sends nor receives light.
struct HiddenPart {
    std::vector<Point> outline;  ///< In the face's plane, counter-clockwise seen from its front, metres.
    std::optional<Box> reach;    ///< Box of the closed group of faces that hides the part; none if the group is open.
    bool is_covered = true;      ///< True if a face covers the part in the sense of Occluders::is_covered().
    bool is_shielded = true;     ///< True if no ray from a visible point enters the solid that hides the part.
    std::uint32_t by = 0;        ///< The face that covers it, or the face itself.
};

/// Finds the parts of faces that other faces cover (a box that stands on the floor or touches another box, a poster on
/// a wall) or that are inside a closed convex solid which pierces the face. Points there are on or behind the surface
/// of the solid, where neither rays nor visible parts can decide whether light passes: it never does. Immutable.
/// O(n log n) in faces and touching pairs.
class HiddenParts {
  public:
    HiddenParts() = default;
    /// `slack`: points nearer to a plane than this are in it, metres. The faces must outlive this object.
    /// `tracer`, `groups`: of the scene and the faces; null: made here if they are needed.
    /// `stop`: after a stop request the object is unusable.
    HiddenParts(const Occluders& occluders, std::span<const ViewFace> faces, double slack, const StopRequest& stop,
                const RayTracer* tracer = nullptr, const FaceGroups* groups = nullptr);

    bool has(std::size_t face) const { return find(face) != nullptr; }
    std::span<const HiddenPart> of(std::size_t face) const {
        const Face* const found = find(face);
        return found ? std::span(found->parts) : std::span<const HiddenPart>();
    }

    /// True if a ray from a point that is not hidden may hit a hidden part of the face. Solids shield the parts that
    /// they hide.
    bool can_be_met(std::size_t face) const {
        const Face* const found = find(face);
        return found && found->is_met;
    }
    /// True if a point of the face is in a hidden part that Occluders::is_covered() does not recognize.
    bool contains_uncovered(std::size_t face, const Point& x) const;

    /// Number of hidden parts of face i that may be taken for visible from face j: they are in front of j, and the
    /// group of faces that hides them is open or touches j. Other groups hide them from j like any blocker. A count of
    /// `limit` means at least as many.
    std::size_t count_from(std::size_t i, std::size_t j, std::size_t limit) const;
    /// Returns the convex pieces of face i without at least these hidden parts: the pieces of the face itself if there
    /// are none, otherwise pieces that this object or `scratch` holds.
    const ConvexParts& pieces(std::size_t i, std::size_t j, ConvexParts& scratch) const;

  private:
    /// A face with hidden parts.
    struct Face {
        std::vector<HiddenPart> parts;  ///< Parts without a reach come first.
        std::size_t unlimited = 0;      ///< Number of parts without a reach.
        Bvh outlines, unlimited_outlines;
        Bvh reaches;            ///< Items: the parts with a reach.
        ConvexParts remaining;  ///< The face's pieces without the parts that have no reach.
        bool is_met = false, has_uncovered = false;
    };

    /// A covered part that may be the side of a sheet.
    struct UncertainPart {
        std::uint32_t face;
        std::size_t part;  ///< Index in the face's list.
    };

    const Face* find(std::size_t face) const {
        return numbers_.empty() || numbers_[face] == none ? nullptr : &faces_with_parts_[numbers_[face]];
    }
    bool is_in_front(const HiddenPart& part, const ViewFace& other) const;
    template <class Visit>
    void visit_limited(const Face& face, const ViewFace& other, const Visit& visit) const;
    bool shows_unlimited(const Face& face, const ViewFace& other) const;
    void add_covers(const Occluders& occluders, const Bvh& tree, const StopRequest& stop, const RayTracer* tracer);
    bool is_inside(const Occluders& occluders, const RayTracer& tracer, const UncertainPart& part,
                   std::span<const UncertainPart> uncertain) const;
    void drop_sheets(const Occluders& occluders, const StopRequest& stop, const RayTracer* tracer);
    void add_sections(const Occluders& occluders, const Bvh& tree, const FaceGroups& groups);
    void finish(const StopRequest& stop);

    static constexpr std::uint32_t none = ~0u;
    std::span<const ViewFace> faces_;
    double slack_ = 0;
    std::vector<std::vector<HiddenPart>> found_;  ///< One list per face, while they are found.
    std::vector<Face> faces_with_parts_;
    std::vector<std::uint32_t> numbers_;  ///< Index of each face in `faces_with_parts_`; empty if no face has parts.
};

}  // namespace exitance
