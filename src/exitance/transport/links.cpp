#include "exitance/transport/links.hpp"

#include <algorithm>
#include <optional>

#include "exitance/core/parallel.hpp"
#include "exitance/core/trace.hpp"
#include "exitance/transport/link_kernel.hpp"

namespace exitance {
namespace {

constexpr std::size_t grain = 16;

/// 1 in the lanes whose bits are set.
struct LaneMasks {
    four::Real of[16];
    LaneMasks() {
        for (int bits = 0; bits < 16; ++bits)
            for (int lane = 0; lane < 4; ++lane) of[bits][lane] = bits >> lane & 1;
    }
};
const LaneMasks lane_masks;

/// `count` bits from bit `first` on.
std::uint32_t bits_of(const std::uint32_t* words, std::size_t first, std::size_t count) {
    std::uint64_t window = words[first / 32];
    if (first % 32 + count > 32) window |= static_cast<std::uint64_t>(words[first / 32 + 1]) << 32;
    return static_cast<std::uint32_t>(window >> (first % 32)) & ((1u << count) - 1);
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
            visible_.insert(visible_.end(), link.visible.begin(), link.visible.begin() + static_cast<long>(words_));
            block_.push_back(link.block);
        }
    }
    first_.push_back(source_.size());
}

std::size_t Links::memory_bytes() const {
    return 4 * (source_.size() + factor_.size() + visible_.size() + block_.size() + blocks_.size()) +
           12 * receiver_.size();
}

void Links::gather_constants(std::size_t row, const NodalField& b, NodalField& E) const {
    std::array<double, bands> sum{};
    for (std::size_t i = first_[row]; i < first_[row + 1]; ++i)
        for (std::size_t band = 0; band < bands; ++band)
            sum[band] += static_cast<double>(factor_[i]) * *b.at(source_[i], band);
    for (std::size_t band = 0; band < bands; ++band) *E.at(receiver_[row], band) = sum[band];
}

template <std::size_t groups>
void Links::gather_kernels(std::size_t row, const NodalField& b, NodalField& E) const {
    const ElementId p = receiver_[row];
    const Normal& n = sites_->normal(p);
    const std::size_t count = sites_->nodes();
    for (std::size_t i = first_[row]; i < first_[row + 1]; ++i) {
        const ElementId q = source_[i];
        std::optional<SourceNodes<groups>> source;
        const float* block = nullptr;
        if (block_[i] == Link::far)
            source.emplace(*sites_, q);
        else
            block = &blocks_[block_[i]];
        four::Real light[bands][groups];
        for (std::size_t band = 0; band < bands; ++band)
            for (std::size_t g = 0; g < groups; ++g) light[band][g] = four::load(b.at(q, band) + 4 * g);
        const std::uint32_t* const visible = &visible_[i * words_];
        for (std::size_t k = 0; k < count; ++k) {
            four::Real K[groups]{};
            if (source)
                source->kernel(sites_->node(p, k), n, K);
            else
                for (std::size_t l = 0; l < 4 * groups; ++l)
                    K[l / 4][l % 4] = l < count ? static_cast<double>(block[k * count + l]) : 0.0;
            for (std::size_t g = 0; g < groups; ++g)
                K[g] *= lane_masks.of[bits_of(visible, k * count + 4 * g, std::min<std::size_t>(4, count - 4 * g))];
            for (std::size_t band = 0; band < bands; ++band) {
                four::Real total = K[0] * light[band][0];
                for (std::size_t g = 1; g < groups; ++g) total += K[g] * light[band][g];
                E.at(p, band)[k] += sum(total);
            }
        }
    }
}

void Links::gather(const NodalField& b, NodalField& E) const {
    E.clear();
    parallel_for(receiver_.size(), grain,
                 [&](std::size_t row) {
                     if (sites_->nodes() == 1)
                         gather_constants(row, b, E);
                     else if (sites_->nodes() == 4)
                         gather_kernels<1>(row, b, E);
                     else
                         gather_kernels<3>(row, b, E);
                     note_touched("links", first_[row + 1] - first_[row]);
                 },
                 {"gather links", [&](std::size_t row) { return sites_->tree().region(receiver_[row]).value; }, true});
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
            const std::size_t bit = k * n + l;
            if (!bits_of(&visible_[link * words_], bit, 1)) continue;
            const double factor =
                block_[link] == Link::far ? K[l / 4][l % 4] : static_cast<double>(blocks_[block_[link] + bit]);
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
