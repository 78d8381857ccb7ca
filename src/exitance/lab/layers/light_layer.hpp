#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/lab/dm_tree/winged_edge_mesh.hpp"

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
    enum class Form : std::uint8_t { floats, halves };
    static constexpr std::uint32_t unused = 0xffffffffu;

    struct FloatVertex {
        float u, v, value;
    };
    struct FloatEdge {
        std::uint32_t curve;  ///< unused: none is kept.
        float value;
    };
    struct HalfVertex {
        std::uint16_t u, v, value;
    };
    /// What is stored of it.
    struct Contents {
        Form form = Form::floats;
        Vec2 lo{HUGE_VAL, HUGE_VAL}, size{1, 1};  ///< The box that 16-bit coordinates are in, metres.
        double scale = 1;                         ///< Of half floats: the largest value.
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
    /// `contents` must make sense: see find_nonsense.
    explicit LightLayer(Contents contents);

    std::size_t size() const { return contents_.triangles(); }
    double at(std::size_t triangle, Vec2 st) const;
    /// The light at a place; 0 where no triangle holds it. By the grid, which must be made. A place beside all
    /// triangles, by no more than corners are moved when they are rounded, is in the nearest.
    double at(const Vec2& p) const;
    std::array<Vec2, 3> corners(std::size_t triangle) const;
    /// As it is stored: without the grid, and without the numbers of edges, which are counted again when it is read.
    std::size_t memory_bytes() const;
    const Contents& contents() const { return contents_; }

    /// Makes the grid. Not while others read.
    void make_grid();

  private:
    std::array<std::uint32_t, 3> ids(std::size_t triangle) const;
    std::array<double, 6> values(std::size_t triangle) const;
    void number_edges();

    Contents contents_;
    std::vector<std::array<std::uint32_t, 3>> edge_of_;  ///< Of the form of halves: counted, not stored.
    std::size_t cells_ = 0;
    std::vector<std::vector<std::uint32_t>> grid_;
};

/// Why stored contents make no layer, if they do not.
std::optional<std::string> find_nonsense(const LightLayer::Contents& contents);

}  // namespace exitance
