#include "exitance/links/leaf_links.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/trace.hpp"

namespace exitance {
namespace {

constexpr std::size_t receivers_per_task = 8;  // receivers per task

/// The links of the leaves of one task.
struct Block {
    std::vector<Link> links;
    std::vector<float> blocks;
    double squared_error = 0, light = 0, open = 0;
    std::size_t rays = 0, form_factors = 0;
};

/// Views between one receiving piece and all pieces, with possible occluders.
class PieceViews {
  public:
    explicit PieceViews(const LinkSites& sites) : sites_(sites), from_(sites.tree().roots().size()) {}

    void set_receiver(ElementId root) {
        if (receiver_ == root) return;
        receiver_ = root;
        pool_.clear();
        const std::vector<Point> receiver = sites_.tree().outline(root);
        for (ElementId q : sites_.tree().roots()) {
            const std::vector<Point> source = sites_.tree().outline(q);
            shaft_.set(sites_.stage().occluders, facet(receiver, root), facet(source, q));
            LinkPair& pair = from_[q.value];
            pair = {root, q, shaft_.classify(candidates_), true};
            pair.first = static_cast<std::uint32_t>(pool_.size());
            pair.count = static_cast<std::uint32_t>(pair.view == View::mixed ? candidates_.size() : 0);
            pool_.insert(pool_.end(), candidates_.begin(), candidates_.begin() + pair.count);
        }
    }
    const LinkPair& from(ElementId root) const { return from_[root.value]; }
    std::span<const PieceId> pool() const { return pool_; }

  private:
    Facet facet(std::span<const Point> outline, ElementId e) const {
        return {outline, sites_.normal(e), sites_.tree().region(e)};
    }

    const LinkSites& sites_;
    ElementId receiver_;
    std::vector<LinkPair> from_;
    std::vector<PieceId> pool_, candidates_;
    Shaft shaft_;
};

/// A leaf and its piece; sorted by piece.
struct LeafOfPiece {
    ElementId leaf, root;
};

std::vector<LeafOfPiece> leaves_by_piece(const ElementTree& tree) {
    Field<ElementId, ElementId> root(tree.size());
    std::vector<LeafOfPiece> out;
    for (ElementId e : tree.ids()) {
        root[e] = tree.parent(e).is_none() ? e : root[tree.parent(e)];
        if (tree.is_leaf(e)) out.push_back({e, root[e]});
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const LeafOfPiece& a, const LeafOfPiece& b) { return a.root < b.root; });
    return out;
}

void link_leaf(const LinkSites& sites, const LeafOfPiece& receiver, std::span<const LeafOfPiece> sources,
               PieceViews& views, LinkJudge& judge, Block& block) {
    const ElementTree& tree = sites.tree();
    views.set_receiver(receiver.root);
    for (const LeafOfPiece& source : sources) {
        if (tree.region(receiver.leaf) == tree.region(source.leaf)) continue;
        LinkPair pair = views.from(source.root);
        if (pair.view == View::none) continue;
        if (max(sites.stage().scene.material(tree.region(source.leaf)).reflectance) <= 0) continue;
        pair.receiver = receiver.leaf, pair.source = source.leaf;
        LinkDecision result = judge.judge(pair, views.pool());
        if (result.verdict == LinkDecision::Verdict::drop) continue;
        if (result.near) {
            result.link.block = static_cast<std::uint32_t>(block.blocks.size());
            block.blocks.insert(block.blocks.end(), judge.block().begin(), judge.block().end());
        }
        block.links.push_back(result.link);
        block.squared_error += result.squared_error;
        block.light += result.light;
        if (pair.view == View::open) block.open += result.light;
    }
}

}  // namespace

LeafLinks link_leaves(const LinkSites& sites, const NodalField& b, const LinkTolerance& tolerance,
                      const StopRequest& stop) {
    const std::vector<LeafOfPiece> leaves = leaves_by_piece(sites.tree());
    const Field<ElementId, double> roughness(sites.tree().size(), 0.0);  // zero: the light of leaves counts as exact
    std::vector<Block> found((leaves.size() + receivers_per_task - 1) / receivers_per_task);
    parallel_for(found.size(), 1,
                 [&](std::size_t i) {
                     LinkJudge judge(sites, b, roughness, tolerance);
                     PieceViews views(sites);
                     Block& block = found[i];
                     const std::size_t end = std::min(leaves.size(), (i + 1) * receivers_per_task);
                     for (std::size_t k = i * receivers_per_task; k < end && !stop.requested(); ++k)
                         link_leaf(sites, leaves[k], leaves, views, judge, block);
                     block.rays = judge.rays(), block.form_factors = judge.form_factors();
                     note_touched("rays", block.rays), note_touched("links", block.links.size());
                 },
                 {"link leaves",
                  [&](std::size_t i) { return sites.tree().region(leaves[i * receivers_per_task].leaf).value; }, true});

    std::size_t link_count = 0, float_count = 0;
    for (const Block& block : found) link_count += block.links.size(), float_count += block.blocks.size();
    std::vector<Link> links;
    std::vector<float> blocks;
    links.reserve(link_count), blocks.reserve(float_count);
    double squared_error = 0, light = 0, open = 0;
    std::size_t rays = 0, form_factors = 0;
    for (Block& block : found) {
        std::size_t near = blocks.size();
        for (Link& link : block.links) {
            if (sites.nodes() > 1 && link.has_block()) link.block += static_cast<std::uint32_t>(near);
            links.push_back(link);
        }
        blocks.insert(blocks.end(), block.blocks.begin(), block.blocks.end());
        squared_error += block.squared_error, light += block.light, open += block.open;
        rays += block.rays, form_factors += block.form_factors;
        block = {};
    }
    return {Links(sites, std::move(links), std::move(blocks)), std::sqrt(squared_error), light > 0 ? open / light : 1,
            rays, form_factors};
}

}  // namespace exitance
