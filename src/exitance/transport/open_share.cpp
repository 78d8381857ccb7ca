#include "exitance/transport/open_share.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/transport/element_rays.hpp"
#include "exitance/visibility/shaft.hpp"

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

/// Returns the leaf of the middle of each of 512 strata of equal weight. `weight`: by leaf number.
std::vector<ElementId> leaves_in_strata(const LeafNumbering& numbering, std::span<const double> weight) {
    constexpr std::size_t count = 512;
    const double total = std::accumulate(weight.begin(), weight.end(), 0.0);
    std::vector<ElementId> out;
    double before = 0;
    for (std::size_t i = 0; i < weight.size(); ++i) {
        before += weight[i];
        while (out.size() < count && (static_cast<double>(out.size()) + 0.5) * total <= count * before)
            out.push_back(numbering.leaves[i]);
    }
    return out;
}

}  // namespace

namespace {

/// Estimates open_share() from one stratum in `every`.
double open_share(const Stage& stage, const NumberedLeaves& in, std::span<const Spectrum> radiosity, std::uint64_t seed,
                  std::size_t every) {
    const ElementTree& tree = in.tree;
    const LeafNumbering& numbering = in.numbering;
    struct Light {
        double open = 0, all = 0;
        Light& operator+=(const Light& o) {
            open += o.open, all += o.all;
            return *this;
        }
    };
    const std::vector<ElementId> leaves = leaves_in_strata(numbering, leaf_areas(tree, numbering));
    const Light sum = parallel_sum<Light>(leaves.size() / every, [&](std::size_t i) {
        const std::size_t k = i * every;
        ElementRays rays(stage, tree, in.locator);
        std::uint32_t hit = 0;
        // Leaves use points of one sequence, so that their directions together are stratified.
        rays.cast(leaves[k], hash(seed, static_cast<std::uint64_t>(Stream::rows)), {&hit, 1},
                  static_cast<std::uint32_t>(k));
        if (hit == ElementRays::missed) return Light();
        const double light = mean(radiosity[hit]);
        if (light <= 0) return Light();
        const ElementId p = piece_of(tree, leaves[k]), q = piece_of(tree, numbering.leaves[hit]);
        return Light{is_certainly_open(stage, tree, p, q) ? light : 0, light};
    });
    return sum.all > 0 ? sum.open / sum.all : 1;
}

}  // namespace

double open_share(const Stage& stage, const NumberedLeaves& leaves, std::span<const Spectrum> radiosity,
                  std::uint64_t seed) {
    return open_share(stage, leaves, radiosity, seed, 1);
}

bool is_mostly_open(const Stage& stage, const NumberedLeaves& leaves, std::span<const Spectrum> radiosity,
                    std::uint64_t seed) {
    constexpr std::size_t every = 8;
    constexpr double far_below = 0.2;  // derived from three standard errors of 64 strata
    return open_share(stage, leaves, radiosity, seed, every) > mostly_open - far_below &&
           open_share(stage, leaves, radiosity, seed, 1) > mostly_open;
}

bool is_closed(const Stage& stage, const NumberedLeaves& in, std::uint64_t seed, std::span<const double> power) {
    const LeafNumbering& numbering = in.numbering;
    constexpr std::size_t each = 8;
    const std::vector<ElementId> leaves = power.empty() ? leaves_in_strata(numbering, leaf_areas(in.tree, numbering))
                                                        : leaves_in_strata(numbering, power);
    const double missed = parallel_sum<double>(leaves.size(), [&](std::size_t k) {
        ElementRays rays(stage, in.tree, in.locator);
        std::array<std::uint32_t, each> hits{};
        rays.cast(leaves[k], hash(seed, static_cast<std::uint64_t>(Stream::rows)), hits,
                  static_cast<std::uint32_t>(each * k));
        return static_cast<double>(std::count(hits.begin(), hits.end(), ElementRays::missed));
    });
    return missed == 0;
}

}  // namespace exitance
