#include "exitance/methods/light/light_below.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"

namespace exitance {

LightBelow::Pulled LightBelow::pull(ElementId e, std::vector<Known>* large) const {
    constexpr std::size_t min_cached_leaves = 64;  // leaves
    const ElementTree& tree = sites_.tree();
    if (tree.is_leaf(e)) return {{of_leaf_(e)}};
    const auto known = std::lower_bound(known_.begin(), known_.end(), e,
                                        [](const Known& k, ElementId element) { return k.first < element; });
    if (known != known_.end() && known->first == e) return {known->second, min_cached_leaves};
    Pulled out{{}, 0};
    std::vector<FromBelow> parts;
    for (ElementId child : tree.children(e)) {
        const Pulled part = pull(child, large);
        parts.push_back(part.found);
        out.leaves += part.leaves;
    }
    out.found = pull_from_parts(sites_, e, parts);
    if (large && out.leaves >= min_cached_leaves) large->push_back({e, out.found});
    return out;
}

std::vector<FromBelow> LightBelow::look_at(std::span<const ElementId> elements) {
    std::vector<FromBelow> out(elements.size());
    std::vector<std::vector<Known>> large(elements.size());
    parallel_for(elements.size(), 1, [&](std::size_t i) { out[i] = pull(elements[i], &large[i]).found; });
    for (const std::vector<Known>& below : large) known_.insert(known_.end(), below.begin(), below.end());
    std::sort(known_.begin(), known_.end(), [](const Known& a, const Known& b) { return a.first < b.first; });
    return out;
}

}  // namespace exitance
