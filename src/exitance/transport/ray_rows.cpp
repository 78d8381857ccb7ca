#include "exitance/transport/ray_rows.hpp"

#include <bit>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/base/trace.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/transport/element_rays.hpp"

namespace exitance {

unsigned RayBudget::rays(double area, double mean_area) const {
    const double wanted = average * std::sqrt(area / mean_area);
    const double clamped = std::clamp(wanted, static_cast<double>(min), static_cast<double>(max));
    return std::bit_floor(static_cast<unsigned>(clamped * std::numbers::sqrt2));  // rounds to the nearer power of two
}

namespace {

/// Selects the sample points of a leaf's rays: the sequence and the number of its first point.
struct Deal {
    std::uint64_t key;
    std::uint32_t first = 0;
};

/// Assigns points to leaves. The points of a leaf begin at a multiple of their number, so that they are also stratified
/// within the leaf.
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

RayRows::RayRows(const Stage& stage, const NumberedLeaves& leaves, const RowRays& cast, const StopRequest* stop)
    : dealt_(cast.held == RowsHeld::everywhere
                 ? DealtUnknowns(leaves.numbering.leaves.size())
                 : DealtUnknowns(leaves.numbering.leaves.size(), dealt_block(leaves.numbering.leaves.size()))) {
    const ElementTree& tree = leaves.tree;
    const LeafNumbering& numbering = leaves.numbering;
    const std::size_t n = numbering.leaves.size(), block = dealt_.block();
    const double mean_area = stage.area / static_cast<double>(n);
    std::vector<std::size_t> first(n + 1, 0);  // position of each row's first ray
    for (std::size_t i = 0; i < n; ++i)
        first[i + 1] = first[i] + cast.budget.rays(stage.important_area(tree, numbering.leaves[i]), mean_area);
    rays_ = first[n];
    const std::vector<Deal> points = deal(tree, numbering, first, cast.seed, cast.dealing);
    first_.assign(dealt_.own_count() + 1, 0);
    for (std::size_t at = 0; at < dealt_.own_count(); ++at) {
        const std::size_t i = dealt_.unknown(at);
        first_[at + 1] = first_[at] + first[i + 1] - first[i];
    }
    hits_.assign(first_.back(), missed);
    escaped_.assign(dealt_.own_count(), 0);
    if (stage.rooms.portals()) counts_.assign(first_.back(), 1);
    if (!stage.glass.empty()) colours_.assign(first_.back(), Spectrum(1.0));

    parallel_own_ranges(
        n, block,
        [&](std::size_t begin, std::size_t end) {
            ElementRays rays(stage, tree, leaves.locator);
            const auto leave = cast.budget.front_alone ? ElementRays::Leave::front : ElementRays::Leave::as_met;
            for (std::size_t i = begin; i < end && !(stop && stop->requested()); ++i) {
                const auto row = of_row(std::span(hits_), i);
                const auto counts = counts_.empty() ? std::span<float>() : of_row(std::span(counts_), i);
                const auto colours = colours_.empty() ? std::span<Spectrum>() : of_row(std::span(colours_), i);
                escaped_[dealt_.place(i)] = static_cast<std::uint32_t>(
                    rays.cast(numbering.leaves[i], points[i].key, row, points[i].first, leave, counts, colours));
                note_touched("rays", row.size());
            }
        },
        {"cast rows", [&](std::size_t i) { return tree.region(numbering.leaves[i]).value; }});
    if (dealt_.is_spread())
        fetch_what_is_met();
    else
        tell_rows();
}

void RayRows::tell_rows() {
    const auto row_of = [&](auto& values) { return [&](std::size_t i) { return of_row(std::span(values), i); }; };
    exchange_values(size(), dealt_.block(), row_of(hits_), "cast rows");
    if (!counts_.empty()) exchange_values(size(), dealt_.block(), row_of(counts_), "cast rows");
    if (!colours_.empty()) exchange_values(size(), dealt_.block(), row_of(colours_), "cast rows");
    exchange_values(
        size(), dealt_.block(), [&](std::size_t i) -> std::uint32_t& { return escaped_[i]; }, "cast rows");
}

/// Finds the leaves that own rows read, and replaces leaf numbers in `hits_` by the indices of their values.
void RayRows::fetch_what_is_met() {
    std::vector<std::uint8_t> met(size(), 0);
    do_own_share([&] {
        parallel_for(dealt_.own_count(), 256, [&](std::size_t at) {
            for (const std::uint32_t leaf : places(dealt_.unknown(at)))
                if (leaf != missed) FetchedValues::mark(met[leaf], dealt_, at);
        });
    });
    fetched_ = FetchedValues(dealt_, met);
    const std::vector<std::uint32_t> place = fetched_.places();
    parallel_for(hits_.size(), 4096, [&](std::size_t k) {
        if (hits_[k] != missed) hits_[k] = place[hits_[k]];
    });
}

void RayRows::leaves_met(std::size_t i, std::vector<std::uint32_t>& out) const {
    out.assign(places(i).begin(), places(i).end());
    if (!dealt_.is_spread()) return;
    for (std::uint32_t& at : out)
        if (at != missed) at = fetched_.unknown_at(at);
}

Spectrum RayRows::read(std::size_t place, std::span<const Spectrum> radiosity) const {
    Spectrum sum;
    for (std::size_t k = first_[place]; k < first_[place + 1]; ++k)
        if (hits_[k] != missed)
            sum += (counts_.empty() ? 1 : counts_[k]) *
                   (colours_.empty() ? radiosity[hits_[k]] : colours_[k] * radiosity[hits_[k]]);
    return sum / static_cast<double>(first_[place + 1] - first_[place]);
}

Spectrum RayRows::gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const {
    EXI_CHECK(!dealt_.is_spread());
    return read(receiver, radiosity);
}

void RayRows::gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    if (dealt_.is_spread()) return gather_dealt(radiosity, irradiance);
    parallel_for(size(), 64, [&](std::size_t i) { irradiance[i] = read(i, radiosity); });
}

void RayRows::gather_own(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    if (!dealt_.is_spread()) return gather(radiosity, irradiance);
    const std::vector<Spectrum> values = fetched_.with_fetched(radiosity);
    do_own_share(
        [&] { parallel_for(irradiance.size(), 64, [&](std::size_t at) { irradiance[at] = read(at, values); }); });
}

std::vector<std::uint32_t> RayRows::escaped() const {
    std::vector<std::uint32_t> out(size());
    dealt_.tell<std::uint32_t>(escaped_, out, "cast rows");
    return out;
}

std::vector<double> RayRows::kept() const {
    std::vector<double> own(dealt_.own_count()), out(size());
    parallel_for(own.size(), 256, [&](std::size_t at) {
        double lost = 0;
        for (std::size_t k = first_[at]; k < first_[at + 1]; ++k)
            if (hits_[k] == missed) lost += counts_.empty() ? 1.0 : static_cast<double>(counts_[k]);
        own[at] = std::max(0.0, 1 - lost / static_cast<double>(first_[at + 1] - first_[at]));
    });
    dealt_.tell<double>(own, out, "cast rows");
    return out;
}

}  // namespace exitance
