#include "exitance/methods/light/light_functions.hpp"

#include <gtest/gtest.h>

#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// A furnace, B = M / (1 - rho): direct light, a method's light and gathered light on the same elements. The back of a
/// sheet in it takes a share of the light.
struct Furnace {
    static constexpr double rho = 0.5;
    Scene scene;
    Stage stage{scene};
    DirectProjection direct{stage.make_elements({.edge = 0.5, .grading_levels = 0}), {}};
    GlobalLight light;
    ElementFunction gathered;
    LostLight lost;

    /// `kept`: arriving share of its light; `wrong`: factor by which the gathered light is off.
    Furnace(double kept, double wrong) : scene(room(kept)) {
        light.tree = direct.tree, light.numbering = LeafNumbering(light.tree);
        const std::size_t n = light.numbering.leaves.size();
        light.kept.assign(n, kept);
        light.reflected.assign(n, Spectrum(rho / (1 - rho)));
        direct.fit.resize(direct.tree.size());
        gathered.tree = direct.tree, gathered.first_value.resize(gathered.tree.size(), 0);
        for (ElementId e : direct.tree.leaves()) {
            direct.fit[e].mean = Spectrum(kept);  // light of emitters with exitance M = 1
            direct.fit[e].corners.fill(direct.fit[e].mean);
            gathered.first_value[e] = static_cast<std::uint32_t>(gathered.values.size());
            for (int i = 0; i < 4; ++i) gathered.add_value(Spectrum(wrong * exact(kept)));
        }
        lost = find_lost_light(stage, light, 1);
    }
    /// A box with a tilted sheet that has the share 1 - `kept` of the area. All that its back meets is as bright as all
    /// else, so that it takes that share of the light.
    static Scene room(double kept) {
        SceneDescription d = box_description(2, 1, 1.5, rho, 1, 1);
        constexpr double walls = 2 * (2 * 1 + 2 * 1.5 + 1 * 1.5), slope = 0.4, width = 0.9;
        const double x = walls * (1 - kept) / kept / width / 2 * std::cos(slope), z = x * std::tan(slope);
        const auto first = static_cast<std::uint32_t>(d.points.size());
        for (const auto& [i, k] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
            d.points.push_back({1 + i * x, 0.5 + k * width / 2, 0.75 + i * z});
        if (kept < 1) d.faces.push_back({{first, first + 1, first + 2, first + 3}, 0, 0, 7});
        return *make_scene(std::move(d)).scene;
    }
    /// E_ind = k rho (E_dir + E_ind).
    static double exact(double kept) { return kept * rho * kept / (1 - kept * rho); }

    double after_keeping() {
        keep_flux(gathered, scene, direct, lost, Spectrum());
        return static_cast<double>(gathered.values[0][0]);
    }
};

TEST(KeepEmittedFlux, ScalesProjectedLightToTheEmittedFluxInClosedScenes) {
    Furnace furnace(1, 1);
    for (DirectFit& fit : furnace.direct.fit) fit.mean = Spectrum(0.99);
    EXPECT_NEAR(keep_emitted_flux(furnace.direct, furnace.stage, 1)[0], 1 / 0.99, 1e-12);
    for (ElementId e : furnace.direct.tree.leaves()) EXPECT_NEAR(furnace.direct.fit[e].mean[0], 1, 1e-12);
}

TEST(KeepEmittedFlux, DoesNothingInOpenScenes) {
    const Scene scene = built_scene("spiral");
    const Stage stage(scene);
    DirectProjection direct{stage.make_elements({.edge = 1, .grading_levels = 0}), {}};
    direct.fit.resize(direct.tree.size());
    for (ElementId e : direct.tree.leaves()) direct.fit[e].mean = Spectrum(0.1);
    EXPECT_EQ(keep_emitted_flux(direct, stage, 1)[0], 1);
}

TEST(KeepFlux, ScalesGatheredLightToTheArrivingFlux) {
    for (const double kept : {1.0, 0.99})
        for (const double wrong : {0.99, 1.0, 1.02})
            EXPECT_NEAR(Furnace(kept, wrong).after_keeping(), Furnace::exact(kept), 1e-6) << kept << " " << wrong;
}

TEST(KeepFlux, IncludesTheGatheredShareOfDirectLight) {
    Furnace furnace(1, 1.01);
    // All of M is gathered instead of direct light: E = rho E + M.
    for (std::array<float, bands>& value : furnace.gathered.values) value.fill(2.02f);
    keep_flux(furnace.gathered, furnace.scene, furnace.direct, furnace.lost, Spectrum(1.0));
    EXPECT_NEAR(furnace.gathered.values[0][0], 2, 1e-6);
}

TEST(ArrivingPower, IsTheKeptPartOfTheSentPower) {
    const Furnace furnace(0.99, 1);
    const ElementFunction two[] = {furnace.gathered, furnace.gathered};
    const double each = furnace.stage.area * Furnace::exact(0.99);
    EXPECT_NEAR(power(furnace.gathered)[0], each, 1e-6 * each);
    EXPECT_NEAR(arriving_power(furnace.scene, furnace.lost, two)[0], 0.99 * 2 * each, 1e-6 * each);
    const Furnace open(0.9, 1);
    EXPECT_EQ(arriving_power(open.scene, open.lost, two)[0], 0) << "of what escapes few rays tell";
}

TEST(KeepFlux, DoesNothingIfMuchEscapesOrTheErrorIsLarge) {
    EXPECT_NEAR(Furnace(0.9, 1.02).after_keeping(), 1.02 * Furnace::exact(0.9), 1e-6);
    EXPECT_NEAR(Furnace(1, 1.2).after_keeping(), 1.2 * Furnace::exact(1), 1e-6);
}

TEST(DeliveredFunctions, SumToTheLightThatRaysRead) {
    Furnace furnace(1, 1);
    for (ElementId e : furnace.direct.tree.leaves()) furnace.direct.fit[e].corners.fill(Spectrum(0.7));
    const Spectrum weight(0.75), c(0.25);
    const DeliveredLight rays(furnace.scene, furnace.gathered, furnace.direct, weight, c);
    const auto parts = delivered_functions(furnace.scene, furnace.gathered, furnace.direct, weight, c);
    for (ElementId e : furnace.direct.tree.leaves()) {
        const Vec2 uv = {0.3, 0.6};
        Spectrum sum;
        for (const ElementFunction& part : parts) sum += part.at({e, uv});
        const RayEnd hit = {furnace.direct.tree.patch(e).at(uv), furnace.direct.tree.region(e)};
        Spectrum read;
        rays.read({&hit, 1}, {&read, 1});
        EXPECT_NEAR(sum[0], read[0], 1e-6);
    }
}

TEST(AllowedByRoom, IsTheLightOfARoomUpToACap) {
    const Scene scene = built_scene("keyhole");
    Stage stage(scene);
    const StopRequest stop;
    stage.rooms = find_light_rooms(stage, 1, stop);
    ASSERT_EQ(stage.rooms.count(), 2u);
    const double small = stage.rooms.area(1) / stage.area;
    const auto of_all = [&](const std::vector<double>& e) { return (1 - small) * e[0] * e[0] + small * e[1] * e[1]; };
    // The small room has almost all light: an error in proportion to it would be four times that of the whole.
    const std::vector<double> uneven = {0.02, (1 - 0.02 * (1 - small)) / small};
    const std::vector<double> capped = allowed_by_room(stage, uneven, 1.5);
    EXPECT_DOUBLE_EQ(capped[0], uneven[0]);
    EXPECT_LT(capped[1], 0.5 * uneven[1]);
    EXPECT_NEAR(of_all(capped), 1.5, 1e-12);
    // If rooms are similar, errors may be in proportion to their light.
    const std::vector<double> even = {1.01, 0.9};
    EXPECT_EQ(allowed_by_room(stage, even, 1.5), even);
    EXPECT_TRUE(allowed_by_room(stage, {}, 1.5).empty());
}

}  // namespace
}  // namespace exitance
