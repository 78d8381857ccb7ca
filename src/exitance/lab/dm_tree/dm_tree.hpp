#pragma once

#include <vector>

#include "exitance/lab/dm_tree/winged_edge_mesh.hpp"
#include "exitance/mesh/planar_subdivision.hpp"
#include "exitance/solve/discontinuity_choice.hpp"

namespace exitance {

/// A discontinuity mesh as in the thesis: a 2D BSP whose inner nodes are lines and whose leaves are the convex faces of
/// a winged-edge mesh. Inserting a segment of a curve filters it down to the leaves that it crosses and splits each of
/// them. If it ends inside a leaf, construction edges complete the split. Source: [Gatenby95].
class DmTree {
  public:
    /// `outline` is convex and counter-clockwise.
    /// Points nearer to each other than `tolerance` (metres) coincide.
    DmTree(std::span<const Vec2> outline, double tolerance);

    /// Inserts a segment with curve number `curve`. Segments on an existing edge add nothing.
    void insert(const Vec2& a, const Vec2& b, std::uint32_t curve);
    /// Divides the whole outline by a grid of `count` x `count` cells over its box, all construction edges: coarse
    /// premeshing.
    void insert_grid(std::size_t count);

    const WingedEdgeMesh& mesh() const { return mesh_; }
    std::size_t construction_edges() const;  ///< Number of edges inside the outline.
    std::size_t memory_bytes() const { return mesh_.memory_bytes() + nodes_.size() * sizeof(Node); }

  private:
    struct Node {
        Vec2 normal;  ///< Unit length; unused in leaves.
        double offset = 0;
        std::uint32_t left = WingedEdgeMesh::none, right = WingedEdgeMesh::none;
        std::uint32_t face = WingedEdgeMesh::none;  ///< The face of a leaf; `none` in other nodes.
        double distance(const Vec2& p) const { return dot(normal, p) - offset; }
    };
    void cut_leaf(std::uint32_t node, const Vec2& a, const Vec2& b, std::uint32_t curve);

    double tolerance_;
    WingedEdgeMesh mesh_;
    std::vector<Node> nodes_;
};

inline constexpr std::array<std::pair<TriangulationScheme, const char*>, 4> triangulation_names{{
    {TriangulationScheme::longest, "longest"},
    {TriangulationScheme::shortest, "shortest"},
    {TriangulationScheme::heuristic, "heuristic"},
    {TriangulationScheme::delaunay, "delaunay"},
}};

/// Triangulates all faces of a tree by one of the thesis's schemes. Edges of curves get the label of their curve,
/// border edges LabelledTriangles::border. Does not support `delaunay` (use labelled_triangles).
LabelledTriangles triangulated(const DmTree& tree, TriangulationScheme scheme,
                               std::span<const std::uint8_t> label_of_curve);

/// Radius of the inscribed circle over that of the circumscribed circle, 0 to 0.5.
double radius_ratio(const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace exitance
