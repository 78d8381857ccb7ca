#include "exitance/mesh/discontinuity/bisection_mesh.hpp"

#include <algorithm>
#include <tuple>

#include "exitance/base/check.hpp"
#include "exitance/base/disjoint_sets.hpp"

namespace exitance {
namespace {

/// Groups the triangle corners that share a node: those connected across edges without a discontinuity.
class CornerSectors {
  public:
    explicit CornerSectors(const LabelledTriangles& t) : triangles_(t), sets_(3 * t.corners.size()) {
        const std::size_t points = t.points.size();
        jump_.resize(points), ends_.resize(points), singular_.resize(points);
        for (std::size_t i = 0; i < t.corners.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) look_at_edge(i, k);
    }

    std::uint32_t sector(std::size_t triangle, std::size_t corner) {
        return sets_.root(static_cast<std::uint32_t>(3 * triangle + corner));
    }
    bool is_singular(std::uint32_t point) const { return singular_[point] && jump_[point]; }
    bool on_cut(std::uint32_t point) const { return ends_[point].x != 0 || ends_[point].y != 0; }

  private:
    void look_at_edge(std::size_t i, std::size_t k) {
        const std::uint8_t label = triangles_.labels[i][k];
        const std::uint32_t n = triangles_.neighbors[i][k], a = triangles_.corners[i][k],
                            b = triangles_.corners[i][(k + 1) % 3];
        if (label <= static_cast<std::uint8_t>(CurveOrder::d0) || n == LabelledTriangles::none) {
            for (const std::uint32_t p : {a, b}) meet(p, triangles_.points[b] - triangles_.points[a]);
            if (label == static_cast<std::uint8_t>(CurveOrder::d0)) jump_[a] = jump_[b] = true;
            return;
        }
        for (std::size_t m = 0; m < 3; ++m) {
            if (triangles_.corners[n][m] == a) sets_.unite(number(i, k), number(n, m));
            if (triangles_.corners[n][m] == b) sets_.unite(number(i, (k + 1) % 3), number(n, m));
        }
    }
    /// Records a cut edge at a point. The point is singular if cut edges of different directions meet there.
    void meet(std::uint32_t p, Vec2 d) {
        Vec2& known = ends_[p];
        constexpr double straight = 1e-6;  // sine up to which directions count as equal; derived from coplanar_share
        if (known.x == 0 && known.y == 0)
            known = d;
        else if (std::abs(cross(known, d)) > straight * std::sqrt(dot(known, known) * dot(d, d)))
            singular_[p] = true;
    }
    static std::uint32_t number(std::size_t triangle, std::size_t corner) {
        return static_cast<std::uint32_t>(3 * triangle + corner);
    }

    const LabelledTriangles& triangles_;
    DisjointSets sets_;
    std::vector<bool> jump_, singular_;
    std::vector<Vec2> ends_;  ///< Direction of a cut edge at each point.
};

}  // namespace

Point BisectionMesh::centre_of(const Triangle& t) const {
    return (1.0 / 3) * (nodes_[t.corner[0]].at + nodes_[t.corner[1]].at + nodes_[t.corner[2]].at);
}
Point BisectionMesh::centre(std::uint32_t triangle) const {
    return centre_of(triangles_[triangle]);
}
double BisectionMesh::area(std::uint32_t triangle) const {
    const auto& c = triangles_[triangle].corner;
    return 0.5 * norm(cross(nodes_[c[1]].at - nodes_[c[0]].at, nodes_[c[2]].at - nodes_[c[0]].at));
}
double BisectionMesh::longest_edge(std::uint32_t triangle) const {
    const Triangle& t = triangles_[triangle];
    return norm(nodes_[t.corner[(t.longest + 1) % 3]].at - nodes_[t.corner[t.longest]].at);
}

/// A step of length nudge_ in a direction, but at most a share of the way.
Vec3 BisectionMesh::inwards(const Vec3& way) const {
    constexpr double max_share = 0.3;  // derived from steps to a triangle's centre, which are to end well inside
    const double distance = norm(way);
    return distance > 0 ? std::min(nudge_ / distance, max_share) * way : Vec3();
}

std::uint32_t BisectionMesh::add_node(const Point& at, const Triangle& t, bool nudged) {
    nodes_.push_back({at, nudged ? at + inwards(centre_of(t) - at) : at, t.face});
    singular_.push_back(false), widest_.push_back(0);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
}

void BisectionMesh::find_longest(std::uint32_t triangle) {
    Triangle& t = triangles_[triangle];
    // Both triangles at an edge compute the same length and middle node, so both order edges consistently.
    std::tuple<double, std::uint32_t> best{-1, 0};
    for (std::uint32_t i = 0; i < 3; ++i) {
        const Vec3 d = nodes_[t.corner[(i + 1) % 3]].at - nodes_[t.corner[i]].at;
        const std::tuple<double, std::uint32_t> now{squared_norm(d), t.middle[i]};
        if (now > best) best = now, t.longest = i;
    }
}

void BisectionMesh::add_quarters(std::uint32_t triangle, std::size_t i) {
    const Triangle t = triangles_[triangle];
    const bool nudged = is_cut(t, i);
    const Point middle = nodes_[t.middle[i]].at;
    for (std::size_t k = 0; k < 2; ++k)
        triangles_[triangle].quarter[i][k] = add_node(0.5 * (nodes_[t.corner[(i + k) % 3]].at + middle), t, nudged);
}

void BisectionMesh::add_inner(std::uint32_t triangle) {
    const Triangle t = triangles_[triangle];
    triangles_[triangle].inner =
        add_node(0.5 * (nodes_[t.middle[t.longest]].at + nodes_[t.corner[(t.longest + 2) % 3]].at), t, false);
}

/// Copies an edge's middle and quarter nodes from the neighbour.
void BisectionMesh::share_edge(std::uint32_t triangle, std::size_t i) {
    Triangle& t = triangles_[triangle];
    const Triangle& n = triangles_[t.neighbor[i]];
    for (std::size_t j = 0; j < 3; ++j) {
        if (n.neighbor[j] != triangle) continue;
        t.middle[i] = n.middle[j];
        t.quarter[i] = {n.quarter[j][1], n.quarter[j][0]};
    }
}

void BisectionMesh::add(const LabelledTriangles& in, const PlaneFrame& frame) {
    CornerSectors sectors(in);
    const auto base = static_cast<std::uint32_t>(triangles_.size());
    std::vector<std::uint32_t> node_of(3 * in.corners.size(), none);
    for (std::size_t i = 0; i < in.corners.size(); ++i) {
        Triangle t;
        t.face = base + static_cast<std::uint32_t>(i);
        t.middle.fill(none), t.neighbor.fill(none), t.corner.fill(none);
        t.quarter.fill({none, none});
        Point corner[3];
        for (std::size_t k = 0; k < 3; ++k) corner[k] = frame.at(in.points[in.corners[i][k]]);
        const Point centre = (1.0 / 3) * (corner[0] + corner[1] + corner[2]);
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, norm(corner[(k + 1) % 3] - corner[k]));
        const double width = norm(cross(corner[1] - corner[0], corner[2] - corner[0])) / longest;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t p = in.corners[i][k], n = in.neighbors[i][k];
            t.order[k] = static_cast<CurveOrder>(in.labels[i][k]);
            if (n == LabelledTriangles::none) t.order[k] = CurveOrder::border;
            if (!is_cut(t, k)) t.neighbor[k] = base + n;
            std::uint32_t& shared = node_of[sectors.sector(i, k)];
            if (shared == none || sectors.is_singular(p)) {
                shared = static_cast<std::uint32_t>(nodes_.size());
                nodes_.push_back({corner[k], corner[k], t.face});
                widest_.push_back(-1);
                singular_.push_back(sectors.is_singular(p));
            }
            // The widest of the triangles around a node provides its evaluation point: inside a sliver it would be too
            // close to the border.
            if (sectors.on_cut(p) && width > widest_[shared]) {
                widest_[shared] = width;
                nodes_[shared].face = t.face;
                nodes_[shared].seen_from = corner[k] + inwards(centre - corner[k]);
            }
            t.corner[k] = shared;
        }
        triangles_.push_back(t);
    }
    is_changed_.resize(triangles_.size(), false);
    const auto end = static_cast<std::uint32_t>(triangles_.size());
    for (std::uint32_t t = base; t < end; ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            if (triangles_[t].neighbor[k] < t) {
                share_edge(t, k);
                continue;
            }
            const Triangle& now = triangles_[t];
            const Point at = 0.5 * (nodes_[now.corner[k]].at + nodes_[now.corner[(k + 1) % 3]].at);
            const std::uint32_t node = add_node(at, now, is_cut(now, k));
            triangles_[t].middle[k] = node;
            add_quarters(t, k);
        }
    for (std::uint32_t t = base; t < end; ++t) finish(t);
}

void BisectionMesh::finish(std::uint32_t t) {
    find_longest(t);
    add_inner(t);
    if (!is_changed_[t]) is_changed_[t] = true, changed_.push_back(t);
}

std::vector<std::uint32_t> BisectionMesh::take_changed() {
    for (const std::uint32_t t : changed_) is_changed_[t] = false;
    return std::exchange(changed_, {});
}

/// Splits one triangle across its longest edge. It becomes the part where that edge begins; returns the index of the
/// other part. Sets only the data of the inside and of the outer edges' neighbours.
std::uint32_t BisectionMesh::split(std::uint32_t number) {
    const Triangle t = triangles_[number];
    const std::size_t i = t.longest, j = (i + 1) % 3, k = (i + 2) % 3;
    const auto other = static_cast<std::uint32_t>(triangles_.size());
    Triangle a = t, b = t;
    a.depth = b.depth = static_cast<std::uint8_t>(std::min(t.depth + 1, 255));
    a.corner = {t.corner[i], t.middle[i], t.corner[k]};
    b.corner = {t.middle[i], t.corner[j], t.corner[k]};
    a.middle = {t.quarter[i][0], t.inner, t.middle[k]};
    b.middle = {t.quarter[i][1], t.middle[j], t.inner};
    a.quarter = {std::array{none, none}, {none, none}, t.quarter[k]};
    b.quarter = {std::array{none, none}, t.quarter[j], {none, none}};
    a.order = {t.order[i], CurveOrder::none, t.order[k]};
    b.order = {t.order[i], t.order[j], CurveOrder::none};
    a.neighbor = {none, other, t.neighbor[k]};
    b.neighbor = {none, t.neighbor[j], number};
    triangles_[number] = a;
    triangles_.push_back(b), is_changed_.push_back(false);
    if (b.neighbor[1] != none)
        for (std::uint32_t& n : triangles_[b.neighbor[1]].neighbor)
            if (n == number) n = other;
    if (singular_[t.corner[k]]) {
        triangles_[other].corner[2] = add_node(nodes_[t.corner[k]].at, b, true);
        singular_.back() = true;
    }
    add_quarters(number, 1);
    triangles_[other].quarter[2] = {triangles_[number].quarter[1][1], triangles_[number].quarter[1][0]};
    return other;
}

void BisectionMesh::join(std::uint32_t a, std::size_t edge, std::uint32_t b, std::size_t other) {
    triangles_[a].neighbor[edge] = b, triangles_[b].neighbor[other] = a;
    share_edge(b, other);
}

void BisectionMesh::bisect(std::uint32_t triangle) {
    pending_ = {triangle};
    while (!pending_.empty()) {
        const std::uint32_t t = pending_.back();
        const std::uint32_t n = triangles_[t].neighbor[triangles_[t].longest];
        if (n != none && triangles_[n].neighbor[triangles_[n].longest] != t) {
            EXI_CHECK(pending_.size() <= triangles_.size());
            pending_.push_back(n);
            continue;
        }
        pending_.pop_back();
        const std::uint32_t t2 = split(t);
        add_quarters(t, 0), add_quarters(t2, 0);
        if (n != none) {
            const std::uint32_t n2 = split(n);
            join(t, 0, n2, 0), join(t2, 0, n, 0);
            finish(n), finish(n2);
        }
        finish(t), finish(t2);
    }
}

}  // namespace exitance
