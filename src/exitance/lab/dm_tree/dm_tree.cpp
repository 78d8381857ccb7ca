#include "exitance/lab/dm_tree/dm_tree.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
DmTree::DmTree(std::span<const Vec2> outline, double tolerance) : tolerance_(tolerance), mesh_(outline) {
    Node leaf;
    leaf.face = 0;
    nodes_.push_back(leaf);
}

void DmTree::insert(const Vec2& from, const Vec2& to, std::uint32_t curve) {
    struct Job {
        std::uint32_t node;
        Vec2 a, b;
    };
    std::vector<Job> jobs{{0, from, to}};
    while (!jobs.empty()) {
        const Job job = jobs.back();
        jobs.pop_back();
        if (length(job.b - job.a) <= tolerance_) continue;
        const Node node = nodes_[job.node];
        if (node.face != WingedEdgeMesh::none) {
            cut_leaf(job.node, job.a, job.b, curve);
            continue;
        }
        const double da = node.distance(job.a), db = node.distance(job.b);
        if (std::max(std::abs(da), std::abs(db)) <= tolerance_) continue;  // it is on an existing line
        if (std::min(da, db) >= -tolerance_) {
            jobs.push_back({node.left, job.a, job.b});
        } else if (std::max(da, db) <= tolerance_) {
            jobs.push_back({node.right, job.a, job.b});
        } else {
            const Vec2 x = job.a + (da / (da - db)) * (job.b - job.a);
            jobs.push_back({da > 0 ? node.left : node.right, job.a, x});
            jobs.push_back({da > 0 ? node.right : node.left, x, job.b});
        }
    }
}

void DmTree::cut_leaf(std::uint32_t at, const Vec2& a, const Vec2& b, std::uint32_t curve) {
    const Vec2 along = (1 / length(b - a)) * (b - a);
    Node line;
    line.normal = {-along.y, along.x};
    line.offset = dot(line.normal, a);
    const std::uint32_t face = nodes_[at].face;
    const std::vector<WingedEdgeMesh::Corner> corners = mesh_.loop(face);
    const auto at_vertex = [&](std::uint32_t v) { return mesh_.vertices()[v].at; };
    std::vector<double> height;
    for (const auto& corner : corners) height.push_back(line.distance(at_vertex(corner.vertex)));
    const auto [lowest, highest] = std::minmax_element(height.begin(), height.end());
    if (*lowest >= -tolerance_ || *highest <= tolerance_) return;  // along the border of the face
    // Find where the line enters and leaves the face: where heights change sign.
    std::array<std::uint32_t, 2> ends{WingedEdgeMesh::none, WingedEdgeMesh::none};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::size_t j = (i + 1) % corners.size();
        const double p = height[i], q = height[j];
        std::uint32_t found = WingedEdgeMesh::none;
        if (std::abs(p) <= tolerance_) {
            found = corners[i].vertex;
        } else if (std::abs(q) > tolerance_ && (p > 0) != (q > 0)) {
            const Vec2 x = at_vertex(corners[i].vertex), y = at_vertex(corners[j].vertex);
            found = mesh_.cut_edge(corners[i].edge, x + (p / (p - q)) * (y - x));
        }
        if (found == WingedEdgeMesh::none) continue;
        (ends[0] == WingedEdgeMesh::none ? ends[0] : ends[1]) = found;
    }
    if (ends[1] == WingedEdgeMesh::none) return;
    if (dot(at_vertex(ends[1]) - at_vertex(ends[0]), along) < 0) std::swap(ends[0], ends[1]);
    std::uint32_t edge = mesh_.cut_face(face, ends[0], ends[1]);
    const auto other = static_cast<std::uint32_t>(mesh_.faces().size() - 1);  // the face on the left of the line
    // Construction edges extend the curve's ends to the face's border.
    const double first = dot(at_vertex(ends[0]), along), last = dot(at_vertex(ends[1]), along);
    const double begin = dot(a, along), end = dot(b, along);
    if (end < last - tolerance_ && end > first + tolerance_) mesh_.cut_edge(edge, b);
    if (begin > first + tolerance_ && begin < last - tolerance_) {
        mesh_.cut_edge(edge, a);
        edge = static_cast<std::uint32_t>(mesh_.edges().size() - 1);
    }
    mesh_.set_curve(edge, curve);

    Node left, right;
    left.face = other, right.face = face;
    line.left = static_cast<std::uint32_t>(nodes_.size());
    line.right = line.left + 1;
    nodes_.push_back(left);
    nodes_.push_back(right);
    nodes_[at] = line;
}

void DmTree::insert_grid(std::size_t count) {
    Vec2 lo = mesh_.vertices()[0].at, hi = lo;
    for (const auto& v : mesh_.vertices()) {
        lo = {std::min(lo.x, v.at.x), std::min(lo.y, v.at.y)};
        hi = {std::max(hi.x, v.at.x), std::max(hi.y, v.at.y)};
    }
    for (std::size_t i = 1; i < count; ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(count);
        const double x = lo.x + t * (hi.x - lo.x), y = lo.y + t * (hi.y - lo.y);
        insert({x, lo.y}, {x, hi.y}, WingedEdgeMesh::none);
        insert({lo.x, y}, {hi.x, y}, WingedEdgeMesh::none);
    }
}

std::size_t DmTree::construction_edges() const {
    return static_cast<std::size_t>(
        std::count_if(mesh_.edges().begin(), mesh_.edges().end(), [](const WingedEdgeMesh::Edge& e) {
            return e.curve == WingedEdgeMesh::none && e.face[0] != WingedEdgeMesh::none &&
                   e.face[1] != WingedEdgeMesh::none;
        }));
}

}  // namespace exitance
