#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/ids.hpp"
#include "exitance/mesh/discontinuity/curve_arrangement.hpp"
#include "exitance/visibility/critical_lines.hpp"

namespace exitance {

/// Binary trees of convex polygons, one a piece of a surface, whose cuts follow discontinuity lines: the line of the
/// lowest order that crosses a node, of several the one whose halves are most even; across the longer side where none
/// is left. Source: [Lischinski93].
class LineTree {
  public:
    static constexpr std::uint32_t none = 0xffffffffu;

    struct Node {
        RegionId region;
        std::uint32_t parent = none, first_child = none;  ///< Two children, side by side.
        std::uint32_t root = 0;
        std::vector<Vec2> outline;      ///< Convex, counter-clockwise, in the region's coordinates, metres.
        std::vector<FlatCurve> curves;  ///< That cross the inside; those of inner nodes have gone to the children.
        Vec2 normal;                    ///< Of the cut; the first child is where normal . p <= offset.
        double offset = 0;
        double area = 0;        ///< m^2
        Vec2 centre;            ///< Of the area.
        bool by_curve = false;  ///< Does the cut follow a curve?

        bool is_leaf() const { return first_child == none; }
    };

    /// `tolerance`: curves this near to a node's border do not cross it, metres.
    explicit LineTree(double tolerance) : tolerance_(tolerance) {}

    /// `outline` convex, counter-clockwise. Curves may lie anywhere: those that cross the outline are cut to it.
    std::uint32_t add_root(RegionId region, std::vector<Vec2> outline, std::span<const FlatCurve> curves);

    /// Cuts a leaf. False, and nothing is done, where no cut leaves two pieces that are wider than the tolerance.
    bool split(std::uint32_t node);

    /// The leaf under a root that holds a point. O(depth).
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

/// Area (m^2) and centre of a convex outline's triangles from its first corner, for quadrature: exact for linear
/// functions. Returns the whole area.
struct FanTriangle {
    Vec2 a, b, c;
    double area = 0;
    Vec2 centre() const;
};
std::vector<FanTriangle> fan_of(std::span<const Vec2> outline);

}  // namespace exitance
