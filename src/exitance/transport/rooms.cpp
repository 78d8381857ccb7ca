#include "exitance/transport/rooms.hpp"

#include <algorithm>
#include <numeric>

#include "exitance/core/parallel.hpp"
#include "exitance/core/random.hpp"
#include "exitance/transport/element_rays.hpp"

namespace exitance {
namespace {

/// Sets that grow together; each is known by its least member.
class Sets {
  public:
    explicit Sets(std::size_t n) : least_(n) { std::iota(least_.begin(), least_.end(), 0u); }
    std::uint32_t find(std::uint32_t i) {
        while (least_[i] != i) i = least_[i] = least_[least_[i]];
        return i;
    }
    void join(std::uint32_t i, std::uint32_t j) {
        i = find(i), j = find(j);
        least_[std::max(i, j)] = std::min(i, j);
    }

  private:
    std::vector<std::uint32_t> least_;
};

}  // namespace

Rooms find_rooms(const Stage& stage, const ElementTree& tree, std::uint64_t seed) {
    constexpr std::size_t rays_each = 8, most_rooms = 64;
    const std::vector<ElementId>& roots = tree.roots();
    Field<ElementId, std::uint32_t> root(tree.size());
    for (std::size_t i = 0; i < roots.size(); ++i) root[roots[i]] = static_cast<std::uint32_t>(i);
    for (ElementId e : tree.ids())
        if (!tree.parent(e).is_none()) root[e] = root[tree.parent(e)];

    const ElementLocator locator(tree, stage.scene.regions().size());
    const std::vector<ElementId> leaves = tree.leaves();
    std::vector<std::uint32_t> hits(rays_each * leaves.size(), ElementLocator::no_leaf);
    parallel_ranges(leaves.size(), 64, [&](std::size_t begin, std::size_t end) {
        ElementRays rays(stage, tree, locator);
        for (std::size_t i = begin; i < end; ++i)
            rays.cast(leaves[i], hash(seed, static_cast<std::uint64_t>(Stream::visibility), i),
                      std::span(hits).subspan(rays_each * i, rays_each));
    });
    Sets rooms(roots.size());
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (hits[i] < leaves.size()) rooms.join(root[leaves[i / rays_each]], root[leaves[hits[i]]]);

    std::vector<double> area(roots.size());
    for (std::size_t i = 0; i < roots.size(); ++i)
        area[rooms.find(static_cast<std::uint32_t>(i))] += tree.area(roots[i]);
    std::vector<std::uint32_t> by_area(roots.size()), number(roots.size());
    Rooms out{std::vector<std::uint32_t>(roots.size()), hits.size()};
    std::iota(by_area.begin(), by_area.end(), 0u);
    std::stable_sort(by_area.begin(), by_area.end(), [&](auto a, auto b) { return area[a] > area[b]; });
    for (std::size_t i = 0; i < by_area.size(); ++i)
        number[by_area[i]] = static_cast<std::uint32_t>(std::min(i, most_rooms - 1));
    for (std::size_t i = 0; i < roots.size(); ++i) out.of_root[i] = number[rooms.find(static_cast<std::uint32_t>(i))];
    return out;
}

}  // namespace exitance
