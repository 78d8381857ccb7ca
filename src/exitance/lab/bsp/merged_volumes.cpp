#include "exitance/lab/bsp/merged_volumes.hpp"

#include <algorithm>

#include "exitance/lab/bsp/plane_sides.hpp"

namespace exitance {
namespace {

/// A square of half width `reach` in a plane around the foot of a point, counter-clockwise about the normal.
std::vector<Point> square_in(const Plane& plane, const Point& near, double reach) {
    const Frame frame(plane.n);
    const Point foot = near - plane.signed_distance(near) * plane.n;
    return {foot + frame.to_world(-reach, -reach, 0), foot + frame.to_world(reach, -reach, 0),
            foot + frame.to_world(reach, reach, 0), foot + frame.to_world(-reach, reach, 0)};
}

}  // namespace

MergedVolumes::MergedVolumes(const Box& space, double thickness, std::size_t most)
    : thickness_(thickness), reach_(2 * space.diagonal() + 4 * thickness), max_(most), nodes_(1) {
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    // ensures that a flat box has a volume
    const Vec3 margin = Vec3{1, 1, 1} * (0.01 * space.diagonal() + 2 * thickness);
    const Point lo = space.lo - margin, hi = space.hi + margin;
    std::vector<Point> rest;
    for (const Vec3& axis : axes) {
        space_.push_back({{axis, dot(axis, lo)}, false, {}});
        space_.push_back({{-axis, -dot(axis, hi)}, false, {}});
    }
    for (Face& face : space_) {
        face.corners = square_in(face.plane, space.centre(), reach_);
        for (const Face& other : space_) {
            if (&other == &face) continue;
            clip(face.corners, other.plane, rest);
            face.corners.swap(rest);
        }
    }
}

/// The part of a body in front of a plane, closed by a face in it.
MergedVolumes::Body MergedVolumes::cut(const Body& body, const Plane& plane, bool is_own) const {
    Body out;
    Point inside;
    double count = 0;
    for (const Face& face : body) {
        Face part{face.plane, face.is_own, {}};
        clip(face.corners, plane, part.corners);
        // A face that only touches the plane from behind is dropped.
        if (part.corners.size() < 3 || (sides(part.corners, plane, thickness_) & 1) == 0) continue;
        for (const Point& p : part.corners) inside += p, ++count;
        out.push_back(std::move(part));
    }
    if (out.empty()) return out;
    Face cap{plane, is_own, square_in(plane, inside / count, reach_)};
    std::vector<Point> rest;
    for (const Face& face : body) {
        clip(cap.corners, face.plane, rest);
        cap.corners.swap(rest);
        if (cap.corners.size() < 3) break;
    }
    if (cap.corners.size() >= 3) out.push_back(std::move(cap));
    return out;
}

/// Adds a label to the part of space that is in front of all planes.
void MergedVolumes::merge(std::span<const Plane> planes, std::uint32_t volume, bool is_umbra) {
    Body body = space_;
    for (const Plane& plane : planes) {
        int side = 0;
        for (const Face& face : body) side |= sides(face.corners, plane, thickness_);
        if ((side & 1) == 0) return;  // entirely outside of `space_`
        if (side == 3) body = cut(body, plane, true);
    }
    merge_below(0, std::move(body), volume, is_umbra);
}

void MergedVolumes::merge_below(std::uint32_t n, Body body, std::uint32_t volume, bool is_umbra) {
    if (nodes_[n].front == none) return grow_leaf(n, body, volume, is_umbra);
    const Plane plane = nodes_[n].plane;
    int side = 0;
    for (Face& face : body) {
        const int of_face = sides(face.corners, plane, thickness_);
        if (of_face == 0) face.is_own = false;  // the tree already has a cut there
        side |= of_face;
    }
    const std::uint32_t front = nodes_[n].front, back = nodes_[n].back;
    if (side == 1) merge_below(front, std::move(body), volume, is_umbra);
    if (side == 2) merge_below(back, std::move(body), volume, is_umbra);
    if (side != 3) return;
    merge_below(front, cut(body, plane, false), volume, is_umbra);
    merge_below(back, cut(body, turned(plane), false), volume, is_umbra);
}

/// Splits a leaf by those of the volume's planes that bound it there. Parts outside keep their labels; the inside gets
/// one more.
void MergedVolumes::grow_leaf(std::uint32_t leaf, const Body& body, std::uint32_t volume, bool is_umbra) {
    const std::uint32_t labels = nodes_[leaf].labels;
    for (const Face& face : body) {
        if (!face.is_own) continue;
        const auto next = static_cast<std::uint32_t>(nodes_.size());
        nodes_[leaf].plane = face.plane, nodes_[leaf].front = next, nodes_[leaf].back = next + 1;
        nodes_.resize(nodes_.size() + 2);
        nodes_[next + 1].labels = labels;
        leaf = next;
    }
    nodes_[leaf].labels = static_cast<std::uint32_t>(labels_.size());
    labels_.push_back({volume, is_umbra, labels});
}

void MergedVolumes::add(const ShadowVolume& volume) {
    const std::uint32_t number = count_++;
    if (volume.is_empty()) return;
    if (nodes_.size() >= max_) {
        rest_.push_back({number, volume});
        return;
    }
    merge(volume.penumbra(), number, false);
    if (volume.has_umbra()) merge(volume.umbra(), number, true);
}

void MergedVolumes::read_leaf(const Node& leaf, Classes& out) const {
    bool is_hidden = false;
    for (std::uint32_t i = leaf.labels; i != none; i = labels_[i].before) {
        is_hidden |= labels_[i].is_umbra;
        if (!labels_[i].is_umbra) out.reached.push_back(labels_[i].volume);
    }
    out.is_hidden &= is_hidden;
}

void MergedVolumes::look_below(std::uint32_t n, std::span<const Point> polygon, Classes& out,
                               std::size_t& tests) const {
    for (; nodes_[n].front != none;) {
        ++tests;
        const Node& node = nodes_[n];
        const int side = sides(polygon, node.plane, thickness_);
        if (side == 3) {
            std::vector<Point> part;
            clip(polygon, node.plane, part);
            if (part.size() >= 3) look_below(node.front, part, out, tests);
            clip(polygon, turned(node.plane), part);
            if (part.size() >= 3) look_below(node.back, part, out, tests);
            return;
        }
        n = side == 1 ? node.front : node.back;
    }
    read_leaf(nodes_[n], out);
}

void MergedVolumes::classify(std::span<const Point> polygon, Classes& out, std::size_t& tests) const {
    out.reached.clear(), out.is_hidden = true;
    look_below(0, polygon, out, tests);
    for (const Unmerged& one : rest_) {
        if (one.volume.in_penumbra(polygon, tests) == ShadowVolume::Place::outside) continue;
        out.reached.push_back(one.number);
        out.is_hidden |= !out.is_hidden && one.volume.has_umbra() &&
                         one.volume.in_umbra(polygon, tests) == ShadowVolume::Place::inside;
    }
    std::sort(out.reached.begin(), out.reached.end());
    out.reached.erase(std::unique(out.reached.begin(), out.reached.end()), out.reached.end());
}

}  // namespace exitance
