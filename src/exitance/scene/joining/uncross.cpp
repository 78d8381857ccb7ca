#include "exitance/scene/joining/uncross.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "exitance/scene/joining/weld.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_cuts_per_corner = 16;  ///< Limits the work for outlines whose edges all cross each other.

/// A point on an edge, by its parameter in [0, 1].
struct Crossing {
    double t;
    std::uint32_t node;
};

/// A directed edge of the arrangement; the opposite one has number `e ^ 1`.
struct HalfEdge {
    std::uint32_t from, to;
    /// Number of times the outline follows this edge, minus the number of times it runs in the opposite direction.
    int net = 0;
    double angle = 0;
    std::uint32_t next = 0, face = 0;
};

/// The planar arrangement of an outline's edges.
class Arrangement {
  public:
    Arrangement(std::span<const Point> outline, const Normal& n, double tolerance)
        : outline_(outline), frame_(n), tolerance_(tolerance), cuts_(outline.size()) {
        for (const Point& p : outline) flat_.push_back(flat(p));
    }
    UncrossedOutline run();

  private:
    Vec2 flat(const Point& p) const { return {dot(p - outline_[0], frame_.u), dot(p - outline_[0], frame_.v)}; }
    std::size_t after(std::size_t i) const { return (i + 1) % outline_.size(); }
    bool find_cuts();
    void cut_pair(std::size_t i, std::size_t k);
    void touch(std::size_t edge, std::size_t corner);
    void make_half_edges();
    void link_half_edges();
    void trace_faces();
    void find_windings();
    bool looks_along_normal() const;

    std::span<const Point> outline_;
    Frame frame_;
    double tolerance_;
    std::vector<Vec2> flat_;  ///< Corners, then crossings.
    std::vector<std::vector<Crossing>> cuts_;
    std::vector<std::uint32_t> place_;  ///< Per corner or crossing: the first one at the same position.
    UncrossedOutline out_;
    std::vector<HalfEdge> half_edges_;
    std::uint32_t first_half_edge_ = 0;  ///< Half-edge on the outline's first edge.
    std::vector<std::vector<std::uint32_t>> faces_;
    std::vector<double> area_;
    std::vector<int> winding_;
};

/// Cuts an edge at a corner in its interior.
void Arrangement::touch(std::size_t edge, std::size_t corner) {
    const Vec2 p = flat_[edge], d = flat_[after(edge)] - p, r = flat_[corner] - p;
    const double length = std::hypot(d.x, d.y), along = (r.x * d.x + r.y * d.y) / length;
    if (length > 0 && along > tolerance_ && along < length - tolerance_ && std::abs(cross(d, r)) <= tolerance_ * length)
        cuts_[edge].push_back({along / length, static_cast<std::uint32_t>(corner)});
}

/// Cuts two edges where they cross or touch.
void Arrangement::cut_pair(std::size_t i, std::size_t k) {
    const auto cut_before = cuts_[i].size() + cuts_[k].size();
    touch(i, k), touch(i, after(k)), touch(k, i), touch(k, after(i));
    if (cuts_[i].size() + cuts_[k].size() > cut_before) return;
    const Vec2 p = flat_[i], d = flat_[after(i)] - p, q = flat_[k], e = flat_[after(k)] - q;
    const double across = cross(d, e);
    if (across == 0) return;
    const double t = cross(q - p, e) / across, s = cross(q - p, d) / across;
    const double end_t = tolerance_ / std::hypot(d.x, d.y), end_s = tolerance_ / std::hypot(e.x, e.y);
    if (!(t > end_t && t < 1 - end_t && s > end_s && s < 1 - end_s)) return;
    const auto node = static_cast<std::uint32_t>(flat_.size());
    const Point on_i = outline_[i] + t * (outline_[after(i)] - outline_[i]),
                on_k = outline_[k] + s * (outline_[after(k)] - outline_[k]);
    out_.crossings.push_back(0.5 * (on_i + on_k));
    flat_.push_back(flat(out_.crossings.back()));
    cuts_[i].push_back({t, node}), cuts_[k].push_back({s, node});
}

bool Arrangement::find_cuts() {
    const std::size_t m = outline_.size();
    std::vector<std::size_t> order(m);
    std::iota(order.begin(), order.end(), std::size_t(0));
    const auto lo = [&](std::size_t i) { return std::min(flat_[i].x, flat_[after(i)].x) - tolerance_; };
    const auto hi = [&](std::size_t i) { return std::max(flat_[i].x, flat_[after(i)].x) + tolerance_; };
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return lo(a) < lo(b) || (lo(a) == lo(b) && a < b); });
    for (std::size_t a = 0; a < m; ++a)
        for (std::size_t b = a + 1; b < m && lo(order[b]) <= hi(order[a]); ++b) {
            cut_pair(std::min(order[a], order[b]), std::max(order[a], order[b]));
            if (out_.crossings.size() > max_cuts_per_corner * m) return false;
        }
    std::vector<Point> points(outline_.begin(), outline_.end());
    points.insert(points.end(), out_.crossings.begin(), out_.crossings.end());
    place_ = weld(points, tolerance_);
    return true;
}

void Arrangement::make_half_edges() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    bool has_first = false;
    const auto add = [&](std::uint32_t a, std::uint32_t b) {
        if (a == b) return;
        const auto [entry, is_new] =
            known.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(half_edges_.size()));
        if (is_new) {
            half_edges_.push_back({std::min(a, b), std::max(a, b)});
            half_edges_.push_back({std::max(a, b), std::min(a, b)});
        }
        const std::uint32_t e = entry->second + (a < b ? 0 : 1);
        ++half_edges_[e].net, --half_edges_[e ^ 1].net;
        if (!has_first) has_first = true, first_half_edge_ = e;
    };
    for (std::size_t i = 0; i < outline_.size(); ++i) {
        std::sort(cuts_[i].begin(), cuts_[i].end(),
                  [](const Crossing& a, const Crossing& b) { return a.t < b.t || (a.t == b.t && a.node < b.node); });
        std::uint32_t at = place_[i];
        for (const Crossing& cut : cuts_[i]) add(at, place_[cut.node]), at = place_[cut.node];
        add(at, place_[after(i)]);
    }
}

/// Sets the successor of every half-edge to the one that turns left most, so that its face stays on the left.
void Arrangement::link_half_edges() {
    std::map<std::uint32_t, std::vector<std::uint32_t>> leaving;
    for (std::uint32_t e = 0; e < half_edges_.size(); ++e) {
        const Vec2 d = flat_[half_edges_[e].to] - flat_[half_edges_[e].from];
        half_edges_[e].angle = std::atan2(d.y, d.x);
        leaving[half_edges_[e].from].push_back(e);
    }
    for (auto& [node, edges] : leaving) {
        std::sort(edges.begin(), edges.end(), [&](auto a, auto b) {
            return half_edges_[a].angle < half_edges_[b].angle ||
                   (half_edges_[a].angle == half_edges_[b].angle && a < b);
        });
        for (std::size_t k = 0; k < edges.size(); ++k) half_edges_[edges[(k + 1) % edges.size()] ^ 1].next = edges[k];
    }
}

void Arrangement::trace_faces() {
    std::vector<bool> seen(half_edges_.size());
    for (std::uint32_t start = 0; start < half_edges_.size(); ++start) {
        if (seen[start]) continue;
        std::vector<std::uint32_t>& corners = faces_.emplace_back();
        double twice_area = 0;
        for (std::uint32_t e = start; !seen[e]; e = half_edges_[e].next) {
            seen[e] = true, half_edges_[e].face = static_cast<std::uint32_t>(faces_.size() - 1);
            corners.push_back(half_edges_[e].from);
            twice_area += cross(flat_[half_edges_[e].from], flat_[half_edges_[e].to]);
        }
        area_.push_back(0.5 * twice_area);
    }
}

/// Computes winding numbers of faces, starting from the outer face, which has the smallest signed area, and crossing
/// edges.
void Arrangement::find_windings() {
    winding_.assign(faces_.size(), 0);
    if (faces_.empty()) return;
    std::vector<std::vector<std::uint32_t>> edges_of(faces_.size());
    for (std::uint32_t e = 0; e < half_edges_.size(); ++e) edges_of[half_edges_[e].face].push_back(e);
    std::vector<bool> seen(faces_.size());
    std::vector<std::uint32_t> open{
        static_cast<std::uint32_t>(std::min_element(area_.begin(), area_.end()) - area_.begin())};
    seen[open[0]] = true;
    for (std::size_t k = 0; k < open.size(); ++k)
        for (const std::uint32_t e : edges_of[open[k]]) {
            const std::uint32_t other = half_edges_[e ^ 1].face;
            if (seen[other]) continue;
            seen[other] = true, winding_[other] = winding_[open[k]] - half_edges_[e].net;
            open.push_back(other);
        }
}

bool Arrangement::looks_along_normal() const {
    double net = 0, all = 0;
    for (std::size_t f = 0; f < faces_.size(); ++f)
        net += winding_[f] * area_[f], all += std::abs(winding_[f] * area_[f]);
    constexpr double equal = 1e-6;  // share of the area, above the rounding error of files: symmetric outlines cancel
    if (std::abs(net) > equal * all) return net > 0;
    const int left = winding_[half_edges_[first_half_edge_].face],
              right = winding_[half_edges_[first_half_edge_ ^ 1].face];
    return left != 0 ? left > 0 : right > 0;
}

UncrossedOutline Arrangement::run() {
    if (!find_cuts()) return {};
    make_half_edges();
    link_half_edges();
    trace_faces();
    find_windings();
    const bool turned = !looks_along_normal();
    for (std::size_t f = 0; f < faces_.size(); ++f) {
        if (winding_[f] == 0 || !(area_[f] > 0)) continue;
        if (turned) std::reverse(faces_[f].begin(), faces_[f].end());
        out_.parts.push_back(std::move(faces_[f]));
    }
    return std::move(out_);
}

}  // namespace

UncrossedOutline uncross(std::span<const Point> outline, const Normal& n, double tolerance) {
    return Arrangement(outline, n, tolerance).run();
}

Normal normal_of_corners(std::span<const Point> outline) {
    Vec3 farthest, largest;
    for (const Point& p : outline)
        if (squared_norm(p - outline[0]) > squared_norm(farthest)) farthest = p - outline[0];
    for (const Point& p : outline)
        if (const Vec3 area = cross(farthest, p - outline[0]); squared_norm(area) > squared_norm(largest))
            largest = area;
    return norm(largest) > 0 ? normalized(largest) : Normal{};
}

}  // namespace exitance
