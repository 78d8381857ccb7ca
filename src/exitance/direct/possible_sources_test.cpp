#include "exitance/direct/possible_sources.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"
#include "exitance/visibility/occluders.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

double bound_of(std::span<const PossibleSources::Source> sources, std::uint32_t emitter) {
    double sum = 0;
    for (const auto& s : sources)
        if (s.name.emitter == emitter) sum += s.bound;
    return sum;
}

TEST(PossibleSources, ContainEveryVisibleSourceWithAValidBound) {
    const Scene scene = built_scene("office", {{"nx", "3"}, {"ny", "2"}});
    const Occluders occluders(scene);
    const DirectLight direct(scene, occluders);
    ASSERT_TRUE(PossibleSources::suits(direct));
    const StopRequest stop;
    const PossibleSources possible(direct, 0, stop);
    DirectLight::Workspace workspace;
    RandomStream random(3, Stream::mesh);
    std::size_t shining = 0;
    for (int i = 0; i < 600; ++i) {
        const RegionId r(random.bits() % scene.regions().size());
        const std::span<const Point> outline = scene.outline(scene.regions()[r].surfaces[0]);
        const double a = random.uniform(), b = random.uniform() * (1 - a);
        const Point x = outline[0] + a * (outline[1] - outline[0]) + b * (outline[2] - outline[0]);
        for (std::uint32_t e = 0; e < direct.emitters().size(); ++e) {
            const DirectLight::Emitter& emitter = direct.emitters()[e];
            const double F = direct.form_factor(direct.receiver(x, scene.regions()[r].plane.n, r), emitter, workspace);
            shining += F > 0;
            // Allows for rounding, and for gaps as thin as the rounding at walls.
            EXPECT_LE(F * mean(emitter.exitance), bound_of(possible.of(r), e) * (1 + 1e-9) + 1e-9);
        }
    }
    EXPECT_GT(shining, 500u);
}

TEST(PossibleSources, AreFewBehindTheWallsOfABuilding) {
    const Scene scene = built_scene("office", {{"nx", "4"}, {"ny", "4"}});
    const Occluders occluders(scene);
    const DirectLight direct(scene, occluders);
    const StopRequest stop;
    const PossibleSources all(direct, 0, stop);
    // Each room has four lamps, at most two windows of its own, and four neighbouring rooms.
    std::size_t sum = 0;
    for (const RegionId r : scene.regions().ids()) sum += all.of(r).size();
    const double share =
        static_cast<double>(sum) / static_cast<double>(scene.regions().size() * direct.emitters().size());
    EXPECT_LT(share, 0.25) << "of all pairs; a quarter of the rooms at most";
    // The light additionally dropped is less than the allowed one.
    const double allowed = 0.5;
    const PossibleSources few(direct, allowed, stop);
    for (const RegionId r : scene.regions().ids()) {
        double before = 0, after = 0;
        for (const auto& s : all.of(r)) before += s.bound;
        for (const auto& s : few.of(r)) after += s.bound;
        EXPECT_LE(before - after, allowed * (1 + 1e-9));
    }
}

}  // namespace
}  // namespace exitance
