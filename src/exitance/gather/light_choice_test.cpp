#include "exitance/gather/light_choice.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/visibility/occluders.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// Two furnished rooms under a wavy sheet of emitting triangles.
class LightChoiceBelowASheet : public testing::Test {
  protected:
    const Scene scene = built_scene("carpet", {{"u", "20"}, {"v", "20"}, {"cuts", "1"}, {"books", "0"}});
    const Occluders occluders{scene};
    const DirectLight direct{scene, occluders};
    const LightChoice lights{direct};
    const std::uint32_t count = static_cast<std::uint32_t>(lights.size());
};

TEST_F(LightChoiceBelowASheet, ChoosesEachSourceAsOftenAsItsChanceSays) {
    const Point x{2, 1, 0.5};
    const Normal n{0, 0, 1};
    ASSERT_GT(count, 100u);
    std::vector<double> found(count);
    // choices at equal steps, so that each count is exact to a few steps per level of the tree
    constexpr int draws = 100'000;
    for (int i = 0; i < draws; ++i) {
        const LightChoice::Chosen chosen = lights.choose(x, n, (i + 0.5) / draws);
        ASSERT_DOUBLE_EQ(chosen.chance, lights.chance_of(chosen.number, x, n));
        found[chosen.number] += 1.0 / draws;
    }
    double sum = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
        EXPECT_NEAR(found[k], lights.chance_of(k, x, n), 2.0 / draws);
        sum += lights.chance_of(k, x, n);
    }
    EXPECT_NEAR(sum, 1, 1e-9);
}

TEST_F(LightChoiceBelowASheet, EverySourceThatSendsLightHasAChanceNearItsShare) {
    RandomStream random(5, Stream::mesh);
    for (int i = 0; i < 50; ++i) {
        const Point x{0.2 + 3 * random.uniform(), 0.2 + 3 * random.uniform(), 2 * random.uniform()};
        const Normal n = normalized(Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform()});
        std::vector<double> light(count);
        for (std::uint32_t k = 0; k < count; ++k) {
            const EmitterTree::Source& source = lights.source(k);
            const DirectLight::Emitter& emitter = direct.emitters()[source.name.emitter];
            if (emitter.plane.signed_distance(x) > 0)
                light[k] = point_to_polygon(x, n, occluders.corners(source.name.piece)) * mean(emitter.exitance);
        }
        const double all = std::accumulate(light.begin(), light.end(), 0.0);
        for (std::uint32_t k = 0; k < count; ++k)
            if (light[k] > 0) {
                EXPECT_GT(lights.chance_of(k, x, n), light[k] / all / 20) << "a variance below twenty times the square";
            }
    }
}

TEST_F(LightChoiceBelowASheet, FindsTheSourceOfAPoint) {
    for (std::uint32_t k = 0; k < count; ++k) {
        const EmitterTree::Source& source = lights.source(k);
        EXPECT_EQ(lights.source_at(source.region, centroid(occluders.corners(source.name.piece))), k);
    }
    for (const RegionId r : scene.regions().ids())
        if (!scene.material(r).emits()) {
            EXPECT_FALSE(lights.source_at(r, Point{}));
        }
}

}  // namespace
}  // namespace exitance
