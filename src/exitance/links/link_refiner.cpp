#include "exitance/links/link_refiner.hpp"

#include <algorithm>
#include <utility>

#include "exitance/base/parallel.hpp"
#include "exitance/base/trace.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/mesh/adaptive.hpp"

namespace exitance {

struct LinkRefiner::Block {
    std::vector<FoundLink> links;
    std::vector<float> blocks, shadows;
    std::vector<LinkPair> cut;        ///< Pairs whose sources are to be split.
    std::vector<PieceId> candidates;  ///< Occluder candidates of the pairs in `cut`.
    std::size_t rays = 0, form_factors = 0;

    std::size_t bytes() const {
        return links.size() * sizeof(FoundLink) + (blocks.size() + shadows.size()) * 4 + cut.size() * sizeof(LinkPair) +
               candidates.size() * 4;
    }
};

namespace {

/// Number of pairs per task: large enough to outweigh its overhead, small enough to balance the load at the end of a
/// round.
std::size_t block_size_for(std::size_t pairs) {
    constexpr std::size_t tasks = 512, min_size = 8, max_size = 128;
    return std::clamp(pairs / tasks, min_size, max_size);
}

/// A child inherits its parent's function.
void inherit(const LinkSites& sites, ElementId parent, ElementId child, NodalField& field) {
    const auto push = sites.push(child);
    const std::size_t n = sites.nodes();
    for (std::size_t band = 0; band < bands; ++band)
        for (std::size_t k = 0; k < n; ++k) {
            float sum = 0;
            for (std::size_t j = 0; j < n; ++j) sum += push[k * n + j] * field.at(parent, band)[j];
            field.at(child, band)[k] = sum;
        }
}

}  // namespace

LinkPair LinkRefiner::pair_of(const FoundLink& found) {
    return {found.link.receiver, found.link.source, found.open ? View::open : View::mixed};
}

/// Processes groups of receivers: all k^2 pairs at once would take more memory than the resulting links.
void LinkRefiner::judge_all_pieces(const NodalField& b, const LinkTolerance& tolerance, const StopRequest& stop) {
    constexpr std::size_t pairs_per_batch = 1 << 20;
    const Scene& scene = sites_.stage().scene;
    std::vector<LinkPair> pairs;
    for (ElementId p : tree_.roots()) {
        for (ElementId q : tree_.roots()) {
            if (tree_.region(p) == tree_.region(q) || max(scene.material(tree_.region(q)).reflectance) <= 0) continue;
            pairs.push_back({p, q});
        }
        if (pairs.size() >= pairs_per_batch) judge(std::exchange(pairs, {}), b, tolerance, stop);
    }
    judge(std::move(pairs), b, tolerance, stop);
}

double LinkRefiner::growth(const NodalField& b, ElementId source) const {
    if (light_stays_) return 1;
    double now = 0, then = 0, changed = 0;
    const std::size_t n = sites_.nodes();
    for (std::size_t k = 0; k < n; ++k)
        now += sites_.weight(source, k) * squared(b.node(source, k)),
            then += sites_.weight(source, k) * squared(judged_.node(source, k));
    if (then <= 0) return now > 0 ? -1 : 1;
    const double growth = std::sqrt(now / then);
    for (std::size_t k = 0; k < n; ++k)
        changed += sites_.weight(source, k) * squared(b.node(source, k) - growth * judged_.node(source, k));
    const double negligible_change = calibrated::negligible_source_change;
    return changed <= negligible_change * negligible_change * now ? growth : -1;
}

/// Keeps the links that are certainly still good enough; their light and error scale with their source's light. Returns
/// the others, as pairs.
std::vector<LinkPair> LinkRefiner::take_stale_links(const NodalField& b, const LinkTolerance& tolerance) {
    // With a stricter tolerance a kept link would have been judged by more accurate rules, so its error must be well
    // below the limit.
    const double kept_share = calibrated::kept_link_share;
    const double allowed = kept_share * kept_share * tolerance.error * tolerance.error;
    Field<ElementId, float> growth_of(tree_.size(), -1.0f);
    if (tolerance.oracle == LinkOracle::transport && importance_.empty())
        parallel_for(tree_.size(), 256, [&](std::size_t i) {
            const ElementId e(i);
            if (sites_.holds(e)) growth_of[e] = static_cast<float>(growth(b, e));
        });
    const std::size_t n = sites_.nodes();
    std::vector<LinkPair> stale;
    std::vector<float> blocks, shadows;
    std::size_t kept = 0;
    for (const FoundLink& found : links_) {
        const float growth = growth_of[found.link.source];
        if (growth < 0 || static_cast<double>(growth * growth * found.squared_error) > allowed ||
            static_cast<double>(growth * found.undersampling) > tolerance.error) {
            stale.push_back(pair_of(found));
            continue;
        }
        FoundLink& still = links_[kept++] = found;
        still.light *= growth, still.undersampling *= growth, still.squared_error *= growth * growth;
        for (float& d : still.departure) d *= growth;
        if (still.near) {
            const auto block = blocks_.begin() + found.link.block;
            still.link.block = static_cast<std::uint32_t>(blocks.size());
            blocks.insert(blocks.end(), block, block + static_cast<std::ptrdiff_t>(n * n));
        }
        if (const float* shadow = shadow_of(found)) {
            still.shadow = static_cast<std::uint32_t>(shadows.size());
            for (std::size_t k = 0; k < n; ++k) shadows.push_back(growth * shadow[k]);
            for (std::size_t k = n; k < 2 * n; ++k) shadows.push_back(growth * growth * shadow[k]);
        }
    }
    links_.resize(kept);
    blocks_ = std::move(blocks), shadows_ = std::move(shadows);
    return stale;
}

/// Judges the links found earlier.
void LinkRefiner::judge_again(const NodalField& b, const LinkTolerance& tolerance, const StopRequest& stop) {
    judge(take_stale_links(b, tolerance), b, tolerance, stop);
}

void LinkRefiner::cut_elements(const std::vector<ElementId>& elements, NodalField& b,
                               std::span<NodalField* const> also) {
    for (ElementId e : elements) refine_element(tree_, e);
    sites_.open(elements);
    b.resize();
    for (NodalField* field : also) field->resize();
    roughness_.resize(tree_.size(), 0.0);
    if (!importance_.empty()) importance_.resize(tree_.size(), 0.0);
    parallel_for(elements.size(), 64, [&](std::size_t i) {
        const ElementId e = elements[i];
        for (ElementId child : tree_.children(e)) {
            if (!importance_.empty()) importance_[child] = importance_[e];
            inherit(sites_, e, child, b);
            for (NodalField* field : also) inherit(sites_, e, child, *field);
        }
    });
}

void LinkRefiner::open(std::vector<ElementId> parents) {
    std::sort(parents.begin(), parents.end());
    parents.erase(std::unique(parents.begin(), parents.end()), parents.end());
    std::erase_if(parents, [&](ElementId e) { return tree_.is_leaf(e) || sites_.is_open(e); });
    if (parents.empty()) return;
    sites_.open(parents);
    light_below_(parents, roughness_);
}

/// Judges some pairs. Each one that is not dropped becomes a link or a source to split. `pool` contains their
/// candidates.
LinkRefiner::Block LinkRefiner::judge_block(std::span<const LinkPair> pairs, LinkJudge& judge,
                                            std::span<const PieceId> pool) const {
    Block out;
    for (LinkPair pair : pairs) {
        note_source(tree_.region(pair.source).value);
        LinkDecision result = judge.judge(pair, pool);
        if (result.verdict == LinkDecision::Verdict::drop) continue;
        if (result.verdict == LinkDecision::Verdict::cut_source) {
            const auto candidates = pair.view == View::mixed ? judge.candidates() : std::span<const PieceId>();
            pair.first = static_cast<std::uint32_t>(out.candidates.size());
            pair.count = static_cast<std::uint32_t>(candidates.size());
            out.candidates.insert(out.candidates.end(), candidates.begin(), candidates.end());
            out.cut.push_back(pair);
            continue;
        }
        if (result.near) {
            result.link.block = static_cast<std::uint32_t>(out.blocks.size());
            out.blocks.insert(out.blocks.end(), judge.block().begin(), judge.block().end());
        }
        out.links.push_back({result, pair.view == View::open});
        if (pair.view == View::open || sites_.nodes() == 1 || result.link.is_constant()) continue;
        out.links.back().shadow = static_cast<std::uint32_t>(out.shadows.size());
        for (const auto& at_nodes : {result.shadowed, result.variance})
            out.shadows.insert(out.shadows.end(), at_nodes.begin(),
                               at_nodes.begin() + static_cast<std::ptrdiff_t>(sites_.nodes()));
    }
    out.rays = judge.rays(), out.form_factors = judge.form_factors();
    return out;
}

void LinkRefiner::add_links_of(const Block& block) {
    for (FoundLink found : block.links) {
        if (found.near) found.link.block += static_cast<std::uint32_t>(blocks_.size());
        if (found.shadow != FoundLink::none) found.shadow += static_cast<std::uint32_t>(shadows_.size());
        links_.push_back(found);
    }
    blocks_.insert(blocks_.end(), block.blocks.begin(), block.blocks.end());
    shadows_.insert(shadows_.end(), block.shadows.begin(), block.shadows.end());
    rays_ += block.rays, form_factors_ += block.form_factors;
}

void LinkRefiner::judge(std::vector<LinkPair> pairs, const NodalField& b, const LinkTolerance& tolerance,
                        const StopRequest& stop) {
    std::vector<PieceId> pool;
    while (!pairs.empty() && !(tolerance.gives_up && stop.requested())) {
        const std::size_t block_size = block_size_for(pairs.size());
        std::vector<Block> blocks((pairs.size() + block_size - 1) / block_size);
        LinkTolerance now = tolerance;
        now.importance = importance_.empty() ? nullptr : &importance_;
        // After a stop request, link the remaining pairs as they are.
        LinkTolerance any = now;
        any.error = HUGE_VAL;
        limited_ |= links_.size() + pairs.size() > tolerance.max_links;
        parallel_for(
            blocks.size(), 1,
            [&](std::size_t i) {
                if (tolerance.gives_up && stop.requested()) return;
                LinkJudge judge(sites_, b, roughness_, limited_ || stop.requested() ? any : now);
                const std::size_t first = i * block_size, count = std::min(block_size, pairs.size() - first);
                blocks[i] = judge_block(std::span(pairs).subspan(first, count), judge, pool);
                note_touched("rays", blocks[i].rays), note_touched("links", blocks[i].links.size());
                note_touched("bytes", blocks[i].bytes());
            },
            {"judge links", [&](std::size_t i) { return tree_.region(pairs[i * block_size].receiver).value; }, true});
        pairs.clear(), pool.clear();
        std::vector<ElementId> cut;
        for (const Block& block : blocks) {
            add_links_of(block);
            for (LinkPair pair : block.cut) {
                cut.push_back(pair.source);
                pair.first += static_cast<std::uint32_t>(pool.size());
                for (ElementId child : tree_.children(pair.source)) {
                    pairs.push_back(pair);
                    pairs.back().source = child;
                }
            }
            pool.insert(pool.end(), block.candidates.begin(), block.candidates.end());
        }
        open(std::move(cut));
    }
}

/// The light of receivers over all rounds: only new links are added and judged.
struct LinkRefiner::Receivers {
    Field<ElementId, ReceivedLight> light;
    Field<ElementId, double> error;  ///< Squared interpolation error.
    std::size_t known = 0;           ///< Number of links included so far.
};

/// Adds the new links. Returns flags of those of their receivers whose light departs too much from a polynomial, and
/// appends to `leaves` those of them that are leaves and must be split.
Field<ElementId, std::uint8_t> LinkRefiner::judge_receivers(Receivers& receivers, const LinkTolerance& tolerance,
                                                            std::vector<ElementId>& leaves) {
    receivers.light.resize(tree_.size()), receivers.error.resize(tree_.size(), 0.0);
    enum : std::uint8_t { nothing, links, cutting_ones };
    Field<ElementId, std::uint8_t> too_much(tree_.size(), 0), gained(tree_.size(), nothing);
    std::vector<ElementId> gaining;
    for (; receivers.known < links_.size(); ++receivers.known) {
        const FoundLink& found = links_[receivers.known];
        receivers.light[found.link.receiver].add(found, shadow_of(found), sites_.nodes());
        std::uint8_t& here = gained[found.link.receiver];
        if (here == nothing) gaining.push_back(found.link.receiver);
        here = std::max<std::uint8_t>(here, found.cuts_receiver ? cutting_ones : links);
    }
    std::sort(gaining.begin(), gaining.end());
    for (ElementId e : gaining) {
        receivers.error[e] = weight(e) * tree_.area(e) * receivers.light[e].squared_error(sites_, e);
        const bool departs = tolerance.oracle == LinkOracle::transport &&
                             receivers.error[e] > tolerance.interpolation * tolerance.interpolation;
        if (!departs && gained[e] != cutting_ones) continue;
        if (tree_.is_leaf(e) && tree_.area(e) <= 2 * tolerance.min_area) continue;
        too_much[e] = 1;
        receivers.light[e] = {};  // reset: it is summed again over the remaining links
        if (tree_.is_leaf(e)) leaves.push_back(e);
    }
    return too_much;
}

std::vector<LinkPair> LinkRefiner::cut_receivers(NodalField& b, std::span<NodalField* const> also,
                                                 const LinkTolerance& tolerance, Receivers& receivers) {
    std::vector<ElementId> leaves;
    const Field<ElementId, std::uint8_t> too_much = judge_receivers(receivers, tolerance, leaves);
    cut_elements(leaves, b, also);
    std::vector<ElementId> cut;
    for (ElementId e : too_much.ids())
        if (too_much[e]) cut.push_back(e);
    open(std::move(cut));
    // A link with a negligible departure stays with the receiver; all such links together are within a share of the
    // tolerance.
    const double negligible = calibrated::negligible_departure_share * tolerance.interpolation;
    enum : std::uint8_t { untouched, left, handed_on };
    const auto fate_of = [&](const FoundLink& found) -> std::uint8_t {
        const ElementId p = found.link.receiver;
        if (!too_much[p]) return untouched;
        if (found.cuts_receiver) return handed_on;
        if (tolerance.oracle != LinkOracle::transport) return left;
        // Half of the light that may be occluded may be missing in places.
        const double light = static_cast<double>(found.light) / tree_.area(p), hidden = found.open ? 0 : 0.5 * light;
        const double error = weight(p) * tree_.area(p) * (mean_square(found.departure) + hidden * hidden);
        return error < negligible * negligible ? left : handed_on;
    };
    // Most receivers that are split were linked recently, so long runs of links stay in place.
    constexpr std::size_t stretch = 1024;
    std::vector<std::uint8_t> fate(links_.size()), stays((links_.size() + stretch - 1) / stretch, 1);
    parallel_ranges(links_.size(), stretch, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            if ((fate[i] = fate_of(links_[i])) != untouched) stays[first / stretch] = 0;
    });
    std::vector<LinkPair> pairs;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < links_.size(); ++i) {
        if (kept == i && i % stretch == 0 && stays[i / stretch]) {
            kept = std::min(links_.size(), i + stretch);
            i = kept - 1;
            continue;
        }
        if (fate[i] == handed_on) {
            for (ElementId child : tree_.children(links_[i].link.receiver)) {
                pairs.push_back(pair_of(links_[i]));
                pairs.back().receiver = child;
            }
            continue;
        }
        if (fate[i] == left)
            receivers.light[links_[i].link.receiver].add(links_[i], shadow_of(links_[i]), sites_.nodes());
        if (kept != i) links_[kept] = links_[i];
        ++kept;
    }
    links_.resize(kept);
    receivers.known = kept;
    parallel_for(too_much.size(), 4096, [&](std::size_t i) {
        const ElementId e(i);
        if (too_much[e]) receivers.error[e] = weight(e) * tree_.area(e) * receivers.light[e].squared_error(sites_, e);
    });
    return pairs;
}

void LinkRefiner::refine(NodalField& b, std::span<NodalField* const> also, const LinkTolerance& tolerance,
                         Progress& progress, const StopRequest& stop) {
    roughness_ = b.roughness(roughness_);
    if (std::exchange(begun_, true))
        judge_again(b, tolerance, stop);
    else
        judge_all_pieces(b, tolerance, stop);
    cut_until_good(b, also, tolerance, progress, stop);
}

void LinkRefiner::refine(const std::vector<LinkPair>& fresh, NodalField& b, std::span<NodalField* const> also,
                         const LinkTolerance& tolerance, Progress& progress, const StopRequest& stop) {
    roughness_ = b.roughness(roughness_);
    judge_again(b, tolerance, stop);
    judge(fresh, b, tolerance, stop);
    cut_until_good(b, also, tolerance, progress, stop);
}

void LinkRefiner::cut_until_good(NodalField& b, std::span<NodalField* const> also, const LinkTolerance& tolerance,
                                 Progress& progress, const StopRequest& stop) {
    Receivers receivers;
    for (int round = 0; !stop.requested() && !limited_; ++round) {
        std::vector<LinkPair> pairs = cut_receivers(b, also, tolerance, receivers);
        if (pairs.empty()) break;
        progress.advance(1 - std::ldexp(1.0, -round));
        judge(std::move(pairs), b, tolerance, stop);
    }
    interpolation_ = 0;
    for (double error : receivers.error) interpolation_ += error;
    sum_up();
    if (!light_stays_) judged_ = b;
}

void LinkRefiner::sum_up() {
    struct Sums {
        double squared_error = 0, light = 0, open = 0;
        Sums& operator+=(const Sums& o) {
            squared_error += o.squared_error, light += o.light, open += o.open;
            return *this;
        }
    };
    const Sums sums = parallel_sum<Sums>(links_.size(), [&](std::size_t i) {
        const FoundLink& found = links_[i];
        const double light = static_cast<double>(found.light);
        return Sums{static_cast<double>(found.squared_error), light, found.open ? light : 0};
    });
    link_error_ = std::sqrt(sums.squared_error);
    light_ = sums.light, open_light_ = sums.open;
}

Links LinkRefiner::make_links() const {
    const std::size_t size = sites_.nodes() * sites_.nodes();
    std::vector<Link> links(links_.size());
    // per link: index of its block among the blocks of the remaining links
    std::vector<std::uint32_t> place(links_.size());
    std::uint32_t near = 0;
    for (std::size_t i = 0; i < links_.size(); ++i) place[i] = near, near += links_[i].near ? 1 : 0;
    std::vector<float> blocks(near * size);
    parallel_for(links_.size(), 4096, [&](std::size_t i) {
        links[i] = links_[i].link;
        if (!links_[i].near) return;
        links[i].block = static_cast<std::uint32_t>(place[i] * size);
        std::copy_n(blocks_.begin() + links_[i].link.block, size, blocks.begin() + links[i].block);
    });
    return Links(sites_, std::move(links), std::move(blocks));
}

}  // namespace exitance
