#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// A planar subdivision in winged-edge form: each edge has its two vertices, its two faces, and the previous and next
/// edge around each face. It is changed by two operators: splitting an edge at a point, and splitting a face along a
/// new edge between two of its vertices. Source: [Baumgart75].
class WingedEdgeMesh {
  public:
    static constexpr std::uint32_t none = 0xffffffffu;

    struct Vertex {
        Vec2 at;
        double value = 0;  ///< Interpolated quantity.
        std::uint32_t edge = none;
    };
    /// Around its left face (side 0) an edge leads from vertex 0 to vertex 1; around its right face (side 1), from 1 to
    /// 0.
    struct Edge {
        std::array<std::uint32_t, 2> vertex{none, none}, face{none, none}, next{none, none}, before{none, none};
        std::uint32_t curve = none;  ///< Number of its curve; none: a construction edge that completes a split.
        double value = 0;            ///< Interpolated quantity at its middle.
    };
    struct Face {
        std::uint32_t edge = none;
    };

    /// One face bounded by a simple outline, counter-clockwise; the outside is not a face.
    explicit WingedEdgeMesh(std::span<const Vec2> outline);

    std::span<const Vertex> vertices() const { return vertices_; }
    std::span<const Edge> edges() const { return edges_; }
    std::span<const Face> faces() const { return faces_; }
    /// A vertex of a face and the edge from it to the next one, counter-clockwise.
    struct Corner {
        std::uint32_t vertex, edge;
    };
    std::vector<Corner> loop(std::uint32_t face) const;

    /// Splits an edge at a point. Returns the new vertex; `edge` becomes the first half.
    std::uint32_t cut_edge(std::uint32_t edge, const Vec2& at);
    /// Splits a face along a new edge from vertex a to vertex b. Returns the edge; the part of the face on its left
    /// becomes a new face.
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
