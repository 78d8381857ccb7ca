#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "exitance/base/polygon.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// A convex region, given as the intersection of half-spaces signed_distance >= 0, stored for testing a box against
/// four planes at a time. Planes beyond `capacity` are ignored, which can only enlarge the region.
class ConvexRegion {
  public:
    static constexpr std::size_t capacity = 16;

    void clear() { count_ = 0; }
    void add(const Plane& plane) {
        if (count_ == capacity) return;
        if (count_ % 4 == 0)  // the unused lanes of the block accept all of space
            for (std::size_t i = count_; i < count_ + 4; ++i) nx_[i] = ny_[i] = nz_[i] = 0, offset_[i] = 0;
        nx_[count_] = plane.n.x, ny_[count_] = plane.n.y, nz_[count_] = plane.n.z, offset_[count_] = plane.offset;
        ++count_;
    }
    std::size_t size() const { return count_; }

    /// True if the box lies wholly outside one of the planes. If false, the box may still miss the region.
    bool excludes(const Box& box) const {
        for (std::size_t block = 0; block < count_; block += 4) {
            bool out = false;
            for (std::size_t i = block; i < block + 4; ++i) {
                const double highest = std::max(nx_[i] * box.lo.x, nx_[i] * box.hi.x) +
                                       std::max(ny_[i] * box.lo.y, ny_[i] * box.hi.y) +
                                       std::max(nz_[i] * box.lo.z, nz_[i] * box.hi.z);
                out |= highest < offset_[i];
            }
            if (out) return true;
        }
        return false;
    }

  private:
    alignas(32) std::array<double, capacity> nx_, ny_, nz_, offset_;
    std::size_t count_ = 0;
};

/// Bounding volume hierarchy over items that have boxes, in double precision, built by the surface area heuristic with
/// 16 bins [Wald07]. Deterministic: the same boxes give the same tree and the same order of visits. O(n log n) to
/// build.
class Bvh {
  public:
    Bvh() = default;
    explicit Bvh(std::span<const Box> boxes);

    std::size_t size() const { return items_.size(); }
    std::size_t memory_bytes() const;
    /// Calls visit(span) for each array of the tree (see `share_on_node`).
    template <class Visit>
    void visit_arrays(const Visit& visit) const {
        visit(std::span(nodes_)), visit(std::span(items_));
    }

    /// Calls visit(item) for every item whose box is not wholly outside one plane of the region. If visit returns a
    /// bool, true ends the traversal. Returns true if the traversal was ended. Subtrees farther back along `direction`
    /// are visited first (zero vector: in the order of the tree).
    template <class Visit>
    bool visit_region(const ConvexRegion& region, const Visit& visit, const Vec3& direction = {}) const {
        return walk([&](const Box& box) { return !region.excludes(box); }, visit, direction);
    }

    /// Calls visit(item) for every item whose box intersects the given one; true ends the traversal here, too.
    template <class Visit>
    bool visit_box(const Box& query, const Visit& visit) const {
        return walk(
            [&](const Box& b) {
                return b.lo.x <= query.hi.x && query.lo.x <= b.hi.x && b.lo.y <= query.hi.y && query.lo.y <= b.hi.y &&
                       b.lo.z <= query.hi.z && query.lo.z <= b.hi.z;
            },
            visit);
    }

    /// Calls visit(item) for items whose box intersects the segment from `origin` to origin + length * direction,
    /// nearer boxes first. `visit` returns the length up to which items must still be visited (0 ends the traversal).
    /// Boxes are enlarged by the rounding error, so that no touching box is missed.
    template <class Visit>
    void visit_segment(const Point& origin, const Vec3& direction, double length, const Visit& visit) const;

  private:
    struct Node {
        Box box;
        /// Inner node: its second child; the first child is the next node. Leaf: its first item.
        std::uint32_t second = 0;
        std::uint32_t count = 0;  ///< Number of items of a leaf, 0 for inner nodes.
    };
    struct Item {
        Box box;
        std::uint32_t id;
    };
    static constexpr std::size_t largest_leaf = 3, deepest = 96;

    template <class Meets, class Visit>
    bool walk(const Meets& meets, const Visit& visit, const Vec3& direction = {}) const {
        if (nodes_.empty()) return false;
        std::array<std::uint32_t, deepest> stack;
        std::size_t top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const std::uint32_t at = stack[--top];
            const Node& node = nodes_[at];
            if (!meets(node.box)) continue;
            if (node.count == 0) {
                const Box &first = nodes_[at + 1].box, &second = nodes_[node.second].box;
                const bool turned = dot(direction, second.lo - first.lo) + dot(direction, second.hi - first.hi) < 0;
                stack[top++] = turned ? at + 1 : node.second;
                stack[top++] = turned ? node.second : at + 1;
                continue;
            }
            for (std::uint32_t i = node.second; i < node.second + node.count; ++i)
                if (node.count == 1 || meets(items_[i].box)) {
                    if constexpr (std::is_same_v<decltype(visit(items_[i].id)), bool>) {
                        if (visit(items_[i].id)) return true;
                    } else {
                        visit(items_[i].id);
                    }
                }
        }
        return false;
    }

    std::vector<Node> nodes_;  ///< Depth-first: the first child of a node is the next node.
    std::vector<Item> items_;  ///< Sorted by leaf.

    friend class BvhBuilder;
};

template <class Visit>
void Bvh::visit_segment(const Point& origin, const Vec3& direction, double length, const Visit& visit) const {
    if (nodes_.empty()) return;
    // Infinite if the segment is parallel to a plane of the box.
    const Vec3 inverse{1 / direction.x, 1 / direction.y, 1 / direction.z};
    const auto entry = [&](const Box& box) {  // distance to the box, infinite if it is missed
        double near = 0, far = length;
        for (std::size_t k = 0; k < 3; ++k) {
            const double lo = box.lo[k] - origin[k], hi = box.hi[k] - origin[k];
            if (direction[k] == 0) {
                if (lo > 0 || hi < 0) return HUGE_VAL;
                continue;
            }
            const double a = lo * inverse[k], b = hi * inverse[k];
            near = std::max(near, std::min(a, b) - 1e-15 * std::abs(a));
            far = std::min(far, std::max(a, b) + 1e-15 * std::abs(b) + 1e-15 * std::abs(a));
        }
        return near <= far ? near : HUGE_VAL;
    };
    std::array<std::pair<std::uint32_t, double>, deepest> stack;
    std::size_t top = 0;
    stack[top++] = {0, entry(nodes_[0].box)};
    while (top > 0) {
        const auto [at, distance] = stack[--top];
        if (distance == HUGE_VAL || distance > length) continue;
        const Node& node = nodes_[at];
        if (node.count == 0) {
            std::pair<std::uint32_t, double> first{at + 1, entry(nodes_[at + 1].box)};
            std::pair<std::uint32_t, double> second{node.second, entry(nodes_[node.second].box)};
            if (second.second < first.second) std::swap(first, second);
            stack[top++] = second;
            stack[top++] = first;
            continue;
        }
        for (std::uint32_t i = node.second; i < node.second + node.count; ++i) {
            if (node.count > 1 && entry(items_[i].box) == HUGE_VAL) continue;
            length = std::min(length, static_cast<double>(visit(items_[i].id)));
            if (length <= 0) return;
        }
    }
}

}  // namespace exitance
