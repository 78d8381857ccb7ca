#include "exitance/transport/links.hpp"

#include <algorithm>

#include "exitance/core/parallel.hpp"
#include "exitance/transport/link_kernel.hpp"
#include "exitance/transport/link_layout.hpp"

namespace exitance {
namespace {

/// Where the pair of node k of the receiver and node l of the source lies in masks and blocks.
std::size_t position(std::size_t n, std::size_t k, std::size_t l) {
    return n == LinkLayout2::n ? LinkLayout2::position(k, l) : LinkLayout3::position(k, l);
}

/// By receiver, by counting, and then by source, a receiver at a time on all threads.
void sort_by_receiver(std::vector<Link>& links, std::size_t elements) {
    std::vector<std::size_t> end(elements + 1, 0);
    for (const Link& link : links) ++end[link.receiver.value + 1];
    for (std::size_t e = 0; e < elements; ++e) end[e + 1] += end[e];
    std::vector<Link> sorted(links.size());
    for (const Link& link : links) sorted[end[link.receiver.value]++] = link;
    parallel_for(elements, 64, [&](std::size_t e) {
        const auto at = [&](std::size_t i) { return sorted.begin() + static_cast<std::ptrdiff_t>(i); };
        std::sort(at(e == 0 ? 0 : end[e - 1]), at(end[e]),
                  [](const Link& a, const Link& b) { return a.source < b.source; });
    });
    links = std::move(sorted);
}

}  // namespace

Links::Links(const LinkSites& sites, std::vector<Link> links, std::vector<float> blocks)
    : sites_(&sites), blocks_(std::move(blocks)) {
    sort_by_receiver(links, sites.tree().size());
    const std::size_t n = sites.nodes();
    words_ = n == 1 ? 0 : (n * n + 31) / 32;
    for (const Link& link : links) {
        if (receiver_.empty() || receiver_.back() != link.receiver) {
            receiver_.push_back(link.receiver);
            first_.push_back(source_.size());
        }
        source_.push_back(link.source);
        if (n == 1) {
            factor_.push_back(link.factor);
        } else {
            lay_out(link);
        }
    }
    first_.push_back(source_.size());
}

void Links::lay_out(const Link& link) {
    const std::size_t n = sites_->nodes(), first = visible_.size();
    visible_.resize(first + words_, 0);
    std::array<float, 81> block;
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t l = 0; l < n; ++l) {
            const std::size_t to = position(n, k, l);
            if (link.sees(k * n + l)) visible_[first + to / 32] |= 1u << (to % 32);
            if (link.block != Link::far) block[to] = blocks_[link.block + k * n + l];
        }
    block_.push_back(link.block);
    if (link.block != Link::far) std::copy_n(block.begin(), n * n, blocks_.begin() + link.block);
}

std::size_t Links::memory_bytes() const {
    return 4 * (source_.size() + factor_.size() + visible_.size() + block_.size() + blocks_.size()) +
           12 * receiver_.size();
}

template <std::size_t groups>
double Links::mean_form_factor(std::size_t row, std::size_t link) const {
    const ElementId p = receiver_[row];
    const std::size_t n = sites_->nodes();
    const SourceNodes<groups> source(*sites_, source_[link]);
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
        four::Real K[groups]{};
        if (block_[link] == Link::far) source.kernel(sites_->node(p, k), sites_->normal(p), K);
        for (std::size_t l = 0; l < n; ++l) {
            const std::size_t at = position(n, k, l);
            if (!(visible_[link * words_ + at / 32] >> (at % 32) & 1u)) continue;
            const double factor =
                block_[link] == Link::far ? K[l / 4][l % 4] : static_cast<double>(blocks_[block_[link] + at]);
            sum += sites_->weight(p, k) * factor;
        }
    }
    return sum;
}

std::vector<KeptLink> Links::list() const {
    std::vector<KeptLink> out;
    out.reserve(size());
    for (std::size_t row = 0; row < receiver_.size(); ++row)
        for (std::size_t i = first_[row]; i < first_[row + 1]; ++i) {
            const double factor = sites_->nodes() == 1   ? static_cast<double>(factor_[i])
                                  : sites_->nodes() == 4 ? mean_form_factor<1>(row, i)
                                                         : mean_form_factor<3>(row, i);
            out.push_back({receiver_[row], source_[i], static_cast<float>(factor)});
        }
    return out;
}

LinkOperator::LinkOperator(const LinkSites& sites, const Links& links, const ClusterLinks* far,
                           const LeafNumbering& numbering)
    : sites_(&sites), links_(&links), far_(far), numbering_(&numbering), b_(sites), E_(sites) {}

void LinkOperator::gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    const std::size_t n = sites_->nodes();
    parallel_for(numbering_->leaves.size(), 256, [&](std::size_t i) {
        for (std::size_t k = 0; k < n; ++k) b_.set_node(numbering_->leaves[i], k, radiosity[i * n + k]);
    });
    b_.pull();
    links_->gather(b_, E_);
    if (far_) far_->add_to(E_, b_);
    E_.push();
    parallel_for(numbering_->leaves.size(), 256, [&](std::size_t i) {
        for (std::size_t k = 0; k < n; ++k) irradiance[i * n + k] = E_.node(numbering_->leaves[i], k);
    });
}

Spectrum LinkOperator::gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const {
    std::vector<Spectrum> all(size());
    gather(radiosity, all);
    return all[receiver];
}

}  // namespace exitance
