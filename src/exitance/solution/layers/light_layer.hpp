#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Light on quadratic triangles in a plane: values at the corners and at the middles of the edges 0-1, 1-2, 2-0.
struct LayerTriangles {
    std::vector<Vec2> points;
    std::vector<double> values;  ///< Per point.
    std::vector<std::array<std::uint32_t, 3>> corners;
    std::vector<std::array<double, 3>> middles;

    bool is_dark(std::size_t triangle) const;
    double at(std::size_t triangle, Vec2 st) const;  ///< Value at barycentric coordinates (1 - s - t, s, t).
    std::size_t edge_count() const;                  ///< Number of edges; O(triangles).
};

/// Light of one source on a receiver. Layers of several sources are added, so that their meshes need not be merged.
/// Dark triangles are omitted: the light is 0 where there is no triangle. Source: [Gatenby95].
///
/// floats   vertices of 3 floats, edges with the number of their curve and a float, triangles of 6 indices
/// halves   vertices of 2 16-bit coordinates and a half float, triangles of 3 indices (16 bits if that suffices); edges
/// are numbered in the order in which triangles first use them and have one half float each
class LightLayer {
  public:
    enum class Form : std::uint8_t { floats, halves };
    static constexpr std::uint32_t unused = 0xffffffffu;

    struct FloatVertex {
        float u, v, value;
    };
    struct FloatEdge {
        std::uint32_t curve;  ///< `unused`: no curve number is stored.
        float value;
    };
    struct HalfVertex {
        std::uint16_t u, v, value;
    };
    /// The stored data.
    struct Contents {
        Form form = Form::floats;
        Vec2 lo{HUGE_VAL, HUGE_VAL}, size{1, 1};  ///< The box of the 16-bit coordinates, metres.
        double scale = 1;                         ///< Scale of the half floats: the largest value.
        std::vector<FloatVertex> vertices = {};
        std::vector<FloatEdge> edges = {};
        std::vector<std::array<std::uint32_t, 6>> faces = {};
        std::vector<HalfVertex> half_vertices = {};
        std::vector<std::uint16_t> half_edges = {};
        std::vector<std::array<std::uint16_t, 3>> narrow = {};
        std::vector<std::array<std::uint32_t, 3>> wide = {};

        std::size_t triangles() const { return form == Form::floats ? faces.size() : narrow.size() + wide.size(); }
    };

    LightLayer(const LayerTriangles& triangles, Form form);
    /// `contents` must be valid: find_nonsense() returns nothing for it.
    explicit LightLayer(Contents contents);

    std::size_t size() const { return contents_.triangles(); }
    double at(std::size_t triangle, Vec2 st) const;
    /// The light at a point, 0 if no triangle contains it. Uses the grid, so make_grid() must have been called. A point
    /// outside all triangles, by at most the rounding of corners, is assigned to the nearest one.
    double at(const Vec2& p) const;
    std::array<Vec2, 3> corners(std::size_t triangle) const;
    /// Stored size, bytes: without the grid and the edge numbers, which are recomputed when the layer is read.
    std::size_t memory_bytes() const;
    const Contents& contents() const { return contents_; }

    /// Makes the grid. Must not run concurrently with readers.
    void make_grid();

  private:
    std::array<std::uint32_t, 3> ids(std::size_t triangle) const;
    std::array<double, 6> values(std::size_t triangle) const;
    void number_edges();

    Contents contents_;
    std::vector<std::array<std::uint32_t, 3>> edge_of_;  ///< Form `halves`: edge numbers, computed and not stored.
    std::size_t cells_ = 0;
    std::vector<std::vector<std::uint32_t>> grid_;
};

/// Returns why stored contents are invalid, or nothing if they are valid.
std::optional<std::string> find_nonsense(const LightLayer::Contents& contents);

}  // namespace exitance
