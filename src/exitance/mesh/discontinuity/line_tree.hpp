#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/ids.hpp"
#include "exitance/mesh/discontinuity/curve_arrangement.hpp"
#include "exitance/visibility/critical_lines.hpp"

namespace exitance {

/// Binary trees of convex polygons, one tree per piece of a surface, whose cuts follow discontinuity lines. A node is
/// cut along the line of the lowest order that crosses it; among equals, along the one with the most even halves. If no
/// line is left it is cut across its longer side. Source: [Lischinski93].
class LineTree {
  public:
    static constexpr std::uint32_t none = 0xffffffffu;

    struct Node {
        RegionId region;
        std::uint32_t parent = none,
                      first_child = none;  ///< Indices of the parent and of the first of two consecutive children.
        std::uint32_t root = 0;
        std::vector<Vec2> outline;  ///< Convex, counter-clockwise, in the region's plane coordinates, metres.
        /// Curves that cross the interior. For inner nodes they have been passed on to the children.
        std::vector<FlatCurve> curves;
        Vec2 normal;  ///< Normal of the cut; the first child is where normal . p <= offset.
        double offset = 0;
        double area = 0;        ///< m^2
        Vec2 centre;            ///< Centroid.
        bool by_curve = false;  ///< True if the cut follows a curve.

        bool is_leaf() const { return first_child == none; }
    };

    /// `tolerance`, metres: curves nearer to a node's border than this do not cross it.
    explicit LineTree(double tolerance) : tolerance_(tolerance) {}

    /// Adds a tree. `outline`: convex, counter-clockwise. `curves` are clipped to the outline. Returns the root's
    /// index.
    std::uint32_t add_root(RegionId region, std::vector<Vec2> outline, std::span<const FlatCurve> curves);

    /// Splits a leaf. Returns false, and does nothing, if no cut leaves two parts wider than the tolerance.
    bool split(std::uint32_t node);

    /// Returns the leaf below a root that contains a point. O(depth).
    std::uint32_t leaf_under(std::uint32_t root, Vec2 p) const;

    const std::vector<Node>& nodes() const { return nodes_; }
    std::size_t size() const { return nodes_.size(); }

  private:
    struct Line {
        Vec2 normal;
        double offset = 0;
        bool by_curve = false;
    };
    bool find_cut(const Node& node, Line& cut) const;
    void add_node(Node node, std::span<const FlatCurve> curves);

    double tolerance_;
    std::vector<Node> nodes_;
};

/// A triangle of a convex outline's fan around its first corner, for quadrature that is exact for linear functions.
struct FanTriangle {
    Vec2 a, b, c;
    double area = 0;
    Vec2 centre() const;
};
std::vector<FanTriangle> fan_of(std::span<const Vec2> outline);

}  // namespace exitance
