#include "exitance/solution/layers/light_layer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "exitance/base/check.hpp"
#include "exitance/base/limits.hpp"
#include "exitance/mesh/discontinuity/six_node_mesh.hpp"

namespace exitance {
namespace {

using Ends = std::pair<std::uint32_t, std::uint32_t>;

/// Numbers edges in the order in which triangles first use them.
class EdgeNumbers {
  public:
    /// Returns the numbers of a triangle's edges 0-1, 1-2, 2-0; `fresh` receives which of them are new.
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

/// Rounds to the nearest half float (IEEE 754 binary16: 5 bits exponent, 10 bits mantissa), ties to even, because not
/// every compiler has such a type. The spacing is 2^(e - 10) from 2^e on, and 2^-24 below 2^-14. The value must not be
/// NaN.
std::uint16_t to_half(double value) {
    const unsigned sign = std::signbit(value) ? 0x8000 : 0;
    const double size = std::abs(value);
    // Nearer to infinity than to the largest half float.
    if (size >= 65520) return static_cast<std::uint16_t>(sign | 0x7c00);
    const int exponent = size > 0 ? std::max(std::ilogb(size), -14) : -14;
    const int steps = static_cast<int>(std::nearbyint(std::ldexp(size, 10 - exponent)));
    return static_cast<std::uint16_t>(sign | static_cast<unsigned>(1024 * (exponent + 14) + steps));
}
double from_half(std::uint16_t bits) {
    const std::uint64_t sign = bits >> 15, exponent = bits >> 10 & 31, mantissa = bits & 1023;
    if (exponent == 0) return (sign ? -0x1p-24 : 0x1p-24) * static_cast<double>(mantissa);
    return std::bit_cast<double>(sign << 63 | (exponent == 31 ? 2047 : exponent + 1008) << 52 | mantissa << 42);
}

double interpolated(const std::array<double, 6>& values, Vec2 st) {
    const std::array<double, 6> weight = six_node_weights(st);
    double sum = 0;
    for (std::size_t i = 0; i < 6; ++i) sum += weight[i] * values[i];
    return sum;
}

/// Barycentric coordinates of p with respect to corners 1 and 2.
Vec2 barycentric(const std::array<Vec2, 3>& c, const Vec2& p) {
    const Vec2 a = c[1] - c[0], b = c[2] - c[0], d = p - c[0];
    const double area = cross(a, b);
    return {cross(d, b) / area, cross(a, d) / area};
}

constexpr double max_uint16 = 65535;
/// Share of the box: one step of the 16-bit coordinates; corners move by at most half a step.
constexpr double rounding = 1 / max_uint16;

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

std::size_t LayerTriangles::edge_count() const {
    EdgeNumbers numbers;
    std::array<bool, 3> fresh{};
    std::size_t edges = 0;
    for (const auto& c : corners) {
        numbers.add(c, fresh);
        edges += static_cast<std::size_t>(std::count(fresh.begin(), fresh.end(), true));
    }
    return edges;
}

LightLayer::LightLayer(const LayerTriangles& from, Form form) {
    Contents& c = contents_;
    c.form = form;
    Vec2 hi{-HUGE_VAL, -HUGE_VAL};
    for (const Vec2& p : from.points) {
        c.lo = {std::min(c.lo.x, p.x), std::min(c.lo.y, p.y)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
    if (!from.points.empty()) c.size = {std::max(hi.x - c.lo.x, min_divisor), std::max(hi.y - c.lo.y, min_divisor)};
    c.scale = 0;
    for (std::size_t t = 0; t < from.corners.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            c.scale = std::max({c.scale, std::abs(from.values[from.corners[t][k]]), std::abs(from.middles[t][k])});
    if (!(c.scale > 0)) c.scale = 1;
    std::vector<std::uint32_t> number(from.points.size(), unused);
    EdgeNumbers edges;
    std::vector<std::array<std::uint32_t, 3>> kept;
    for (std::size_t t = 0; t < from.corners.size(); ++t) {
        if (from.is_dark(t)) continue;
        std::array<std::uint32_t, 3> ids;
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& id = number[from.corners[t][k]];
            const Vec2& p = from.points[from.corners[t][k]];
            const double value = from.values[from.corners[t][k]];
            if (id == unused) {
                id = static_cast<std::uint32_t>(form == Form::floats ? c.vertices.size() : c.half_vertices.size());
                if (form == Form::floats)
                    c.vertices.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(value)});
                else
                    c.half_vertices.push_back(
                        {static_cast<std::uint16_t>(std::lround(max_uint16 * (p.x - c.lo.x) / c.size.x)),
                         static_cast<std::uint16_t>(std::lround(max_uint16 * (p.y - c.lo.y) / c.size.y)),
                         to_half(value / c.scale)});
            }
            ids[k] = id;
        }
        std::array<bool, 3> fresh{};
        const std::array<std::uint32_t, 3> e = edges.add(ids, fresh);
        for (std::size_t k = 0; k < 3; ++k) {
            if (!fresh[k]) continue;
            if (form == Form::floats)
                c.edges.push_back({unused, static_cast<float>(from.middles[t][k])});
            else
                c.half_edges.push_back(to_half(from.middles[t][k] / c.scale));
        }
        if (form == Form::floats) c.faces.push_back({ids[0], ids[1], ids[2], e[0], e[1], e[2]});
        kept.push_back(ids);
    }
    if (form == Form::floats) return;
    if (c.half_vertices.size() <= 0x10000) {
        for (const auto& k : kept)
            c.narrow.push_back(
                {static_cast<std::uint16_t>(k[0]), static_cast<std::uint16_t>(k[1]), static_cast<std::uint16_t>(k[2])});
    } else {
        c.wide = std::move(kept);
    }
    number_edges();
}

LightLayer::LightLayer(Contents contents) : contents_(std::move(contents)) {
    if (contents_.form == Form::halves) number_edges();
}

void LightLayer::number_edges() {
    EdgeNumbers edges;
    std::array<bool, 3> fresh{};
    for (std::size_t t = 0; t < size(); ++t) edge_of_.push_back(edges.add(ids(t), fresh));
}

std::array<std::uint32_t, 3> LightLayer::ids(std::size_t t) const {
    const Contents& c = contents_;
    if (c.form == Form::floats) return {c.faces[t][0], c.faces[t][1], c.faces[t][2]};
    if (!c.narrow.empty()) return {c.narrow[t][0], c.narrow[t][1], c.narrow[t][2]};
    return c.wide[t];
}

std::array<Vec2, 3> LightLayer::corners(std::size_t t) const {
    const Contents& c = contents_;
    std::array<Vec2, 3> out;
    const auto id = ids(t);
    for (std::size_t k = 0; k < 3; ++k) {
        if (c.form == Form::floats) {
            out[k] = {static_cast<double>(c.vertices[id[k]].u), static_cast<double>(c.vertices[id[k]].v)};
        } else {
            const HalfVertex& v = c.half_vertices[id[k]];
            out[k] = {c.lo.x + c.size.x * v.u / max_uint16, c.lo.y + c.size.y * v.v / max_uint16};
        }
    }
    return out;
}

std::array<double, 6> LightLayer::values(std::size_t t) const {
    const Contents& c = contents_;
    const bool floats = c.form == Form::floats;
    std::array<double, 6> out;
    const auto id = ids(t);
    for (std::size_t k = 0; k < 3; ++k) {
        out[k] =
            floats ? static_cast<double>(c.vertices[id[k]].value) : c.scale * from_half(c.half_vertices[id[k]].value);
        out[3 + k] = floats ? static_cast<double>(c.edges[c.faces[t][3 + k]].value)
                            : c.scale * from_half(c.half_edges[edge_of_[t][k]]);
    }
    return out;
}

double LightLayer::at(std::size_t triangle, Vec2 st) const {
    return interpolated(values(triangle), st);
}

void LightLayer::make_grid() {
    const Vec2 lo = contents_.lo, extent = contents_.size;
    cells_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::sqrt(static_cast<double>(size()))));
    grid_.assign(cells_ * cells_, {});
    const double n = static_cast<double>(cells_);
    const auto cell = [&](double x, double from, double width) {
        return static_cast<std::size_t>(std::clamp(n * (x - from) / width, 0.0, n - 1));
    };
    const Vec2 slack{rounding * extent.x, rounding * extent.y};
    for (std::size_t t = 0; t < size(); ++t) {
        const std::array<Vec2, 3> c = corners(t);
        const auto [x0, x1] = std::minmax({c[0].x, c[1].x, c[2].x});
        const auto [y0, y1] = std::minmax({c[0].y, c[1].y, c[2].y});
        for (std::size_t i = cell(x0 - slack.x, lo.x, extent.x); i <= cell(x1 + slack.x, lo.x, extent.x); ++i)
            for (std::size_t j = cell(y0 - slack.y, lo.y, extent.y); j <= cell(y1 + slack.y, lo.y, extent.y); ++j)
                grid_[i * cells_ + j].push_back(static_cast<std::uint32_t>(t));
    }
}

double LightLayer::at(const Vec2& p) const {
    EXI_CHECK(cells_ > 0);
    const Contents& c = contents_;
    const double n = static_cast<double>(cells_);
    const Vec2 in{(p.x - c.lo.x) / c.size.x, (p.y - c.lo.y) / c.size.y};
    if (!(in.x >= -rounding && in.x <= 1 + rounding && in.y >= -rounding && in.y <= 1 + rounding)) return 0;
    const auto i = static_cast<std::size_t>(std::clamp(n * in.x, 0.0, n - 1)),
               j = static_cast<std::size_t>(std::clamp(n * in.y, 0.0, n - 1));
    // A negative coordinate is the distance of the point beyond an edge, relative to the triangle's height over it.
    double nearest = rounding * std::max(c.size.x, c.size.y), light = 0;
    for (const std::uint32_t t : grid_[i * cells_ + j]) {
        const std::array<Vec2, 3> corner = corners(t);
        const Vec2 st = barycentric(corner, p);
        const std::array<double, 3> L{1 - st.x - st.y, st.x, st.y};
        if (L[0] >= 0 && L[1] >= 0 && L[2] >= 0) return at(t, st);
        const double twice = std::abs(cross(corner[1] - corner[0], corner[2] - corner[0]));
        if (!std::isfinite(st.x) || !std::isfinite(st.y)) continue;  // degenerate after rounding
        double beyond = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2 edge = corner[(k + 2) % 3] - corner[(k + 1) % 3];
            beyond = std::max(beyond, -L[k] * twice / std::sqrt(dot(edge, edge)));
        }
        if (beyond < nearest) {
            nearest = beyond;
            const double s = std::max(st.x, 0.0), u = std::max(st.y, 0.0), whole = std::max(1.0, s + u);
            light = at(t, {s / whole, u / whole});
        }
    }
    return light;
}

std::size_t LightLayer::memory_bytes() const {
    const Contents& c = contents_;
    return c.vertices.size() * sizeof(FloatVertex) + c.edges.size() * sizeof(FloatEdge) +
           c.faces.size() * sizeof(c.faces[0]) + c.half_vertices.size() * sizeof(HalfVertex) +
           c.half_edges.size() * sizeof(c.half_edges[0]) + c.narrow.size() * sizeof(c.narrow[0]) +
           c.wide.size() * sizeof(c.wide[0]);
}

std::optional<std::string> find_nonsense(const LightLayer::Contents& c) {
    const auto is_box = [](double lo, double size) { return std::isfinite(lo) && std::isfinite(size) && size > 0; };
    if (c.triangles() > 0 && (!is_box(c.lo.x, c.size.x) || !is_box(c.lo.y, c.size.y) || !(c.scale > 0)))
        return "has no box or no scale";
    for (const auto& v : c.vertices)
        if (!std::isfinite(v.u) || !std::isfinite(v.v) || !std::isfinite(v.value)) return "holds a number not finite";
    for (const auto& e : c.edges)
        if (!std::isfinite(e.value)) return "holds a number not finite";
    for (const auto& v : c.half_vertices)
        if (!std::isfinite(from_half(v.value))) return "holds a number not finite";
    for (const std::uint16_t e : c.half_edges)
        if (!std::isfinite(from_half(e))) return "holds a number not finite";
    if (!c.narrow.empty() && !c.wide.empty()) return "has ids of two sizes";
    EdgeNumbers edges;
    std::array<bool, 3> fresh{};
    std::size_t count = 0;
    const auto leads_astray = [&](const std::array<std::uint32_t, 3>& ids) {
        edges.add(ids, fresh);
        count += static_cast<std::size_t>(std::count(fresh.begin(), fresh.end(), true));
        return std::any_of(ids.begin(), ids.end(), [&](std::uint32_t i) { return i >= c.half_vertices.size(); });
    };
    for (const auto& t : c.narrow)
        if (leads_astray({t[0], t[1], t[2]})) return "leads to a corner that does not exist";
    for (const auto& t : c.wide)
        if (leads_astray(t)) return "leads to a corner that does not exist";
    if (c.form == LightLayer::Form::halves && count != c.half_edges.size()) return "has not one value an edge";
    for (const auto& t : c.faces)
        for (std::size_t k = 0; k < 3; ++k)
            if (t[k] >= c.vertices.size() || t[3 + k] >= c.edges.size()) return "leads to a corner that does not exist";
    return {};
}

}  // namespace exitance
