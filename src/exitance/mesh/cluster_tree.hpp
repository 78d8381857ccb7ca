#pragma once

#include <span>
#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

using ClusterId = Id<struct ClusterTag>;  ///< A node of a ClusterTree.
using FacingId = Id<struct FacingTag>;    ///< A part of a cluster, see Facing.

/// What light passes between: an element, or a cluster of pieces.
class Body {
  public:
    Body() = default;
    Body(ElementId e) : value_(e.value) {}
    Body(ClusterId c) : value_(c.value | cluster_bit) {}

    bool is_cluster() const { return value_ & cluster_bit; }
    ElementId element() const { return ElementId(value_); }
    ClusterId cluster() const { return ClusterId(value_ & ~cluster_bit); }
    std::uint32_t value() const { return value_; }  ///< One for each body.
    constexpr auto operator<=>(const Body&) const = default;

  private:
    static constexpr std::uint32_t cluster_bit = 0x80000000u;
    std::uint32_t value_ = 0;
};

/// The members of a cluster that face about the same way. From afar they send and receive as their vector area does,
/// which is exact as long as all of them face the other body, or none. So a wall's lit side never shines through it.
struct Facing {
    Vec3 area;           ///< Sum of A n, m^2.
    double surface = 0;  ///< Sum of A, m^2.
    double spread = 0;   ///< How far a member's normal may depart from the area's direction, |n - n'|.
    FacingId above;      ///< Where the cluster's parent holds these members; none for the root.
};

/// A hierarchy above the pieces of a scene (the roots of its elements), for light that passes between far things: inner
/// nodes alone, their children being clusters or pieces. Pieces that are large beside a node are its own children; the
/// others are halved where the sum of area times number is least (binned), until few are left. O(k log k).
/// Source: [Smits94], [Hasenfratz99]; light by vector areas: [Willmott99].
class ClusterTree {
  public:
    /// Empty when there are no pieces; the pieces must outlive it. `room`: a number for each of them; no cluster but
    /// the root holds pieces of two rooms. Empty: all are of one.
    explicit ClusterTree(const ElementTree& pieces, std::span<const std::uint32_t> room = {});

    ClusterId root() const { return ClusterId(0); }
    std::size_t size() const { return nodes_.size(); }
    IdRange<ClusterId> ids() const { return nodes_.ids(); }  ///< Parents before children.
    std::span<const Body> children(ClusterId c) const {
        return std::span(children_).subspan(nodes_[c].first, nodes_[c].count);
    }
    const Point& centre(ClusterId c) const { return nodes_[c].centre; }  ///< Of its area.
    double radius(ClusterId c) const { return nodes_[c].radius; }        ///< Of a ball about the centre, metres.
    double area(ClusterId c) const { return nodes_[c].area; }            ///< Of all members, m^2.

    IdRange<FacingId> facings(ClusterId c) const { return nodes_[c].facings; }
    const Facing& facing(FacingId f) const { return facings_[f]; }
    std::size_t facing_count() const { return facings_.size(); }
    /// Where the cluster right above a piece holds it.
    FacingId facing_of(ElementId piece) const { return facing_of_[piece]; }
    std::size_t memory_bytes() const;

  private:
    struct Node {
        Point centre;
        double radius = 0, area = 0;
        std::uint32_t first = 0, count = 0;  ///< Of children_.
        IdRange<FacingId> facings;
    };
    struct Item;
    struct Group;
    ClusterId build(std::span<Item> items);
    ClusterId join_rooms(std::span<Item> items);
    void set_children(ClusterId c, std::span<const Body> children);
    void sum_up(ClusterId c, std::span<const Item> items);
    void find_facings();

    const ElementTree& pieces_;
    Field<ClusterId, Node> nodes_;
    std::vector<Body> children_;
    Field<FacingId, Facing> facings_;
    std::vector<std::uint8_t> key_;  ///< Of each facing, while the tree is built.
    Field<ElementId, FacingId> facing_of_;
};

}  // namespace exitance
