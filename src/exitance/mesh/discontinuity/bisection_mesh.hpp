#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/mesh/discontinuity/six_node_mesh.hpp"
#include "exitance/mesh/planar_subdivision.hpp"
#include "exitance/visibility/critical_lines.hpp"

namespace exitance {

/// Triangles that are bisected across their longest edges, together with their neighbours, so that edges always meet
/// whole: no angle gets much smaller than the smallest at first. Source: [Rivara84].
///
/// A triangle has six nodes of its polynomial and seven more at which the polynomial is tried: quarters of its edges
/// and the middle between the longest edge's middle and the corner across. Bisected, it needs just these: no node is
/// ever looked at twice. Across borders and lines where light jumps, triangles have no neighbours and share no nodes;
/// where such a line ends or turns, light depends on the direction one comes from, and every triangle has a corner of
/// its own.
class BisectionMesh {
  public:
    static constexpr std::uint32_t none = 0xffffffffu;

    struct Node {
        Point at;                ///< Metres.
        Point seen_from;         ///< The same, on borders and where light jumps a little inside.
        std::uint32_t face = 0;  ///< A face whose closure holds it.
    };
    struct Triangle {
        std::array<std::uint32_t, 3> corner, middle, neighbor;
        std::array<std::array<std::uint32_t, 2>, 3> quarter;  ///< Nearer to the corner where the edge begins, or ends.
        std::uint32_t inner = none;
        std::array<CurveOrder, 3> order;
        std::uint32_t face = 0;
        std::uint32_t longest = 0;
        std::uint8_t depth = 0;  ///< Bisections since the face was made.
    };

    /// `nudge`: how far nodes on borders are seen from within, metres.
    explicit BisectionMesh(double nudge) : nudge_(nudge) {}

    /// Adds the triangles of a region; each is a face. Labels are those of CurveOrder.
    void add(const LabelledTriangles& triangles, const PlaneFrame& frame);

    const std::vector<Triangle>& triangles() const { return triangles_; }
    const std::vector<Node>& nodes() const { return nodes_; }
    /// Bisects a triangle, and others as far as they have to be.
    void bisect(std::uint32_t triangle);
    /// Gives a triangle to a face of its own.
    void set_face(std::uint32_t triangle, std::uint32_t face) {
        triangles_[triangle].face = face, triangles_[triangle].depth = 0;
    }
    /// Triangles that are new or changed since the last call, each once.
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
    std::vector<double> widest_;  ///< Of the triangles that a node on a border was seen from, metres.
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> changed_, pending_;
    std::vector<bool> is_changed_;
};

}  // namespace exitance
