#include "exitance/links/ray_links.hpp"

#include <algorithm>

#include "exitance/core/parallel.hpp"
#include "exitance/core/trace.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {
namespace {

/// The leaves in an order in which those of every element stand side by side.
struct LeafOrder {
    Field<ElementId, std::uint32_t> first, count;  ///< Those of an element are [first, first + count).
    std::vector<std::uint32_t> place;              ///< By leaf number.

    LeafOrder(const ElementTree& tree, const LeafNumbering& numbering)
        : first(tree.size(), 0), count(tree.size(), 0), place(numbering.leaves.size()) {
        for (std::size_t e = tree.size(); e-- > 0;) {
            if (tree.is_leaf(ElementId(e))) count[ElementId(e)] = 1;
            for (ElementId child : tree.children(ElementId(e))) count[ElementId(e)] += count[child];
        }
        std::uint32_t at = 0;
        for (ElementId root : tree.roots()) first[root] = at, at += count[root];
        for (ElementId e : tree.ids()) {
            std::uint32_t next = first[e];
            for (ElementId child : tree.children(e)) first[child] = next, next += count[child];
            if (tree.is_leaf(e)) place[numbering.number[e]] = first[e];
        }
    }
};

/// Makes the links of one leaf after another.
class RowLinker {
  public:
    RowLinker(const LinkSites& sites, const LeafOrder& order, const Field<ElementId, double>& roughness)
        : tree_(sites.tree()), sites_(sites), order_(order), roughness_(roughness) {
        for (ElementId root : tree_.roots()) roots_.push_back(order.first[root]);
    }

    /// `counts`: as how many rays each of those counts that `hits` are of; empty: all alike.
    void link(ElementId receiver, std::span<const std::uint32_t> hits, std::span<const float> counts, double allowed,
              std::vector<Link>& out) {
        places_.clear();
        for (std::size_t k = 0; k < hits.size(); ++k)
            if (hits[k] != RayRows::missed) places_.push_back({order_.place[hits[k]], counts.empty() ? 1 : counts[k]});
        std::stable_sort(places_.begin(), places_.end(), [](const Met& a, const Met& b) { return a.leaf < b.leaf; });
        const double rho = mean(light_weight(sites_.stage().scene.material(tree_.region(receiver)))) /
                           static_cast<double>(hits.size());
        const double strength = rho * std::sqrt(tree_.area(receiver));
        for (std::size_t begin = 0; begin < places_.size();) {
            const auto root = std::upper_bound(roots_.begin(), roots_.end(), places_[begin].leaf) - roots_.begin() - 1;
            const ElementId source = tree_.roots()[static_cast<std::size_t>(root)];
            begin += link_to(source, std::span(places_).subspan(begin), receiver, allowed / strength,
                             1 / static_cast<float>(hits.size()), out);
        }
    }

  private:
    /// What a ray met: where its leaf stands in the order, and as how many rays it counts.
    struct Met {
        std::uint32_t leaf;
        float counts;
    };

    /// `places`: sorted, those of the source first. Returns how many those are.
    std::size_t link_to(ElementId source, std::span<const Met> places, ElementId receiver, double allowed, float share,
                        std::vector<Link>& out) {
        const std::uint32_t end = order_.first[source] + order_.count[source];
        const auto last = std::lower_bound(places.begin(), places.end(), end,
                                           [](const Met& met, std::uint32_t leaf) { return met.leaf < leaf; });
        const auto count = static_cast<std::size_t>(last - places.begin());
        float rays = 0;
        for (const Met& met : places.first(count)) rays += met.counts;
        if (!(rays > 0)) return count;
        if (tree_.is_leaf(source) || static_cast<double>(rays) * roughness_[source] <= allowed) {
            Link& link = out.emplace_back();
            link.receiver = receiver, link.source = source;
            link.factor = rays * share;
            return count;
        }
        std::size_t begin = 0;
        for (ElementId child : tree_.children(source))
            begin += link_to(child, places.subspan(begin, count - begin), receiver, allowed, share, out);
        return count;
    }

    const ElementTree& tree_;
    const LinkSites& sites_;
    const LeafOrder& order_;
    const Field<ElementId, double>& roughness_;
    std::vector<std::uint32_t> roots_;  ///< Where the leaves of each begin.
    std::vector<Met> places_;           ///< What the rays of a leaf met.
};

}  // namespace

Links link_by_rays(const LinkSites& sites, const LeafNumbering& numbering, const RayRows& rows, const NodalField& b,
                   double allowed) {
    constexpr std::size_t block_size = 64;
    const ElementTree& tree = sites.tree();
    const LeafOrder order(tree, numbering);
    const Field<ElementId, double> roughness = b.roughness();
    std::vector<std::vector<Link>> found((numbering.leaves.size() + block_size - 1) / block_size);
    parallel_for(
        found.size(), 1,
        [&](std::size_t block) {
            RowLinker linker(sites, order, roughness);
            const std::size_t end = std::min(numbering.leaves.size(), (block + 1) * block_size);
            for (std::size_t i = block * block_size; i < end; ++i)
                linker.link(numbering.leaves[i], rows.hits(i), rows.counts(i), allowed, found[block]);
            note_touched("links", found[block].size());
        },
        {"link rows", [&](std::size_t block) { return tree.region(numbering.leaves[block * block_size]).value; }});
    std::size_t count = 0;
    for (const auto& block : found) count += block.size();
    std::vector<Link> links;
    links.reserve(count);
    for (auto& block : found) {
        links.insert(links.end(), block.begin(), block.end());
        block = {};
    }
    return Links(sites, std::move(links), {});
}

}  // namespace exitance
