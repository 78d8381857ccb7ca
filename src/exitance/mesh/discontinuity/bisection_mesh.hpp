#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/mesh/discontinuity/six_node_mesh.hpp"
#include "exitance/mesh/planar_subdivision.hpp"
#include "exitance/visibility/critical_lines.hpp"

namespace exitance {

/// Triangle mesh that is refined by bisecting longest edges. Neighbours are bisected as well, so that there are no
/// hanging nodes. No angle becomes much smaller than the smallest initial one. Source: [Rivara84].
///
/// A triangle has the six nodes of its quadratic polynomial and seven more at which the polynomial is checked: the
/// quarter points of its edges, and the midpoint between the longest edge's middle and the opposite corner. Bisection
/// needs exactly these nodes, so no node is evaluated twice. Across borders and lines of discontinuity, triangles are
/// not neighbours and share no nodes. Where such a line ends or turns, light depends on the direction of approach, and
/// every triangle has a corner node of its own.
class BisectionMesh {
  public:
    static constexpr std::uint32_t none = 0xffffffffu;

    struct Node {
        Point at;  ///< Metres.
        /// Point at which light is evaluated: `at`, but moved slightly inwards on borders and lines of discontinuity.
        Point seen_from;
        std::uint32_t face = 0;  ///< A face whose closure contains the node.
    };
    struct Triangle {
        std::array<std::uint32_t, 3> corner, middle, neighbor;
        /// Quarter points of each edge, nearer to its first and to its second corner.
        std::array<std::array<std::uint32_t, 2>, 3> quarter;
        std::uint32_t inner = none;
        std::array<CurveOrder, 3> order;
        std::uint32_t face = 0;
        std::uint32_t longest = 0;
        std::uint8_t depth = 0;  ///< Number of bisections since the face was made.
    };

    /// `nudge`, metres: distance by which the evaluation points of border nodes are moved inwards.
    explicit BisectionMesh(double nudge) : nudge_(nudge) {}

    /// Adds the triangles of a region; each becomes a face. Labels are values of CurveOrder.
    void add(const LabelledTriangles& triangles, const PlaneFrame& frame);

    const std::vector<Triangle>& triangles() const { return triangles_; }
    const std::vector<Node>& nodes() const { return nodes_; }
    /// Bisects a triangle, and as many others as conformity requires.
    void bisect(std::uint32_t triangle);
    /// Makes a triangle a face of its own, with the given number.
    void set_face(std::uint32_t triangle, std::uint32_t face) {
        triangles_[triangle].face = face, triangles_[triangle].depth = 0;
    }
    /// Returns the triangles that are new or changed since the last call, each once.
    std::vector<std::uint32_t> take_changed();

    double area(std::uint32_t triangle) const;
    double longest_edge(std::uint32_t triangle) const;
    Point centre(std::uint32_t triangle) const;

  private:
    bool is_cut(const Triangle& t, std::size_t edge) const { return t.order[edge] <= CurveOrder::d0; }
    Vec3 inwards(const Vec3& way) const;
    std::uint32_t add_node(const Point& at, const Triangle& t, bool nudged);
    void find_longest(std::uint32_t triangle);
    void add_quarters(std::uint32_t triangle, std::size_t edge);
    void add_inner(std::uint32_t triangle);
    void share_edge(std::uint32_t triangle, std::size_t edge);
    std::uint32_t split(std::uint32_t triangle);
    void join(std::uint32_t a, std::size_t edge, std::uint32_t b, std::size_t other);
    void finish(std::uint32_t triangle);
    Point centre_of(const Triangle& t) const;

    double nudge_;
    std::vector<Node> nodes_;
    std::vector<bool> singular_;
    /// For a border node: the largest size of the triangles that it was evaluated from, metres.
    std::vector<double> widest_;
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> changed_, pending_;
    std::vector<bool> is_changed_;
};

}  // namespace exitance
