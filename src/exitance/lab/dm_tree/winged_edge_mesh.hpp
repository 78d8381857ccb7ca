#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// A planar subdivision as edges that have their two ends, their two faces, and the edges before and after them around
/// each. Two operators change it: an edge is cut at a point, a face along a new edge between two of its vertices.
/// Source: [Baumgart75].
class WingedEdgeMesh {
  public:
    static constexpr std::uint32_t none = 0xffffffffu;

    struct Vertex {
        Vec2 at;
        double value = 0;  ///< Whatever is interpolated.
        std::uint32_t edge = none;
    };
    /// Around its left face (side 0) an edge leads from vertex 0 to vertex 1, around its right face (side 1) back.
    struct Edge {
        std::array<std::uint32_t, 2> vertex{none, none}, face{none, none}, next{none, none}, before{none, none};
        std::uint32_t curve = none;  ///< What it is a part of; none: construction, to complete a cut.
        double value = 0;            ///< At its middle.
    };
    struct Face {
        std::uint32_t edge = none;
    };

    /// One face within a simple outline, counter-clockwise; the outside is no face.
    explicit WingedEdgeMesh(std::span<const Vec2> outline);

    std::span<const Vertex> vertices() const { return vertices_; }
    std::span<const Edge> edges() const { return edges_; }
    std::span<const Face> faces() const { return faces_; }
    /// The vertices of a face, counter-clockwise, and the edge that leads from each to the next.
    struct Corner {
        std::uint32_t vertex, edge;
    };
    std::vector<Corner> loop(std::uint32_t face) const;

    /// Returns the new vertex; the edge keeps its first half.
    std::uint32_t cut_edge(std::uint32_t edge, const Vec2& at);
    /// Returns the new edge, from `a` to `b`; the part of the face on its left becomes a face of its own.
    std::uint32_t cut_face(std::uint32_t face, std::uint32_t a, std::uint32_t b);
    void set_curve(std::uint32_t edge, std::uint32_t curve) { edges_[edge].curve = curve; }

    std::size_t memory_bytes() const {
        return vertices_.size() * sizeof(Vertex) + edges_.size() * sizeof(Edge) + faces_.size() * sizeof(Face);
    }

  private:
    std::size_t side(std::uint32_t edge, std::uint32_t face) const { return edges_[edge].face[0] == face ? 0 : 1; }
    void link(std::uint32_t first, std::uint32_t second, std::uint32_t face);

    std::vector<Vertex> vertices_;
    std::vector<Edge> edges_;
    std::vector<Face> faces_;
};

}  // namespace exitance
