#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/geometry/vec.hpp"
#include "exitance/mesh/dm_tree/winged_edge_mesh.hpp"

namespace exitance {

/// Light on quadratic triangles of a plane: values at corners and at the middles of edges 0-1, 1-2, 2-0.
struct LayerTriangles {
    std::vector<Vec2> points;
    std::vector<double> values;  ///< At points.
    std::vector<std::array<std::uint32_t, 3>> corners;
    std::vector<std::array<double, 3>> middles;

    bool is_dark(std::size_t triangle) const;
    double at(std::size_t triangle, Vec2 st) const;  ///< At barycentric coordinates (1 - s - t, s, t).
};

/// What a mesh of so many triangles takes with winged edges, 32-bit ids and doubles, bytes.
std::size_t winged_edge_bytes(const LayerTriangles& triangles);

/// The light of one source on a receiver, to be added to that of others, so that their meshes need not be merged.
/// Dark triangles are left out: where there is no triangle, it is 0. Source: [Gatenby95].
///
/// floats   corners of 3 floats, edges of the curve they lie on and a float, triangles of 6 ids
/// halves   corners of 2 16-bit coordinates and a half float, triangles of 3 ids (of 16 bits where these do); edges are
///          numbered in the order in which triangles come to them, and have a half float each
class LightLayer {
  public:
    enum class Form { floats, halves };
    LightLayer(const LayerTriangles& triangles, Form form);

    std::size_t size() const { return form_ == Form::floats ? faces_.size() : narrow_.size() + wide_.size(); }
    double at(std::size_t triangle, Vec2 st) const;
    /// The light at a place; 0 where no triangle holds it. By the grid, which must be made.
    double at(const Vec2& p) const;
    std::array<Vec2, 3> corners(std::size_t triangle) const;
    /// As it is stored: without the grid, and without the numbers of edges, which are counted again when it is read.
    std::size_t memory_bytes() const;

    /// Makes the grid. Not while others read.
    void make_grid();

  private:
    struct FloatVertex {
        float u, v, value;
    };
    struct FloatEdge {
        std::uint32_t curve;
        float value;
    };
    struct HalfVertex {
        std::uint16_t u, v, value;
    };
    std::array<std::uint32_t, 3> ids(std::size_t triangle) const;
    std::array<double, 6> values(std::size_t triangle) const;
    void number_edges();

    Form form_;
    Vec2 lo_, size_;
    double scale_ = 1;  ///< Of half floats: the largest value.
    std::vector<FloatVertex> vertices_;
    std::vector<FloatEdge> edges_;
    std::vector<std::array<std::uint32_t, 6>> faces_;
    std::vector<HalfVertex> half_vertices_;
    std::vector<std::uint16_t> half_edges_;
    std::vector<std::array<std::uint16_t, 3>> narrow_;
    std::vector<std::array<std::uint32_t, 3>> wide_;
    std::vector<std::array<std::uint32_t, 3>> edge_of_;  ///< Of the form of halves: counted, not stored.
    std::size_t cells_ = 0;
    std::vector<std::vector<std::uint32_t>> grid_;
};

}  // namespace exitance
