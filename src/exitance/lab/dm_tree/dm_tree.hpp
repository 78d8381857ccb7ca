#pragma once

#include <vector>

#include "exitance/lab/dm_tree/winged_edge_mesh.hpp"
#include "exitance/mesh/planar_subdivision.hpp"
#include "exitance/solve/discontinuity_choice.hpp"

namespace exitance {

/// A discontinuity mesh as the thesis has it: a 2D BSP whose inner nodes are lines and whose leaves are the convex
/// faces of a winged-edge mesh. A curve's stretch is filtered down to the leaves that it crosses and cuts each in two;
/// where it ends within a leaf, construction edges complete the cut. Source: [Gatenby95].
class DmTree {
  public:
    /// `outline` is convex, counter-clockwise; what is nearer than `tolerance` is the same, metres.
    DmTree(std::span<const Vec2> outline, double tolerance);

    /// `curve` names it; stretches on one that is there already add nothing.
    void insert(const Vec2& a, const Vec2& b, std::uint32_t curve);
    /// Cuts the whole outline by a grid of `count` x `count` cells over its box, all construction: coarse premeshing.
    void insert_grid(std::size_t count);

    const WingedEdgeMesh& mesh() const { return mesh_; }
    std::size_t construction_edges() const;  ///< Within the outline.
    std::size_t memory_bytes() const { return mesh_.memory_bytes() + nodes_.size() * sizeof(Node); }
    /// The face that holds a point of the outline. O(depth).
    std::uint32_t face_at(const Vec2& p) const;

  private:
    struct Node {
        Vec2 normal;  ///< Of length 1; of a leaf: unused.
        double offset = 0;
        std::uint32_t left = WingedEdgeMesh::none, right = WingedEdgeMesh::none;
        std::uint32_t face = WingedEdgeMesh::none;  ///< Of a leaf.
        double distance(const Vec2& p) const { return dot(normal, p) - offset; }
    };
    void cut_leaf(std::uint32_t node, const Vec2& a, const Vec2& b, std::uint32_t curve);

    double tolerance_;
    WingedEdgeMesh mesh_;
    std::vector<Node> nodes_;
    std::size_t border_edges_;
};

inline constexpr std::array<std::pair<TriangulationScheme, const char*>, 4> triangulation_names{{
    {TriangulationScheme::longest, "longest"},
    {TriangulationScheme::shortest, "shortest"},
    {TriangulationScheme::heuristic, "heuristic"},
    {TriangulationScheme::delaunay, "delaunay"},
}};

/// All faces of a tree by one of the thesis's schemes; edges of curves have the label of their curve, those of the
/// border LabelledTriangles::border. Not for `delaunay` (`labelled_triangles`).
LabelledTriangles triangulated(const DmTree& tree, TriangulationScheme scheme,
                               std::span<const std::uint8_t> label_of_curve);

/// Radius of the inscribed circle over that of the circumscribed one, 0 to 0.5.
double radius_ratio(const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace exitance
