#pragma once

#include <span>
#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

using ClusterId = Id<struct ClusterTag>;  ///< A node of a ClusterTree.
using FacingId = Id<struct FacingTag>;    ///< A group of cluster members with similar normals; see Facing.

/// A sender or receiver of light: an element, or a cluster of pieces.
class Body {
  public:
    Body() = default;
    Body(ElementId e) : value_(e.value) {}
    Body(ClusterId c) : value_(c.value | cluster_bit) {}

    bool is_cluster() const { return value_ & cluster_bit; }
    ElementId element() const { return ElementId(value_); }
    ClusterId cluster() const { return ClusterId(value_ & ~cluster_bit); }
    std::uint32_t value() const { return value_; }  ///< A number that no other body has.
    constexpr auto operator<=>(const Body&) const = default;

  private:
    static constexpr std::uint32_t cluster_bit = 0x80000000u;
    std::uint32_t value_ = 0;
};

/// The members of a cluster with similar normals. In the far field they send and receive light like their vector area.
/// That is exact if all of them face the other body, or none does; so light never leaks through a wall.
struct Facing {
    Vec3 area;           ///< Sum of A n, m^2.
    double surface = 0;  ///< Sum of A, m^2.
    double spread = 0;   ///< Largest deviation of a member's unit normal n from the area's direction n': |n - n'|.
    FacingId above;      ///< The facing of the parent cluster that includes these members; none for the root.
};

/// A cluster hierarchy above the pieces of a scene (the roots of its elements), for light transport between distant
/// objects. It has inner nodes only; their children are clusters or pieces. Pieces that are large relative to a node
/// are its direct children. The others are bisected where the sum of area times number is smallest (binned), until few
/// are left. O(k log k) for k pieces. Source: [Smits94], [Hasenfratz99]; light by vector areas: [Willmott99].
class ClusterTree {
  public:
    /// pieces  must outlive the tree; without pieces the tree is empty
    /// room  index of the room of each piece; only the root may contain pieces of several rooms. Empty: one room
    explicit ClusterTree(const ElementTree& pieces, std::span<const std::uint32_t> room = {});

    ClusterId root() const { return ClusterId(0); }
    std::size_t size() const { return nodes_.size(); }
    IdRange<ClusterId> ids() const { return nodes_.ids(); }  ///< All clusters, parents before children.
    std::span<const Body> children(ClusterId c) const {
        return std::span(children_).subspan(nodes_[c].first, nodes_[c].count);
    }
    const Point& centre(ClusterId c) const { return nodes_[c].centre; }  ///< Centroid of the cluster's area.
    double radius(ClusterId c) const {  ///< Radius of a ball around the centre that contains it, metres.
        return nodes_[c].radius;
    }
    double area(ClusterId c) const { return nodes_[c].area; }  ///< Total area of all members, m^2.

    IdRange<FacingId> facings(ClusterId c) const { return nodes_[c].facings; }
    const Facing& facing(FacingId f) const { return facings_[f]; }
    std::size_t facing_count() const { return facings_.size(); }
    /// The facing that includes a piece, in the cluster directly above it.
    FacingId facing_of(ElementId piece) const { return facing_of_[piece]; }
    std::size_t memory_bytes() const;

  private:
    struct Node {
        Point centre;
        double radius = 0, area = 0;
        std::uint32_t first = 0, count = 0;  ///< Range in `children_`.
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
    std::vector<std::uint8_t> key_;  ///< Direction class of each facing, during construction only.
    Field<ElementId, FacingId> facing_of_;
};

}  // namespace exitance
