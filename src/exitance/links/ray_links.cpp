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

    void link(ElementId receiver, std::span<const std::uint32_t> hits, double allowed, std::vector<Link>& out) {
        places_.clear();
        for (std::uint32_t leaf : hits)
            if (leaf != RayRows::missed) places_.push_back(order_.place[leaf]);
        std::sort(places_.begin(), places_.end());
        const double rho = mean(light_weight(sites_.stage().scene.material(tree_.region(receiver)))) /
                           static_cast<double>(hits.size());
        const double strength = rho * std::sqrt(tree_.area(receiver));
        for (std::size_t begin = 0; begin < places_.size();) {
            const auto root = std::upper_bound(roots_.begin(), roots_.end(), places_[begin]) - roots_.begin() - 1;
            const ElementId source = tree_.roots()[static_cast<std::size_t>(root)];
            begin += link_to(source, std::span(places_).subspan(begin), receiver, allowed / strength,
                             1 / static_cast<float>(hits.size()), out);
        }
    }

  private:
    /// `places`: sorted, those of the source first. Returns how many those are.
    std::size_t link_to(ElementId source, std::span<const std::uint32_t> places, ElementId receiver, double allowed,
                        float share, std::vector<Link>& out) {
        const std::uint32_t end = order_.first[source] + order_.count[source];
        const auto count =
            static_cast<std::size_t>(std::lower_bound(places.begin(), places.end(), end) - places.begin());
        if (count == 0) return 0;
        if (tree_.is_leaf(source) || static_cast<double>(count) * roughness_[source] <= allowed) {
            Link& link = out.emplace_back();
            link.receiver = receiver, link.source = source;
            link.factor = static_cast<float>(count) * share;
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
    std::vector<std::uint32_t> roots_;   ///< Where the leaves of each begin.
    std::vector<std::uint32_t> places_;  ///< Of the leaves that were hit.
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
                linker.link(numbering.leaves[i], rows.hits(i), allowed, found[block]);
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
