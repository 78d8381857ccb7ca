#include "exitance/transport/ray_rows.hpp"

#include <bit>

#include "exitance/core/parallel.hpp"
#include "exitance/core/random.hpp"
#include "exitance/core/trace.hpp"
#include "exitance/transport/distributed.hpp"
#include "exitance/transport/element_rays.hpp"

namespace exitance {

unsigned RayBudget::rays(double area, double mean_area) const {
    const double wanted = average * std::sqrt(area / mean_area);
    const double clamped = std::clamp(wanted, static_cast<double>(least), static_cast<double>(most));
    return std::bit_floor(static_cast<unsigned>(clamped * std::numbers::sqrt2));  // to the nearer power of two
}

namespace {

/// Which points of which sequence the rays of a leaf are.
struct Deal {
    std::uint64_t key;
    std::uint32_t first = 0;
};

/// A leaf's points begin at a multiple of their number, so that they are stratified by themselves, too.
std::vector<Deal> deal(const ElementTree& tree, const LeafNumbering& numbering, const std::vector<std::size_t>& first,
                       std::uint64_t seed, Dealing dealing) {
    const auto key = [&](std::size_t i) { return hash(seed, static_cast<std::uint64_t>(Stream::rows), i); };
    std::vector<Deal> out(numbering.leaves.size());
    if (dealing == Dealing::by_element) {
        for (std::size_t i = 0; i < out.size(); ++i) out[i].key = key(i);
        return out;
    }
    std::vector<ElementId> open;
    for (ElementId root : tree.roots()) {
        std::uint32_t next = 0;
        for (open.assign(1, root); !open.empty();) {
            const ElementId e = open.back();
            open.pop_back();
            const IdRange<ElementId> children = tree.children(e);
            for (std::size_t k = children.size(); k-- > 0;) open.push_back(children[k]);
            if (!tree.is_leaf(e)) continue;
            const std::uint32_t leaf = numbering.number[e];
            const auto count = static_cast<std::uint32_t>(first[leaf + 1] - first[leaf]);
            next = (next + count - 1) / count * count;
            out[leaf] = {key(root.value), next};
            next += count;
        }
    }
    return out;
}

}  // namespace

RayRows::RayRows(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                 const ElementLocator& locator, RayBudget budget, std::uint64_t seed, Dealing dealing, RowsHeld held,
                 const StopRequest* stop)
    : held_(held) {
    const std::size_t n = numbering.leaves.size();
    const double mean_area = stage.area / static_cast<double>(n);
    first_.assign(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i)
        first_[i + 1] = first_[i] + budget.rays(stage.important_area(tree, numbering.leaves[i]), mean_area);
    rays_ = first_[n];
    const std::vector<Deal> dealt = deal(tree, numbering, first_, seed, dealing);
    if (held == RowsHeld::by_owner)
        for (std::size_t i = 0, all = 0; i < n; ++i) {
            const std::size_t count = std::exchange(all, first_[i + 1]), here = is_here(i) ? all - count : 0;
            first_[i + 1] = first_[i] + here;
        }
    hits_.assign(first_[n], missed);
    if (stage.rooms.portals()) counts_.assign(first_[n], 1);

    parallel_own_ranges(
        n, block,
        [&](std::size_t begin, std::size_t end) {
            ElementRays rays(stage, tree, locator);
            const auto leave = budget.front_alone ? ElementRays::Leave::front : ElementRays::Leave::as_met;
            for (std::size_t i = begin; i < end && !(stop && stop->requested()); ++i) {
                const std::size_t count = first_[i + 1] - first_[i];
                const auto counts = counts_.empty() ? std::span<float>() : std::span(counts_).subspan(first_[i], count);
                rays.cast(numbering.leaves[i], dealt[i].key, std::span(hits_).subspan(first_[i], count), dealt[i].first,
                          leave, counts);
                note_touched("rays", count);
            }
        },
        {"cast rows", [&](std::size_t i) { return tree.region(numbering.leaves[i]).value; }});
    if (held != RowsHeld::everywhere) return;
    const auto row_of = [&](auto& values) {
        return [&](std::size_t i) { return std::span(values).subspan(first_[i], first_[i + 1] - first_[i]); };
    };
    exchange_values(n, block, row_of(hits_), "cast rows");
    if (!counts_.empty()) exchange_values(n, block, row_of(counts_), "cast rows");
}

bool RayRows::is_here(std::size_t i) const {
    return held_ == RowsHeld::everywhere || is_own(i, block);
}

Spectrum RayRows::gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const {
    Spectrum sum;
    for (std::size_t k = first_[receiver]; k < first_[receiver + 1]; ++k)
        if (hits_[k] != missed) sum += (counts_.empty() ? 1 : counts_[k]) * radiosity[hits_[k]];
    return sum / static_cast<double>(first_[receiver + 1] - first_[receiver]);
}

void RayRows::gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    if (held_ == RowsHeld::everywhere || processes() == 1)
        return parallel_for(size(), 64, [&](std::size_t i) { irradiance[i] = gather_at(i, radiosity); });
    shared_ranges(
        size(), block,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) irradiance[i] = gather_at(i, radiosity);
        },
        [&](std::size_t i) -> Spectrum& { return irradiance[i]; }, {"solve"});
}

std::vector<double> RayRows::kept() const {
    std::vector<double> out(size());
    parallel_for(size(), 256, [&](std::size_t i) {
        if (!is_here(i)) return;
        double lost = 0;
        for (std::size_t k = first_[i]; k < first_[i + 1]; ++k)
            if (hits_[k] == missed) lost += counts_.empty() ? 1.0 : static_cast<double>(counts_[k]);
        out[i] = std::max(0.0, 1 - lost / static_cast<double>(first_[i + 1] - first_[i]));
    });
    if (held_ == RowsHeld::by_owner)
        exchange_values(
            size(), block, [&](std::size_t i) -> double& { return out[i]; }, "cast rows");
    return out;
}

}  // namespace exitance
