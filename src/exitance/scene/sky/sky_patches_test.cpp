#include "exitance/scene/sky/sky_patches.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/scene/sky/perez_sky.hpp"

namespace exitance {

TEST(SkyPatches, HaveThePublishedNumberAndCoverTheSky) {
    for (const auto& [m, count] : {std::pair{1, 145u}, {2, 577u}, {4, 2305u}}) {
        const SkyPatches patches(m);
        EXPECT_EQ(patches.size(), count + 1);  // and one patch for the ground
        EXPECT_EQ(patches.size(), SkyPatches::count(static_cast<std::size_t>(m)));
        double solid_angle = 0;
        for (std::size_t p = 1; p < patches.size(); ++p) {
            solid_angle += patches.solid_angle(p);
            EXPECT_EQ(patches.of(patches.middle(p)), p);
        }
        EXPECT_NEAR(solid_angle, 2 * pi, 1e-9);
    }
    EXPECT_EQ(SkyPatches(1).of({0, 0, -1}), 0u);
}

TEST(SkyPatches, EveryDirectionMeetsOneFacetOfItsPatch) {
    const SkyPatches patches(1);
    RandomStream random(1, Stream::reference, 0);
    int beside = 0;
    for (int i = 0; i < 2000; ++i) {
        const double z = 2 * random.uniform() - 1, phi = 2 * pi * random.uniform(), r = std::sqrt(1 - z * z);
        const Vec3 w{r * std::cos(phi), r * std::sin(phi), z};
        int met = 0;
        for (std::size_t f = 0; f < patches.facets().size(); ++f) {
            const DistantFacet& facet = patches.facets()[f];
            bool inside = dot(facet.n, w) < 0;
            for (std::size_t k = 0; k < facet.corners.size() && inside; ++k)
                inside = dot(cross(facet.corners[(k + 1) % facet.corners.size()], facet.corners[k]), w) > 0;
            if (!inside) continue;
            ++met;
            // Edges of facets are great circles, borders of rows are not.
            beside += patches.patch_of_facet()[f] != patches.of(w);
        }
        EXPECT_EQ(met, 1) << i;
    }
    EXPECT_LT(beside, 40);
}

TEST(SkyPatches, MeansOfASkyGiveItsIrradiance) {
    const SkyPatches patches(2);
    const SkyModel sky = cie_sky(12, Normal{0.6, 0, 0.8});
    const std::vector<double> means = patches.mean_values(sky);
    double horizontal = 0;
    for (std::size_t p = 1; p < patches.size(); ++p) horizontal += means[p] * patches.horizontal(p);
    // The mean ignores that cosine and sky vary together within a patch.
    EXPECT_NEAR(horizontal * sky.scale / pi, 1, 2e-3);
}

TEST(SkyPatches, UnscaledSkiesDifferFromScaledOnesByTheirScale) {
    const PerezInput input{120, 500, 100};
    const Normal sun{0.6, 0, 0.8};
    const SkyModel scaled = perez_sky(input, sun), unscaled = unscaled_perez_sky(input, sun);
    EXPECT_EQ(unscaled.scale, 1);
    const SkyPatches patches(1);
    const std::vector<double> a = patches.mean_values(scaled), b = patches.mean_values(unscaled);
    for (std::size_t p = 0; p < patches.size(); ++p) EXPECT_EQ(a[p], b[p]);
}

}  // namespace exitance
