#include "exitance/links/ray_links.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/base/trace.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {
namespace {

/// An order of the leaves in which those below every element are contiguous.
struct LeafOrder {
    Field<ElementId, std::uint32_t> first, count;  ///< The leaves below an element are [first, first + count).
    std::vector<std::uint32_t> place;              ///< Per leaf number: position of the leaf in the order.
    std::vector<std::uint32_t> roots;              ///< Per root: position of its first leaf.

    LeafOrder(const ElementTree& tree, const LeafNumbering& numbering)
        : first(tree.size(), 0), count(tree.size(), 0), place(numbering.leaves.size()) {
        for (std::size_t e = tree.size(); e-- > 0;) {
            if (tree.is_leaf(ElementId(e))) count[ElementId(e)] = 1;
            for (ElementId child : tree.children(ElementId(e))) count[ElementId(e)] += count[child];
        }
        std::uint32_t at = 0;
        for (ElementId root : tree.roots()) roots.push_back(first[root] = at), at += count[root];
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
        : tree_(sites.tree()), sites_(sites), order_(order), roughness_(roughness) {}

    /// Appends the links of a receiver to `out`. `counts`: weight of each ray in `hits`; empty: 1.
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
            const auto& roots = order_.roots;
            const auto root = std::upper_bound(roots.begin(), roots.end(), places_[begin].leaf) - roots.begin() - 1;
            const ElementId source = tree_.roots()[static_cast<std::size_t>(root)];
            begin += link_to(source, std::span(places_).subspan(begin), receiver, allowed / strength,
                             1 / static_cast<float>(hits.size()), out);
        }
    }

  private:
    /// A ray hit: the position of its leaf in the order, and the weight of the ray.
    struct Met {
        std::uint32_t leaf;
        float counts;
    };

    /// Links a receiver to a source, or to its parts. `places`: sorted hits, those of the source first. Returns the
    /// number of hits of the source.
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
    std::vector<Met> places_;  ///< The hits of one leaf's rays.
};

}  // namespace

Links link_by_rays(const LinkSites& sites, const LeafNumbering& numbering, const RayRows& rows, const NodalField& b,
                   double allowed) {
    const std::size_t block = rows.dealt().block();
    const ElementTree& tree = sites.tree();
    const LeafOrder order(tree, numbering);
    const Field<ElementId, double> roughness = b.roughness();
    std::vector<std::vector<Link>> found((numbering.leaves.size() + block - 1) / block);
    parallel_own_ranges(numbering.leaves.size(), block,
                        [&](std::size_t begin, std::size_t end) {
                            RowLinker linker(sites, order, roughness);
                            std::vector<std::uint32_t> met;
                            for (std::size_t i = begin; i < end; ++i) {
                                rows.leaves_met(i, met);
                                linker.link(numbering.leaves[i], met, rows.counts(i), allowed, found[i / block]);
                            }
                            note_touched("links", found[begin / block].size());
                        },
                        {"link rows", [&](std::size_t i) { return tree.region(numbering.leaves[i]).value; }});
    std::size_t count = 0;
    for (const auto& some : found) count += some.size();
    std::vector<Link> links;
    links.reserve(count);
    for (auto& some : found) {
        links.insert(links.end(), some.begin(), some.end());
        some = {};
    }
    return Links(sites, std::move(links), {});
}

std::vector<KeptLink> list_of_all(const Links& own, const LeafNumbering& numbering) {
    if (processes() == 1) return own.list();
    const std::vector<KeptLink> here = own.list();
    const std::size_t leaves = numbering.leaves.size(), block = dealt_block(leaves);
    std::vector<std::uint64_t> count(leaves, 0);
    for (const KeptLink& link : here) ++count[numbering.number[link.receiver]];
    exchange_values(
        leaves, block, [&](std::size_t i) -> std::uint64_t& { return count[i]; }, "kept links");
    std::vector<std::size_t> first(leaves + 1, 0);
    for (std::size_t i = 0; i < leaves; ++i) first[i + 1] = first[i] + count[i];
    std::vector<KeptLink> all(first.back());
    // Leaves are numbered in the order of their ids, in which links are listed, too.
    for (std::size_t i = 0, at = 0; i < leaves; ++i)
        if (is_own(i, block))
            for (std::size_t k = 0; k < count[i]; ++k) all[first[i] + k] = here[at++];
    exchange_values(
        leaves, block, [&](std::size_t i) { return std::span(all).subspan(first[i], count[i]); }, "kept links");
    return all;
}

}  // namespace exitance
