#include <gtest/gtest.h>

#include <utility>

#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/links/link_refiner.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// Number of links of an oracle, and RMS error of their light over the surfaces.
struct Outcome {
    std::size_t links = 0;
    double error = 0;
};

/// An empty room; one wall reflects `bright` W/m^2 and the others `dark`.
struct Room {
    Scene scene = box_scene(3, 4, 2.5, 0.5, 1);
    Stage stage{scene};
    double bright = 1, dark = 0.02;

    double light(RegionId region) const { return region.value == 2 ? bright : dark; }

    Outcome linked(LinkOracle oracle, double threshold, std::size_t max_links) const {
        ElementTree tree = stage.make_elements({10, 0});
        const NodalBasis basis(HierarchyBasis::haar);
        LinkSites sites(stage, tree, basis);
        NodalField b(sites);
        for (ElementId e : tree.leaves()) b.set_node(e, 0, Spectrum(light(tree.region(e))));
        LinkRefiner refiner(tree, sites);
        Progress silent;
        const StopRequest never;
        refiner.refine(b, {},
                       {.error = threshold,
                        .interpolation = threshold,
                        .max_links = max_links,
                        .min_area = 0.05,
                        .oracle = oracle,
                        .strongest = threshold},
                       silent, never);
        NodalField E(sites);
        refiner.make_links().gather(b, E);
        E.push();
        double sum = 0;
        for (ElementId e : tree.leaves())
            for (int i = 0; i < 16; ++i) {
                const Point x = tree.patch(e).at({(i % 4 + 0.5) / 4, (i / 4 + 0.5) / 4});
                double exact = 0;
                for (ElementId q : tree.roots())
                    if (tree.region(q) != tree.region(e))
                        exact += light(tree.region(q)) * point_to_polygon(x, sites.normal(e), tree.outline(q));
                sum += tree.area(e) / 16 * std::pow(E.node(e, 0)[0] - exact, 2);
            }
        return {refiner.size(), std::sqrt(sum / stage.area)};
    }

    /// While the threshold falls: the last outcome with at most `links` links, and the first one with more.
    std::pair<Outcome, Outcome> around(LinkOracle oracle, std::size_t links) const {
        Outcome before;
        for (double threshold = 0.5; threshold > 1e-3; threshold *= 0.6) {
            const Outcome now = linked(oracle, threshold, 3 * links);
            if (now.links > links) return {before, now};
            before = now;
        }
        return {before, before};
    }
};

}  // namespace

TEST(LinkOracle, PowerIsBetterThanFormFactorAndErrorIsBetterThanBoth) {
    const Room room;
    // The form factor of adjacent walls is not reduced by splitting. At some threshold their links are split down to
    // the minimum area, so that the number of links jumps. The other oracles may make as many links.
    const Outcome ff = room.around(LinkOracle::form_factor, 2000).second,
                  bf = room.around(LinkOracle::power, ff.links).first,
                  error = room.around(LinkOracle::transport, ff.links).first;
    EXPECT_LE(bf.links, ff.links);
    EXPECT_LE(error.links, ff.links);
    // Errors: 0.038, 0.020 and 0.012 W/m^2, for a mean of 0.2.
    EXPECT_LT(bf.error, 0.7 * ff.error) << bf.links << " " << ff.links;
    EXPECT_LT(error.error, 0.7 * bf.error) << error.links;
}

}  // namespace exitance
