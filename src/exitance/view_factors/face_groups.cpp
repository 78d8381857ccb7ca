#include "exitance/view_factors/face_groups.hpp"

#include <algorithm>
#include <cmath>
#include <compare>

#include "exitance/base/disjoint_sets.hpp"
#include "exitance/scene/borders.hpp"
#include "exitance/visibility/narrow_gaps.hpp"

namespace exitance {
namespace {

struct Edge {
    std::uint32_t low, high, face;
    bool is_forward;
    bool joins(const Edge& other) const { return low == other.low && high == other.high; }
    auto operator<=>(const Edge&) const = default;
};

/// The edges of all faces, sorted by their ends. Corners nearer than `tolerance` (metres) are equal.
std::vector<Edge> sorted_edges(std::span<const ViewFace> faces, double tolerance) {
    std::vector<Point> corners;
    for (const ViewFace& face : faces) corners.insert(corners.end(), face.outline.begin(), face.outline.end());
    const std::vector<std::uint32_t> place = weld(corners, tolerance);
    std::vector<Edge> edges;
    edges.reserve(corners.size());
    std::size_t first = 0;
    for (std::uint32_t k = 0; k < faces.size(); ++k) {
        const std::size_t n = faces[k].outline.size();
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint32_t from = place[first + i], to = place[first + (i + 1) % n];
            if (from != to) edges.push_back({std::min(from, to), std::max(from, to), k, from < to});
        }
        first += n;
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

}  // namespace

FaceGroups::FaceGroups(std::span<const ViewFace> faces, double slack)
    : faces_(faces), slack_(slack), group_(faces.size()) {
    constexpr double joining_slacks = 4;  // two corners, each rounded in two files or steps
    const std::vector<Edge> edges = sorted_edges(faces, joining_slacks * slack);
    DisjointSets sets(faces.size());
    std::vector<std::uint32_t> open;  // faces at edges that are not closed
    for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
        int balance = 0;
        for (last = first; last < edges.size() && edges[last].joins(edges[first]); ++last) {
            balance += edges[last].is_forward ? 1 : -1;
            sets.unite(edges[last].face, edges[first].face);
        }
        if (balance != 0) open.push_back(edges[first].face);
    }
    for (std::uint32_t k = 0; k < faces.size(); ++k) {
        const std::uint32_t root = sets.root(k);  // the smallest member is the root and comes first
        if (root == k) group_[k] = static_cast<std::uint32_t>(all_.size()), all_.emplace_back();
        FaceGroup& group = all_[group_[k] = group_[root]];
        group.box.add(faces[k].box);
        group.faces.push_back(k);
        group.is_flat &= std::abs(dot(faces[k].plane.n, faces[root].plane.n)) >= parallel_cosine;
    }
    for (const std::uint32_t k : open) all_[group_[k]].is_closed = false;
    std::vector<Box> boxes;
    boxes.reserve(all_.size());
    for (const FaceGroup& group : all_) boxes.push_back(group.box);
    tree_ = Bvh(boxes);
}

bool FaceGroups::is_hollow(const ConvexBlocker& solid) const {
    const Box box = box_of(solid.points);
    const auto is_inside = [&](std::uint32_t face) {
        for (const Plane& side : solid.faces)
            for (const Point& p : faces_[face].outline)
                if (side.signed_distance(p) > -slack_) return false;
        return true;
    };
    return tree_.visit_box(box, [&](std::uint32_t k) {
        const FaceGroup& group = all_[k];
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (group.box.lo[axis] < box.lo[axis] || group.box.hi[axis] > box.hi[axis]) return false;
        return std::all_of(group.faces.begin(), group.faces.end(), is_inside);
    });
}

}  // namespace exitance
