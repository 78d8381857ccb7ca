#include "exitance/base/bvh.hpp"

namespace exitance {

/// Builds the tree in storage order: a node, the subtree of its first child, the subtree of its second child.
class BvhBuilder {
  public:
    explicit BvhBuilder(Bvh& bvh) : bvh_(bvh) {}

    void build() {
        struct Task {
            std::uint32_t first, last, depth, parent;  // parent: the node whose second child this becomes
        };
        constexpr std::uint32_t nobody = 0xffffffffu;
        std::vector<Task> tasks;
        tasks.push_back({0, static_cast<std::uint32_t>(bvh_.items_.size()), 0, nobody});
        bvh_.nodes_.reserve(bvh_.items_.size());
        while (!tasks.empty()) {
            const Task task = tasks.back();
            tasks.pop_back();
            const std::uint32_t at = static_cast<std::uint32_t>(bvh_.nodes_.size());
            if (task.parent != nobody) bvh_.nodes_[task.parent].second = at;
            bvh_.nodes_.emplace_back();
            const std::uint32_t middle = split(task.first, task.last, task.depth, bvh_.nodes_.back().box);
            if (middle == task.first) {
                bvh_.nodes_.back().second = task.first;
                bvh_.nodes_.back().count = task.last - task.first;
                continue;
            }
            tasks.push_back({middle, task.last, task.depth + 1, at});
            tasks.push_back({task.first, middle, task.depth + 1, nobody});
        }
        bvh_.nodes_.shrink_to_fit();
    }

  private:
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
