#include "exitance/links/links.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "exitance/base/parallel.hpp"
#include "exitance/links/link_kernel.hpp"
#include "exitance/links/link_layout.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

/// Index in masks and blocks of the pair of node k of the receiver and node l of the source.
std::size_t position(std::size_t n, std::size_t k, std::size_t l) {
    return n == LinkLayout2::n ? LinkLayout2::position(k, l) : LinkLayout3::position(k, l);
}

/// Sorts links by receiver (counting sort), then by source within each receiver, in parallel. Returns the end of each
/// receiver's links.
std::vector<std::size_t> sort_by_receiver(std::vector<Link>& links, std::size_t elements) {
    std::vector<std::size_t> end(elements + 1, 0);
    for (const Link& link : links) ++end[link.receiver.value + 1];
    for (std::size_t e = 0; e < elements; ++e) end[e + 1] += end[e];
    const auto by_receiver = [](const Link& a, const Link& b) { return a.receiver < b.receiver; };
    if (std::is_sorted(links.begin(), links.end(), by_receiver)) {
        std::copy(end.begin() + 1, end.end(), end.begin());
    } else {
        std::vector<Link> sorted(links.size());
        for (const Link& link : links) sorted[end[link.receiver.value]++] = link;
        links = std::move(sorted);
    }
    end.pop_back();
    parallel_for(elements, 64, [&](std::size_t e) {
        const auto at = [&](std::size_t i) { return links.begin() + static_cast<std::ptrdiff_t>(i); };
        std::sort(at(e == 0 ? 0 : end[e - 1]), at(end[e]),
                  [](const Link& a, const Link& b) { return a.source < b.source; });
    });
    return end;
}

}  // namespace

Links::Rows::Rows(std::vector<Link>& links, std::size_t elements) {
    const std::vector<std::size_t> end = sort_by_receiver(links, elements);
    Field<ElementId, std::uint32_t> place(elements, 0);  // position among the elements that are sources
    for (const Link& link : links) place[link.source] = 1;
    for (ElementId e : place.ids()) {
        const std::size_t begin = e.value == 0 ? 0 : end[e.value - 1];
        if (begin < end[e.value]) receiver.push_back(e), first.push_back(begin);
        if (place[e] == 0) continue;
        place[e] = static_cast<std::uint32_t>(sources.size());
        sources.push_back(e);
    }
    first.push_back(links.size());
    source.resize(links.size());
    parallel_for(links.size(), 4096, [&](std::size_t i) { source[i] = place[links[i].source]; });
}

void Links::Rows::mark(Field<ElementId, std::uint8_t>& marked) const {
    for (ElementId e : receiver) marked[e] = 1;
    for (ElementId e : sources) marked[e] = 1;
}

Links::Kinds Links::by_kind(std::vector<Link> links, std::size_t nodes) {
    if (nodes == 1) return {std::move(links), {}};
    const auto kernels =
        std::stable_partition(links.begin(), links.end(), [](const Link& l) { return l.is_constant(); });
    Kinds out;
    out.kernels.assign(kernels, links.end());
    links.erase(kernels, links.end());
    out.constants = std::move(links);
    return out;
}

Links::Links(const LinkSites& sites, std::vector<Link> links, std::vector<float> blocks)
    : Links(sites, by_kind(std::move(links), sites.nodes()), std::move(blocks)) {}

Links::Links(const LinkSites& sites, Kinds links, std::vector<float> blocks)
    : sites_(&sites),
      constants_(links.constants, sites.tree().size()),
      kernels_(links.kernels, sites.tree().size()),
      factor_(links.constants.size()),
      block_(links.kernels.size()),
      blocks_(std::move(blocks)),
      words_((sites.nodes() * sites.nodes() + 31) / 32) {
    parallel_for(factor_.size(), 4096, [&](std::size_t i) { factor_[i] = links.constants[i].factor; });
    visible_.resize(words_ * block_.size(), 0);
    parallel_for(block_.size(), 4096, [&](std::size_t i) { lay_out(links.kernels[i], i); });
}

void Links::lay_out(const Link& link, std::size_t i) {
    const std::size_t n = sites_->nodes(), first = i * words_;
    std::array<float, 81> block;
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t l = 0; l < n; ++l) {
            const std::size_t to = position(n, k, l);
            if (link.sees(k * n + l)) visible_[first + to / 32] |= 1u << (to % 32);
            if (!Link::is_far(link.block)) block[to] = blocks_[link.block + k * n + l];
        }
    block_[i] = link.block;
    if (!Link::is_far(link.block)) std::copy_n(block.begin(), n * n, blocks_.begin() + link.block);
}

std::size_t Links::memory_bytes() const {
    return constants_.memory_bytes() + kernels_.memory_bytes() +
           4 * (factor_.size() + visible_.size() + block_.size() + blocks_.size());
}

template <std::size_t groups>
double Links::mean_form_factor(std::size_t row, std::size_t link) const {
    const ElementId p = kernels_.receiver[row];
    const std::size_t n = sites_->nodes();
    const SourceNodes<groups> source(*sites_, kernels_.source_of(link));
    double sum = 0;
    const bool far = Link::is_far(block_[link]);
    const double scale = far ? static_cast<double>(Link::scale(block_[link])) : 1;
    for (std::size_t k = 0; k < n; ++k) {
        four::Real K[groups]{};
        if (far) source.kernel(sites_->receiving_node(p, k), sites_->normal(p), K);
        for (std::size_t l = 0; l < n; ++l) {
            const std::size_t at = position(n, k, l);
            if (!(visible_[link * words_ + at / 32] >> (at % 32) & 1u)) continue;
            const double factor = far ? scale * K[l / 4][l % 4] : static_cast<double>(blocks_[block_[link] + at]);
            sum += sites_->weight(p, k) * factor;
        }
    }
    return sum;
}

std::vector<KeptLink> Links::list() const {
    std::vector<KeptLink> out;
    out.reserve(size());
    const auto add = [&](const Rows& rows, const auto& factor) {
        for (std::size_t row = 0; row < rows.receiver.size(); ++row)
            for (std::size_t i = rows.first[row]; i < rows.first[row + 1]; ++i)
                out.push_back({rows.receiver[row], rows.source_of(i), static_cast<float>(factor(row, i))});
    };
    add(constants_, [&](std::size_t, std::size_t i) { return factor_[i]; });
    add(kernels_, [&](std::size_t row, std::size_t i) {
        return sites_->nodes() == 4 ? mean_form_factor<1>(row, i) : mean_form_factor<3>(row, i);
    });
    std::sort(out.begin(), out.end(), [](const KeptLink& a, const KeptLink& b) {
        return std::pair(a.receiver, a.source) < std::pair(b.receiver, b.source);
    });
    return out;
}

void Links::mark(Field<ElementId, std::uint8_t>& marked) const {
    constants_.mark(marked);
    kernels_.mark(marked);
}

ElementPart linked_part(const LinkSites& sites, const Links& links, const ClusterLinks* far) {
    Field<ElementId, std::uint8_t> marked(sites.tree().size(), 0);
    links.mark(marked);
    if (far) far->mark(marked);
    return sites.part_with(std::move(marked));
}

LinkOperator::LinkOperator(const LinkSites& sites, const Links& links, const ClusterLinks* far, const ElementPart& part,
                           std::size_t together)
    : sites_(&sites),
      links_(&links),
      far_(far),
      part_(&part),
      dealt_(together > 0 ? DealtUnknowns(part.ends.size() * sites.nodes(), together * sites.nodes())
                          : DealtUnknowns(part.ends.size() * sites.nodes())),
      b_(sites),
      E_(sites) {
    if (dealt_.is_spread()) fetch_what_links_read();
}

/// Determines which unknowns this process must fetch. The mean of an element depends on all ends below it.
void LinkOperator::fetch_what_links_read() {
    const std::size_t n = sites_->nodes();
    const std::vector<ElementId>& ends = part_->ends;
    Field<ElementId, std::uint32_t> end_of(sites_->tree().size(), 0);
    for (std::size_t i = 0; i < ends.size(); ++i) end_of[ends[i]] = static_cast<std::uint32_t>(i);
    Field<ElementId, std::uint8_t> read(sites_->tree().size(), 0);
    do_own_share([&] {
        links_->for_each([&](ElementId receiver, ElementId source) {
            FetchedValues::mark(read[source], dealt_, dealt_.place(end_of[receiver] * n));
        });
    });
    for (const std::vector<ElementId>& level : part_->inner)
        for (ElementId e : level)
            for (ElementId child : sites_->tree().children(e)) read[child] |= read[e];
    std::vector<std::uint8_t> marked;
    marked.reserve(size());
    for (ElementId e : ends) marked.insert(marked.end(), n, read[e]);
    fetched_ = FetchedValues(dealt_, marked);
}

/// Computes E at the ends from b at the ends: pull, links, push.
void LinkOperator::carry() const {
    b_.pull(*part_);
    E_.clear(*part_);
    const auto add_links = [&] {
        links_->add_to(E_, b_);
        if (far_) far_->add_to(E_, b_);
    };
    if (dealt_.is_spread())
        do_own_share(add_links);
    else
        add_links();
    E_.push(*part_);
}

void LinkOperator::gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    if (dealt_.is_spread()) return gather_dealt(radiosity, irradiance);
    const std::size_t n = sites_->nodes();
    const std::vector<ElementId>& ends = part_->ends;
    parallel_for(ends.size(), 256, [&](std::size_t i) {
        for (std::size_t k = 0; k < n; ++k) b_.set_node(ends[i], k, radiosity[i * n + k]);
    });
    carry();
    parallel_for(ends.size(), 256, [&](std::size_t i) {
        for (std::size_t k = 0; k < n; ++k) irradiance[i * n + k] = E_.node(ends[i], k);
    });
}

void LinkOperator::gather_own(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    if (!dealt_.is_spread()) return gather(radiosity, irradiance);
    const std::size_t n = sites_->nodes();
    const std::vector<Spectrum> values = fetched_.with_fetched(radiosity);
    parallel_for(values.size(), 256, [&](std::size_t at) {
        const std::uint32_t unknown = fetched_.unknown_at(at);
        b_.set_node(part_->ends[unknown / n], unknown % n, values[at]);
    });
    carry();
    parallel_for(irradiance.size(), 256, [&](std::size_t at) {
        const std::size_t unknown = dealt_.unknown(at);
        irradiance[at] = E_.node(part_->ends[unknown / n], unknown % n);
    });
}

Spectrum LinkOperator::gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const {
    std::vector<Spectrum> all(size());
    gather(radiosity, all);
    return all[receiver];
}

}  // namespace exitance
