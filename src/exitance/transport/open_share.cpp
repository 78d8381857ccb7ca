#include "exitance/transport/open_share.hpp"

#include "exitance/core/parallel.hpp"
#include "exitance/transport/shaft.hpp"

namespace exitance {
namespace {

ElementId piece_of(const ElementTree& tree, ElementId e) {
    while (!tree.parent(e).is_none()) e = tree.parent(e);
    return e;
}

bool is_certainly_open(const Stage& stage, const ElementTree& tree, ElementId p, ElementId q) {
    Shaft shaft;
    std::vector<PieceId> candidates;
    const std::vector<Point> from = tree.outline(p), to = tree.outline(q);
    const auto facet = [&](std::span<const Point> outline, ElementId e) {
        return Facet{outline, stage.scene.regions()[tree.region(e)].plane.n, tree.region(e)};
    };
    shaft.set(stage.occluders, facet(from, p), facet(to, q));
    return shaft.classify(candidates) == View::open;
}

}  // namespace

double open_share(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering, const RayRows& rows,
                  std::span<const Spectrum> radiosity) {
    struct Light {
        double open = 0, all = 0;
        Light& operator+=(const Light& o) {
            open += o.open, all += o.all;
            return *this;
        }
    };
    constexpr std::size_t samples = 512;
    const std::size_t leaves = numbering.leaves.size();
    const Light sum = parallel_sum<Light>(samples, [&](std::size_t k) {
        // Some leaf, and one of its rays.
        const std::size_t i = (2 * k + 1) * leaves / (2 * samples);
        const std::span<const std::uint32_t> hits = rows.hits(i);
        const std::uint32_t hit = hits[k % hits.size()];
        if (hit == RayRows::missed) return Light();
        const double light = tree.area(numbering.leaves[i]) * mean(radiosity[hit]);
        if (light <= 0) return Light();
        const ElementId p = piece_of(tree, numbering.leaves[i]), q = piece_of(tree, numbering.leaves[hit]);
        return Light{is_certainly_open(stage, tree, p, q) ? light : 0, light};
    });
    return sum.all > 0 ? sum.open / sum.all : 1;
}

}  // namespace exitance
