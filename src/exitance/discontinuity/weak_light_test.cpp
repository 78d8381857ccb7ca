#include "exitance/discontinuity/weak_light.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

TEST(WeakLight, RmsErrorIsWithinTheRequestedNoise) {
    const Scene scene = built_scene("office", {{"nx", "4"}, {"ny", "3"}, {"nfurn", "2"}});
    const Stage stage(scene);
    ASSERT_TRUE(WeakLight::pays(stage.direct));
    const StopRequest stop;
    const WeakLight::Asked asked{.negligible = 0.1, .noise = 1, .max_noise = 1, .area = 0};
    const WeakLight weak(stage.direct, stage.tracer, asked, stop);
    WeakLight::Workspace room;
    RandomStream random(5, Stream::mesh);
    double sum = 0, squares = 0;
    std::size_t places = 0, lit = 0;
    for (std::size_t i = 0; i < 400; ++i) {
        const Piece& piece = stage.pieces[random.bits() % stage.pieces.size()];
        const RegionId r = piece.region;
        const Normal& n = scene.regions()[r].plane.n;
        const Point x = piece.patch.at(uniform_in_shape(piece.patch.shape, random.uniform(), random.uniform()));
        ReceiverLight strong;
        const std::span<const Point> outline = scene.outline(scene.regions()[r].surfaces[0]);
        if (scene.regions()[r].surfaces.size() > 1 || !is_convex(outline, n)) continue;
        stage.direct.prepare(outline, n, r, weak.strong(r), strong, room.exact);
        const double w = mean(light_weight(scene.material(r)));
        const double off = w * mean(weak.irradiance(strong, x, room) - stage.direct.irradiance(x, n, r, room.exact));
        sum += off, squares += off * off, ++places;
        lit += weak.shines_on(r);
    }
    ASSERT_GT(lit, 100u);
    const double rms = std::sqrt(squares / static_cast<double>(places));
    EXPECT_LT(rms, asked.noise + asked.negligible) << "W/m^2 of w E; the bounds count all of a source as half seen";
    EXPECT_GT(rms, 0) << "some are left to rays";
    EXPECT_LT(std::abs(sum) / static_cast<double>(places), 0.3 * asked.noise) << "off to both sides";
}

TEST(WeakLight, DoesNotPayForFewEmitters) {
    const Scene scene = built_scene("office", {{"nx", "1"}, {"ny", "1"}});
    const Stage stage(scene);
    EXPECT_FALSE(WeakLight::pays(stage.direct));
}

}  // namespace
}  // namespace exitance
