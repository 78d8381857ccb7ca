#include "exitance/mesh/dm_tree/light_layer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "exitance/core/check.hpp"
#include "exitance/mesh/discontinuity/six_node_mesh.hpp"

namespace exitance {
namespace {

using Ends = std::pair<std::uint32_t, std::uint32_t>;

/// Numbers edges in the order in which triangles come to them.
class EdgeNumbers {
  public:
    /// Of a triangle's edges 0-1, 1-2, 2-0; `fresh` tells which are new.
    std::array<std::uint32_t, 3> add(const std::array<std::uint32_t, 3>& corners, std::array<bool, 3>& fresh) {
        std::array<std::uint32_t, 3> out;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [at, is_new] = numbers_.try_emplace(std::minmax(corners[k], corners[(k + 1) % 3]),
                                                           static_cast<std::uint32_t>(numbers_.size()));
            out[k] = at->second, fresh[k] = is_new;
        }
        return out;
    }

  private:
    std::map<Ends, std::uint32_t> numbers_;
};

std::uint16_t to_half(double value) {
    return std::bit_cast<std::uint16_t>(static_cast<_Float16>(value));
}
double from_half(std::uint16_t bits) {
    return static_cast<double>(std::bit_cast<_Float16>(bits));
}

double interpolated(const std::array<double, 6>& values, Vec2 st) {
    const std::array<double, 6> weight = six_node_weights(st);
    double sum = 0;
    for (std::size_t i = 0; i < 6; ++i) sum += weight[i] * values[i];
    return sum;
}

/// Barycentric coordinates of p, those of corners 1 and 2.
Vec2 barycentric(const std::array<Vec2, 3>& c, const Vec2& p) {
    const Vec2 a = c[1] - c[0], b = c[2] - c[0], d = p - c[0];
    const double area = cross(a, b);
    return {cross(d, b) / area, cross(a, d) / area};
}

constexpr double most16 = 65535;

}  // namespace

bool LayerTriangles::is_dark(std::size_t t) const {
    return std::all_of(corners[t].begin(), corners[t].end(), [&](std::uint32_t p) { return values[p] == 0; }) &&
           std::all_of(middles[t].begin(), middles[t].end(), [](double v) { return v == 0; });
}

double LayerTriangles::at(std::size_t t, Vec2 st) const {
    return interpolated({values[corners[t][0]], values[corners[t][1]], values[corners[t][2]], middles[t][0],
                         middles[t][1], middles[t][2]},
                        st);
}

std::size_t winged_edge_bytes(const LayerTriangles& triangles) {
    EdgeNumbers numbers;
    std::array<bool, 3> fresh{};
    std::size_t edges = 0;
    for (const auto& c : triangles.corners) {
        numbers.add(c, fresh);
        edges += static_cast<std::size_t>(std::count(fresh.begin(), fresh.end(), true));
    }
    return triangles.points.size() * sizeof(WingedEdgeMesh::Vertex) + edges * sizeof(WingedEdgeMesh::Edge) +
           triangles.corners.size() * sizeof(WingedEdgeMesh::Face);
}

LightLayer::LightLayer(const LayerTriangles& from, Form form) : form_(form), lo_{HUGE_VAL, HUGE_VAL} {
    Vec2 hi{-HUGE_VAL, -HUGE_VAL};
    for (const Vec2& p : from.points) {
        lo_ = {std::min(lo_.x, p.x), std::min(lo_.y, p.y)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
    size_ = from.points.empty() ? Vec2{1, 1} : Vec2{std::max(hi.x - lo_.x, 1e-300), std::max(hi.y - lo_.y, 1e-300)};
    for (std::size_t t = 0; t < from.corners.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            scale_ = std::max(
                {t + k == 0 ? 0 : scale_, std::abs(from.values[from.corners[t][k]]), std::abs(from.middles[t][k])});
    if (!(scale_ > 0)) scale_ = 1;
    constexpr std::uint32_t unused = 0xffffffffu;
    std::vector<std::uint32_t> number(from.points.size(), unused);
    EdgeNumbers edges;
    std::vector<std::array<std::uint32_t, 3>> kept;
    for (std::size_t t = 0; t < from.corners.size(); ++t) {
        if (from.is_dark(t)) continue;
        std::array<std::uint32_t, 3> c;
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& id = number[from.corners[t][k]];
            const Vec2& p = from.points[from.corners[t][k]];
            const double value = from.values[from.corners[t][k]];
            if (id == unused) {
                id = static_cast<std::uint32_t>(form == Form::floats ? vertices_.size() : half_vertices_.size());
                if (form == Form::floats)
                    vertices_.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(value)});
                else
                    half_vertices_.push_back({static_cast<std::uint16_t>(std::lround(most16 * (p.x - lo_.x) / size_.x)),
                                              static_cast<std::uint16_t>(std::lround(most16 * (p.y - lo_.y) / size_.y)),
                                              to_half(value / scale_)});
            }
            c[k] = id;
        }
        std::array<bool, 3> fresh{};
        const std::array<std::uint32_t, 3> e = edges.add(c, fresh);
        for (std::size_t k = 0; k < 3; ++k) {
            if (!fresh[k]) continue;
            if (form == Form::floats)
                edges_.push_back({unused, static_cast<float>(from.middles[t][k])});
            else
                half_edges_.push_back(to_half(from.middles[t][k] / scale_));
        }
        if (form == Form::floats) faces_.push_back({c[0], c[1], c[2], e[0], e[1], e[2]});
        kept.push_back(c);
    }
    if (form == Form::floats) return;
    if (half_vertices_.size() <= 0x10000) {
        for (const auto& c : kept)
            narrow_.push_back(
                {static_cast<std::uint16_t>(c[0]), static_cast<std::uint16_t>(c[1]), static_cast<std::uint16_t>(c[2])});
    } else {
        wide_ = std::move(kept);
    }
    number_edges();
}

void LightLayer::number_edges() {
    EdgeNumbers edges;
    std::array<bool, 3> fresh{};
    for (std::size_t t = 0; t < size(); ++t) edge_of_.push_back(edges.add(ids(t), fresh));
}

std::array<std::uint32_t, 3> LightLayer::ids(std::size_t t) const {
    if (form_ == Form::floats) return {faces_[t][0], faces_[t][1], faces_[t][2]};
    if (!narrow_.empty()) return {narrow_[t][0], narrow_[t][1], narrow_[t][2]};
    return wide_[t];
}

std::array<Vec2, 3> LightLayer::corners(std::size_t t) const {
    std::array<Vec2, 3> out;
    const auto c = ids(t);
    for (std::size_t k = 0; k < 3; ++k) {
        if (form_ == Form::floats) {
            out[k] = {static_cast<double>(vertices_[c[k]].u), static_cast<double>(vertices_[c[k]].v)};
        } else {
            const HalfVertex& v = half_vertices_[c[k]];
            out[k] = {lo_.x + size_.x * v.u / most16, lo_.y + size_.y * v.v / most16};
        }
    }
    return out;
}

std::array<double, 6> LightLayer::values(std::size_t t) const {
    std::array<double, 6> out;
    const auto c = ids(t);
    for (std::size_t k = 0; k < 3; ++k) {
        out[k] = form_ == Form::floats ? static_cast<double>(vertices_[c[k]].value)
                                       : scale_ * from_half(half_vertices_[c[k]].value);
        out[3 + k] = form_ == Form::floats ? static_cast<double>(edges_[faces_[t][3 + k]].value)
                                           : scale_ * from_half(half_edges_[edge_of_[t][k]]);
    }
    return out;
}

double LightLayer::at(std::size_t triangle, Vec2 st) const {
    return interpolated(values(triangle), st);
}

void LightLayer::make_grid() {
    cells_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::sqrt(static_cast<double>(size()))));
    grid_.assign(cells_ * cells_, {});
    const double n = static_cast<double>(cells_);
    const auto cell = [&](double x, double lo, double size) {
        return static_cast<std::size_t>(std::clamp(n * (x - lo) / size, 0.0, n - 1));
    };
    for (std::size_t t = 0; t < size(); ++t) {
        const std::array<Vec2, 3> c = corners(t);
        const auto [x0, x1] = std::minmax({c[0].x, c[1].x, c[2].x});
        const auto [y0, y1] = std::minmax({c[0].y, c[1].y, c[2].y});
        for (std::size_t i = cell(x0, lo_.x, size_.x); i <= cell(x1, lo_.x, size_.x); ++i)
            for (std::size_t j = cell(y0, lo_.y, size_.y); j <= cell(y1, lo_.y, size_.y); ++j)
                grid_[i * cells_ + j].push_back(static_cast<std::uint32_t>(t));
    }
}

double LightLayer::at(const Vec2& p) const {
    EXI_CHECK(cells_ > 0);
    const double n = static_cast<double>(cells_), x = n * (p.x - lo_.x) / size_.x, y = n * (p.y - lo_.y) / size_.y;
    if (!(x >= 0 && x <= n && y >= 0 && y <= n)) return 0;
    const auto i = std::min(cells_ - 1, static_cast<std::size_t>(x)),
               j = std::min(cells_ - 1, static_cast<std::size_t>(y));
    constexpr double slack = 1e-6;
    for (std::uint32_t t : grid_[i * cells_ + j]) {
        const Vec2 st = barycentric(corners(t), p);
        if (st.x >= -slack && st.y >= -slack && st.x + st.y <= 1 + slack) return at(t, st);
    }
    return 0;
}

std::size_t LightLayer::memory_bytes() const {
    return vertices_.size() * sizeof(FloatVertex) + edges_.size() * sizeof(FloatEdge) +
           faces_.size() * sizeof(faces_[0]) + half_vertices_.size() * sizeof(HalfVertex) +
           half_edges_.size() * sizeof(half_edges_[0]) + narrow_.size() * sizeof(narrow_[0]) +
           wide_.size() * sizeof(wide_[0]);
}

}  // namespace exitance
