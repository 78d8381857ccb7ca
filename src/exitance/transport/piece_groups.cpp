#include "exitance/transport/piece_groups.hpp"

#include <algorithm>
#include <numeric>

#include "exitance/base/disjoint_sets.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/transport/element_rays.hpp"

namespace exitance {
PieceGroups find_piece_groups(const Stage& stage, const ElementTree& tree, std::uint64_t seed) {
    constexpr std::size_t rays_each = 8, max_groups = 64;
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
    DisjointSets groups(roots.size());
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (hits[i] < leaves.size()) groups.unite(root[leaves[i / rays_each]], root[leaves[hits[i]]]);

    std::vector<double> area(roots.size());
    for (std::size_t i = 0; i < roots.size(); ++i)
        area[groups.root(static_cast<std::uint32_t>(i))] += tree.area(roots[i]);
    std::vector<std::uint32_t> by_area(roots.size()), number(roots.size());
    PieceGroups out{std::vector<std::uint32_t>(roots.size()), hits.size()};
    std::iota(by_area.begin(), by_area.end(), 0u);
    std::stable_sort(by_area.begin(), by_area.end(), [&](auto a, auto b) { return area[a] > area[b]; });
    for (std::size_t i = 0; i < by_area.size(); ++i)
        number[by_area[i]] = static_cast<std::uint32_t>(std::min(i, max_groups - 1));
    for (std::size_t i = 0; i < roots.size(); ++i) out.of_root[i] = number[groups.root(static_cast<std::uint32_t>(i))];
    return out;
}

}  // namespace exitance
