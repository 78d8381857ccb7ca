#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Binary space partition (BSP) of a scene's polygons. Each node's plane is the plane of a polygon and cuts the
/// polygons that cross it into fragments. Each fragment records its piece. From any viewpoint, the tree gives an order
/// of the nodes in which no node hides an earlier one. Source: [Fuchs80], as used in the thesis [Gatenby95].
///
/// Occluders and Shaft answer the same queries faster. This class exists to measure the data structures of the thesis.
class BspTree {
  public:
    static constexpr std::uint32_t none = 0xffffffffu;

    struct Fragment {
        std::uint32_t first_corner = 0, corner_count = 0;
        PieceId piece;
        bool faces_front = true;  ///< True if its front is the front of its node's plane.
    };
    struct Node {
        Plane plane;
        std::uint32_t front = none, behind = none, parent = none;
        std::uint32_t first_fragment = 0, fragment_count = 0;
        std::uint16_t depth = 0;
    };

    /// Builds the tree from all convex pieces. For each node, chooses among up to `tries` randomly sampled pieces the
    /// plane that cuts the fewest others; among equals, the one that divides the rest most evenly.
    /// tries  number of candidate planes per node
    /// seed  of the random samples
    /// thickness  metres: points nearer to a plane than this are in the plane; 0: a few roundings of the scene's size
    /// Usually O(n log n); O(n^2) fragments in the worst case.
    explicit BspTree(const Occluders& occluders, std::size_t tries = 8, std::uint64_t seed = 1, double thickness = 0);

    std::span<const Node> nodes() const { return nodes_; }  ///< Parents before children.
    std::span<const Fragment> fragments(const Node& node) const {
        return std::span(fragments_).subspan(node.first_fragment, node.fragment_count);
    }
    std::span<const Fragment> fragments() const { return fragments_; }
    /// Returns the fragment's outline, in the direction of the piece's outline.
    std::span<const Point> outline(const Fragment& f) const {
        return std::span(corners_).subspan(f.first_corner, f.corner_count);
    }
    double thickness() const { return thickness_; }
    std::size_t depth() const;
    std::size_t memory_bytes() const;
    const Occluders& occluders() const { return *occluders_; }

    /// Returns the side of the node's plane that p is on: 1 (front), -1 (behind), or 0 (within the thickness).
    int side(const Node& node, const Point& p) const {
        const double d = node.plane.signed_distance(p);
        return d > thickness_ ? 1 : d < -thickness_ ? -1 : 0;
    }

    /// Calls visit(node, side) for all nodes, front to back as seen from a point. `side` is the side of the node's
    /// plane that the point is on; 0: the point is in the plane and sees none of the node's fragments. Not recursive.
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

    /// First piece that a ray hits, on either side, at a distance of at least `least` (in lengths of the direction).
    struct Hit {
        PieceId piece;  ///< The piece that is hit; none if nothing is hit.
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
