#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// A binary space partition of a scene's polygons: every node's plane is that of a polygon, which cuts what it crosses
/// into fragments. A fragment keeps the piece that it is of. From any point the nodes have an order in which nothing
/// hides what comes before it. Source: [Fuchs80], as the thesis [Gatenby95] uses it.
///
/// Occluders and shafts answer what this answers, faster; it is here so that the thesis's structures can be measured.
class BspTree {
  public:
    static constexpr std::uint32_t none = 0xffffffffu;

    struct Fragment {
        std::uint32_t first_corner = 0, corner_count = 0;
        PieceId piece;
        bool faces_front = true;  ///< Its front is the front of its node's plane.
    };
    struct Node {
        Plane plane;
        std::uint32_t front = none, behind = none, parent = none;
        std::uint32_t first_fragment = 0, fragment_count = 0;
        std::uint16_t depth = 0;
    };

    /// Of all convex pieces. A node takes, of up to `tries` pieces drawn by lot, the plane that cuts the fewest others,
    /// and of those the one that leaves both sides most alike. `thickness` (metres): what is nearer to a plane lies in
    /// it; 0: a few roundings of the scene's size. O(n log n) as a rule, O(n^2) fragments at worst.
    explicit BspTree(const Occluders& occluders, std::size_t tries = 8, std::uint64_t seed = 1, double thickness = 0);

    std::span<const Node> nodes() const { return nodes_; }  ///< Parents before children.
    std::span<const Fragment> fragments(const Node& node) const {
        return std::span(fragments_).subspan(node.first_fragment, node.fragment_count);
    }
    std::span<const Fragment> fragments() const { return fragments_; }
    std::span<const Point> outline(const Fragment& f) const {  ///< In the direction of the piece's.
        return std::span(corners_).subspan(f.first_corner, f.corner_count);
    }
    double thickness() const { return thickness_; }
    std::size_t depth() const;
    std::size_t memory_bytes() const;
    const Occluders& occluders() const { return *occluders_; }

    /// On which side of a node's plane does a point lie: 1, -1, or 0 within the thickness?
    int side(const Node& node, const Point& p) const {
        const double d = node.plane.signed_distance(p);
        return d > thickness_ ? 1 : d < -thickness_ ? -1 : 0;
    }

    /// Calls visit(node, side) for all nodes, those that a point sees in front of others first. `side` is that of the
    /// point: with 0 it lies in the plane and sees none of the node's fragments. Without recursion.
    template <class Visit>
    void front_to_back(const Point& from, const Visit& visit) const {
        if (nodes_.empty()) return;
        std::vector<std::pair<std::uint32_t, bool>> stack{{0, false}};
        while (!stack.empty()) {
            const auto [n, is_near_done] = stack.back();
            stack.pop_back();
            const Node& node = nodes_[n];
            const int s = side(node, from);
            const auto [near, far] = s >= 0 ? std::pair(node.front, node.behind) : std::pair(node.behind, node.front);
            if (!is_near_done) {
                stack.push_back({n, true});
                if (near != none) stack.push_back({near, false});
            } else {
                visit(n, s);
                if (far != none) stack.push_back({far, false});
            }
        }
    }

    /// The first piece along a ray, whichever of its sides is met, at `least` lengths of the direction or beyond.
    struct Hit {
        PieceId piece;  ///< None when nothing is met.
        double distance = std::numeric_limits<double>::infinity();
        bool front = false;
    };
    Hit nearest(const Point& origin, const Vec3& direction, double least = 0) const;

  private:
    struct Builder;
    bool hits(const Fragment& fragment, const Node& node, const Point& p) const;

    const Occluders* occluders_;
    double thickness_;
    std::vector<Node> nodes_;
    std::vector<Fragment> fragments_;
    std::vector<Point> corners_;
};

}  // namespace exitance
