#include "exitance/methods/hierarchical/hierarchical.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/mesh/element_locator.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "support/built_scene.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

/// RMS difference of indirect light, relative to its mean, at the centres of the leaves of `g`.
double relative_difference(const Solution& f, const Solution& g) {
    const ElementTree& tree = g.indirect.tree;
    const ElementLocator locator(f.indirect.tree, f.scene.regions().size());
    double square = 0, light = 0, area = 0;
    for (ElementId e : tree.leaves()) {
        const Vec2 uv = tree.centre(e);
        const double expected = mean(g.indirect.at({e, uv})),
                     d = mean(f.indirect.at(locator.find(tree.region(e), tree.patch(e).at(uv)))) - expected;
        square += tree.area(e) * d * d, light += tree.area(e) * expected, area += tree.area(e);
    }
    return std::sqrt(square / area) / (light / area);
}

/// No rays correct the links and no gather smooths their light: their errors are visible, and fall with the tolerance.
TEST(Hierarchy, ErrorOfLinksFallsWithTheirTolerance) {
    const Scene scene = built_scene("cornell");
    const Solution reference = solved(scene, {.method = Method::matrix, .error = 0.01});
    for (const BasisKind basis : {BasisKind::haar, BasisKind::multiwavelet2, BasisKind::multiwavelet3}) {
        SolveOptions options{.method = Method::wavelet, .basis = basis};
        options.smoothing = false;
        options.epsilon = 0.1;
        const double coarse = relative_difference(solved(scene, options), reference);
        options.epsilon = 0.025;
        const double fine = relative_difference(solved(scene, options), reference);
        // Reflections multiply the links' errors, and constant elements have errors within their leaves as well.
        EXPECT_LT(fine, (basis == BasisKind::haar ? 4 : 2) * *options.epsilon) << static_cast<int>(basis);
        EXPECT_LT(fine, 0.6 * coarse) << static_cast<int>(basis);
    }
}

/// Counts how often a solve estimates its error.
class CountsAttempts final : public Progress {
  public:
    void phase(std::string_view name) override { count += name == "certify"; }
    int count = 0;
};

/// The floor below a floating box is lit only by the box's underside, which is dark until the floor lights it. Links
/// must not be accepted before that. (Attempts whose links missed it were off by 1.0 and 1.2%.)
TEST(Hierarchy, FindsLightOfSeveralReflections) {
    const Scene scene = built_scene("boxes");
    const StopRequest never;
    for (const BasisKind basis : {BasisKind::multiwavelet2, BasisKind::multiwavelet3}) {
        SolveOptions options{.method = Method::wavelet, .basis = basis, .error = 0.005};
        options.smoothing = false;
        CountsAttempts attempts;
        const Result<Solution> solution = solve_scene(scene, options, attempts, never);
        ASSERT_TRUE(solution);
        EXPECT_TRUE(solution->statistics.converged);
        EXPECT_EQ(attempts.count, 1) << static_cast<int>(basis);
    }
}

TEST(Hierarchy, DetectsLinksThatExceedMemory) {
    SolveOptions options;
    EXPECT_FALSE(links_outgrow_memory(100'000, options)) << "no limit is given";
    options.memory_limit_bytes = 300'000'000;
    EXPECT_FALSE(links_outgrow_memory(977, options));   // 72 MB
    EXPECT_TRUE(links_outgrow_memory(5'405, options));  // 2.2 GB
}

}  // namespace
}  // namespace exitance
