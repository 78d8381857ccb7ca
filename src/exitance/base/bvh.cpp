#include "exitance/base/bvh.hpp"

#include "exitance/base/parallel.hpp"

namespace exitance {

/// Builds the tree in storage order: a node, the subtree of its first child, the subtree of its second child. Large
/// ranges of items are split level by level, and the subtrees of small ones are built at a time, all on every thread.
class BvhBuilder {
  public:
    explicit BvhBuilder(Bvh& bvh) : bvh_(bvh) {}

    void build() {
        std::vector<Top> tops = {{.first = 0, .last = static_cast<std::uint32_t>(bvh_.items_.size()), .depth = 0}};
        for (std::size_t level = 0, end = 1; level < end; level = end, end = tops.size()) {
            parallel_for(end - level, 1, [&](std::size_t i) { open(tops[level + i]); });
            for (std::size_t i = level; i < end; ++i) {
                const Top top = tops[i];
                if (top.middle == top.first) continue;
                tops[i].children = static_cast<std::uint32_t>(tops.size());
                tops.push_back({.first = top.first, .last = top.middle, .depth = top.depth + 1});
                tops.push_back({.first = top.middle, .last = top.last, .depth = top.depth + 1});
            }
        }
        store(tops);
    }

  private:
    /// A node whose children are stored in the list, or the root of a subtree with all of its nodes.
    struct Top {
        std::uint32_t first, last, depth;        ///< Range [first, last) of the items, and depth of the node.
        std::uint32_t middle = 0, children = 0;  ///< First item of the second child, and the position of both children.
        Box box = {};
        std::vector<Bvh::Node> nodes = {};  ///< All nodes of a subtree, with positions relative to its root.
    };

    void open(Top& top) {
        constexpr std::uint32_t largest_subtree = 4096;
        if (top.last - top.first > largest_subtree) {
            top.middle = split(top.first, top.last, top.depth, top.box);
        } else {
            top.middle = top.first;
            top.nodes = subtree(top.first, top.last, top.depth);
        }
    }

    std::vector<Bvh::Node> subtree(std::uint32_t first_item, std::uint32_t last_item, std::uint32_t top_depth) {
        struct Task {
            std::uint32_t first, last, depth, parent;  // parent: the node whose second child this becomes
        };
        constexpr std::uint32_t nobody = 0xffffffffu;
        std::vector<Bvh::Node> nodes;
        std::vector<Task> tasks = {{first_item, last_item, top_depth, nobody}};
        while (!tasks.empty()) {
            const Task task = tasks.back();
            tasks.pop_back();
            const std::uint32_t at = static_cast<std::uint32_t>(nodes.size());
            if (task.parent != nobody) nodes[task.parent].second = at;
            nodes.emplace_back();
            const std::uint32_t middle = split(task.first, task.last, task.depth, nodes.back().box);
            if (middle == task.first) {
                nodes.back().second = task.first;
                nodes.back().count = task.last - task.first;
                continue;
            }
            tasks.push_back({middle, task.last, task.depth + 1, at});
            tasks.push_back({task.first, middle, task.depth + 1, nobody});
        }
        return nodes;
    }

    /// Copies all nodes to the tree, depth first.
    void store(const std::vector<Top>& tops) {
        struct Task {
            std::uint32_t top, parent;
        };
        constexpr std::uint32_t nobody = 0xffffffffu;
        std::size_t count = 0;
        for (const Top& top : tops) count += std::max<std::size_t>(1, top.nodes.size());
        bvh_.nodes_.reserve(count);
        for (std::vector<Task> tasks = {{0, nobody}}; !tasks.empty();) {
            const Task task = tasks.back();
            tasks.pop_back();
            const Top& top = tops[task.top];
            const auto at = static_cast<std::uint32_t>(bvh_.nodes_.size());
            if (task.parent != nobody) bvh_.nodes_[task.parent].second = at;
            if (top.nodes.empty()) {
                bvh_.nodes_.push_back({.box = top.box});
                tasks.push_back({top.children + 1, at}), tasks.push_back({top.children, nobody});
                continue;
            }
            for (Bvh::Node node : top.nodes) {
                if (node.count == 0) node.second += at;
                bvh_.nodes_.push_back(node);
            }
        }
    }

    static constexpr std::size_t bins = 16;
    struct Bin {
        Box box;
        std::uint32_t count = 0;
    };

    /// Partitions the items [first, last) into two contiguous halves. Returns the start of the second half, or `first`
    /// for a leaf. Computes their box.
    std::uint32_t split(std::uint32_t first, std::uint32_t last, std::uint32_t depth, Box& box) {
        Box centres;
        for (std::uint32_t i = first; i < last; ++i) {
            box.add(bvh_.items_[i].box);
            centres.add(bvh_.items_[i].box.centre());
        }
        const std::uint32_t halfway = first + (last - first) / 2;
        if (last - first <= Bvh::largest_leaf) return first;
        const Vec3 size = centres.size();
        const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        // Coinciding centres or a deep tree: split in the middle to limit the depth.
        if (size[axis] <= 0 || depth > Bvh::deepest / 2) return halfway;
        const std::uint32_t middle = partition(first, last, axis, centres);
        return middle == first || middle == last ? halfway : middle;
    }

    std::uint32_t partition(std::uint32_t first, std::uint32_t last, std::size_t axis, const Box& centres) {
        const double lo = centres.lo[axis], scale = bins / (centres.hi[axis] - lo);
        const auto bin_of = [&](const Bvh::Item& item) {
            const double t = (item.box.centre()[axis] - lo) * scale;
            return std::min(bins - 1, static_cast<std::size_t>(std::max(t, 0.0)));
        };
        std::array<Bin, bins> content{};
        for (std::uint32_t i = first; i < last; ++i) {
            Bin& bin = content[bin_of(bvh_.items_[i])];
            bin.box.add(bvh_.items_[i].box);
            ++bin.count;
        }
        std::array<double, bins> above{};  // cost of all bins from this one on
        Box box;
        std::uint32_t count = 0;
        for (std::size_t b = bins - 1; b > 0; --b) {
            box.add(content[b].box), count += content[b].count;
            above[b] = count * box.half_area();
        }
        box = Box(), count = 0;
        double best = HUGE_VAL;
        std::size_t best_bin = 0;
        for (std::size_t b = 1; b < bins; ++b) {
            box.add(content[b - 1].box), count += content[b - 1].count;
            const double cost = count * box.half_area() + above[b];
            if (cost < best) best = cost, best_bin = b;
        }
        const auto middle = std::partition(bvh_.items_.begin() + first, bvh_.items_.begin() + last,
                                           [&](const Bvh::Item& item) { return bin_of(item) < best_bin; });
        return static_cast<std::uint32_t>(middle - bvh_.items_.begin());
    }

    Bvh& bvh_;
};

Bvh::Bvh(std::span<const Box> boxes) {
    if (boxes.empty()) return;
    items_.reserve(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) items_.push_back({boxes[i], static_cast<std::uint32_t>(i)});
    BvhBuilder(*this).build();
}

std::size_t Bvh::memory_bytes() const {
    return nodes_.capacity() * sizeof(Node) + items_.capacity() * sizeof(Item);
}

}  // namespace exitance
