#include "exitance/transport/link_refiner.hpp"

#include <algorithm>

#include "exitance/core/parallel.hpp"
#include "exitance/mesh/adaptive.hpp"

namespace exitance {

struct LinkRefiner::Block {
    std::vector<Link> links;
    std::vector<bool> open;
    std::vector<Departure> departure;
    std::vector<Shadowed> shadowed;
    std::vector<double> squared_error, light;
    std::vector<float> blocks;
    std::vector<LinkPair> cut;        ///< Their sources are to be cut.
    std::vector<PieceId> candidates;  ///< Of those.
    std::size_t rays = 0, form_factors = 0;
};

namespace {

constexpr std::size_t block_size = 128;

/// An element takes its parent's function.
void inherit(const LinkSites& sites, ElementId parent, ElementId child, NodalField& field) {
    const auto push = sites.push(child);
    const std::size_t n = sites.nodes();
    for (std::size_t band = 0; band < bands; ++band)
        for (std::size_t k = 0; k < n; ++k) {
            double sum = 0;
            for (std::size_t j = 0; j < n; ++j) sum += push[k * n + j] * field.at(parent, band)[j];
            field.at(child, band)[k] = sum;
        }
}

}  // namespace

std::vector<LinkPair> LinkRefiner::pairs_to_begin_with() const {
    std::vector<LinkPair> out;
    if (begun_) {
        for (std::size_t i = 0; i < links_.size(); ++i)
            out.push_back({links_[i].receiver, links_[i].source, open_[i] ? View::open : View::mixed});
        return out;
    }
    const Scene& scene = sites_.stage().scene;
    for (ElementId p : tree_.roots())
        for (ElementId q : tree_.roots()) {
            if (tree_.region(p) == tree_.region(q) || max(scene.material(tree_.region(q)).reflectance) <= 0) continue;
            out.push_back({p, q});
        }
    return out;
}

void LinkRefiner::cut_elements(const std::vector<ElementId>& elements, NodalField& b,
                               std::span<NodalField* const> also) {
    for (ElementId e : elements) refine_element(tree_, e);
    sites_.update();
    b.resize();
    for (NodalField* field : also) field->resize();
    roughness_.resize(tree_.size(), 0.0);
    for (ElementId e : elements)
        for (ElementId child : tree_.children(e)) {
            inherit(sites_, e, child, b);
            for (NodalField* field : also) inherit(sites_, e, child, *field);
        }
}

void LinkRefiner::judge(std::vector<LinkPair> pairs, const NodalField& b, const LinkTolerance& tolerance,
                        const StopRequest& stop) {
    std::vector<PieceId> pool;
    while (!pairs.empty()) {
        std::vector<Block> blocks((pairs.size() + block_size - 1) / block_size);
        // Once a stop is asked for, what is left is linked as it is.
        LinkTolerance now = tolerance;
        limited_ |= links_.size() + pairs.size() > tolerance.most_links;
        if (stop.requested() || limited_) now.error = HUGE_VAL;
        parallel_for(blocks.size(), 1, [&](std::size_t i) {
            LinkJudge judge(sites_, b, roughness_, now);
            Block& block = blocks[i];
            for (std::size_t k = i * block_size; k < std::min(pairs.size(), (i + 1) * block_size); ++k) {
                LinkPair pair = pairs[k];
                LinkJudge::Result result = judge.judge(pair, pool);
                if (result.verdict == LinkJudge::Verdict::drop) continue;
                if (result.verdict == LinkJudge::Verdict::cut_source) {
                    const auto candidates = pair.view == View::mixed ? judge.candidates() : std::span<const PieceId>();
                    pair.first = static_cast<std::uint32_t>(block.candidates.size());
                    pair.count = static_cast<std::uint32_t>(candidates.size());
                    block.candidates.insert(block.candidates.end(), candidates.begin(), candidates.end());
                    block.cut.push_back(pair);
                    continue;
                }
                if (result.near) {
                    result.link.block = static_cast<std::uint32_t>(block.blocks.size());
                    block.blocks.insert(block.blocks.end(), judge.block().begin(), judge.block().end());
                }
                block.links.push_back(result.link);
                block.open.push_back(pair.view == View::open);
                block.departure.push_back(result.departure);
                block.shadowed.push_back({result.shadowed, result.variance});
                block.squared_error.push_back(result.squared_error);
                block.light.push_back(result.light);
            }
            block.rays = judge.rays(), block.form_factors = judge.form_factors();
        });
        pairs.clear();
        std::vector<PieceId> next_pool;
        for (Block& block : blocks) {
            for (Link& link : block.links) {
                if (sites_.nodes() > 1 && link.block != Link::far)
                    link.block += static_cast<std::uint32_t>(blocks_.size());
                links_.push_back(link);
            }
            blocks_.insert(blocks_.end(), block.blocks.begin(), block.blocks.end());
            open_.insert(open_.end(), block.open.begin(), block.open.end());
            departure_.insert(departure_.end(), block.departure.begin(), block.departure.end());
            shadowed_.insert(shadowed_.end(), block.shadowed.begin(), block.shadowed.end());
            light_.insert(light_.end(), block.light.begin(), block.light.end());
            squared_error_.insert(squared_error_.end(), block.squared_error.begin(), block.squared_error.end());
            rays_ += block.rays, form_factors_ += block.form_factors;
            for (LinkPair pair : block.cut) {
                pair.first += static_cast<std::uint32_t>(next_pool.size());
                for (ElementId child : tree_.children(pair.source)) {
                    pairs.push_back(pair);
                    pairs.back().source = child;
                }
            }
            next_pool.insert(next_pool.end(), block.candidates.begin(), block.candidates.end());
        }
        pool = std::move(next_pool);
    }
}

void LinkRefiner::remove(const std::vector<bool>& gone) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < links_.size(); ++i) {
        if (gone[i]) continue;
        links_[kept] = links_[i], open_[kept] = open_[i];
        departure_[kept] = departure_[i], shadowed_[kept] = shadowed_[i];
        squared_error_[kept] = squared_error_[i], light_[kept] = light_[i];
        ++kept;
    }
    links_.resize(kept), open_.resize(kept), departure_.resize(kept), shadowed_.resize(kept);
    squared_error_.resize(kept), light_.resize(kept);
}

std::vector<LinkPair> LinkRefiner::cut_receivers(NodalField& b, std::span<NodalField* const> also,
                                                 const LinkTolerance& tolerance) {
    const auto squared = [](const Departure& d) {
        double sum = 0;
        for (double v : d) sum += v * v;
        return sum / static_cast<double>(d.size());
    };
    Field<ElementId, Departure> all(tree_.size());
    Field<ElementId, Shadowed> shadowed(tree_.size());
    for (std::size_t i = 0; i < links_.size(); ++i) {
        const ElementId p = links_[i].receiver;
        for (std::size_t c = 0; c < departure_[i].size(); ++c) all[p][c] += departure_[i][c];
        for (std::size_t k = 0; k < sites_.nodes(); ++k) {
            shadowed[p].light[k] += shadowed_[i].light[k];
            shadowed[p].variance[k] += shadowed_[i].variance[k];
        }
    }
    // Where shadowed light varies over a receiver by more than the rays' errors, a part of that is no polynomial.
    const auto unevenness = [&](ElementId e) {
        double mean = 0, square = 0, noise = 0;
        for (std::size_t k = 0; k < sites_.nodes(); ++k) {
            const double w = sites_.weight(e, k), v = shadowed[e].light[k];
            mean += w * v, square += w * v * v, noise += w * shadowed[e].variance[k];
        }
        constexpr double share = 0.5;
        return share * share * std::max(0.0, square - mean * mean - noise);
    };
    std::vector<ElementId> leaves;
    Field<ElementId, std::uint8_t> too_much(tree_.size(), 0);
    interpolation_ = 0;
    for (ElementId e : all.ids()) {
        const double error = tree_.area(e) * (squared(all[e]) + unevenness(e));
        interpolation_ += error;
        too_much[e] = error > tolerance.interpolation * tolerance.interpolation;
        if (!too_much[e] || !tree_.is_leaf(e)) continue;
        if (tree_.area(e) > 2 * tolerance.least_area)
            leaves.push_back(e);
        else
            too_much[e] = 0;
    }
    std::vector<bool> gone(links_.size());
    std::vector<LinkPair> pairs;
    // A link that hardly departs stays where it is; all such ones of a receiver together are a share of what is
    // allowed.
    const double negligible = 0.03 * tolerance.interpolation;
    std::vector<std::size_t> inherited;
    for (std::size_t i = 0; i < links_.size(); ++i) {
        const ElementId p = links_[i].receiver;
        if (!too_much[p] || (open_[i] && tree_.area(p) * squared(departure_[i]) < negligible * negligible)) continue;
        gone[i] = true;
        inherited.push_back(i);
    }
    cut_elements(leaves, b, also);
    for (std::size_t i : inherited)
        for (ElementId child : tree_.children(links_[i].receiver))
            pairs.push_back({child, links_[i].source, open_[i] ? View::open : View::mixed});
    remove(gone);
    return pairs;
}

void LinkRefiner::refine(NodalField& b, std::span<NodalField* const> also, const LinkTolerance& tolerance,
                         Progress& progress, const StopRequest& stop) {
    roughness_ = b.roughness();
    std::vector<LinkPair> pairs = pairs_to_begin_with();
    begun_ = true;
    links_.clear(), open_.clear(), departure_.clear(), shadowed_.clear(), squared_error_.clear(), light_.clear(),
        blocks_.clear();
    for (int round = 0; !pairs.empty(); ++round) {
        judge(std::move(pairs), b, tolerance, stop);
        if (stop.requested() || limited_) return;
        pairs = cut_receivers(b, also, tolerance);
        progress.advance(1 - std::ldexp(1.0, -round));
    }
}

double LinkRefiner::error() const {
    double sum = interpolation_;
    for (double e : squared_error_) sum += e;
    return std::sqrt(sum);
}

double LinkRefiner::open_share() const {
    double open = 0, all = 0;
    for (std::size_t i = 0; i < links_.size(); ++i) all += light_[i], open += open_[i] ? light_[i] : 0;
    return all > 0 ? open / all : 1;
}

Links LinkRefiner::make_links() const {
    return Links(sites_, links_, blocks_);
}

}  // namespace exitance
