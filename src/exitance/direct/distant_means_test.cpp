#include "exitance/direct/distant_means.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/mesh/pieces.hpp"
#include "exitance/scene/sky/perez_sky.hpp"
#include "exitance/scene/sky/sun_position.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// Rows of squares of 0.1 m, side by side, whose height is given by height(i, k), and a board above them if
/// `has_board`.
template <class Height>
SceneDescription squares(int along, bool has_board, const Height& height) {
    SceneDescription d;
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.groups = {"squares"};
    const auto add = [&](const Point& o, double side) {
        const auto first = static_cast<std::uint32_t>(d.points.size());
        for (const Vec3& more : {Vec3{}, Vec3{side, 0, 0}, Vec3{side, side, 0}, Vec3{0, side, 0}})
            d.points.push_back(o + more);
        d.faces.push_back({{first, first + 1, first + 2, first + 3}});
    };
    for (int i = 0; i < along; ++i)
        for (int k = 0; k < along; ++k) add({0.12 * i, 0.12 * k, height(i, k)}, 0.1);
    if (has_board) add({0.5, 0.5, 1}, 1);
    return d;
}

/// Means of the elements, and values of exact light at 4 x 4 places of each.
struct Compared {
    std::vector<DistantMeans::Mean> found;
    std::vector<std::vector<double>> exact;
};

Compared compare(SceneDescription d, const LightAccuracy& accuracy) {
    CheckedScene checked = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(checked.scene));
    const Scene& scene = *checked.scene;
    const Occluders occluders(scene);
    const RayTracer tracer(scene);
    const DirectLight direct(scene, occluders);
    EXPECT_TRUE(DistantMeans::suits(direct));
    ElementTree tree;
    for (const Piece& piece : cut_into_pieces(scene)) tree.add_root(piece.region, piece.patch);
    const std::vector<ElementId> elements = tree.leaves();
    Compared out{std::vector<DistantMeans::Mean>(elements.size()), {}};
    DistantMeans::Workspace room;
    DistantMeans(direct, tracer)
        .find(tree, elements, std::vector<LightAccuracy>(elements.size(), accuracy), room, out.found);
    DirectLight::Workspace scratch;
    for (const ElementId e : elements) {
        std::vector<double>& values = out.exact.emplace_back();
        const RegionId region = tree.region(e);
        for (int i = 0; i < 4; ++i)
            for (int k = 0; k < 4; ++k)
                values.push_back(mean(direct.irradiance(tree.patch(e).at({(i + 0.5) / 4, (k + 0.5) / 4}),
                                                        scene.regions()[region].plane.n, region, scratch)));
    }
    return out;
}

double mean_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
}

TEST(DistantMeans, AreThoseOfExactLightOfASky) {
    constexpr LightAccuracy accuracy{.relative = 0.05, .absolute = 1};
    SceneDescription d = squares(12, false, [](int i, int k) { return 0.05 * ((7 * i + 3 * k) % 5); });
    d.distant.domes = {{perez_sky({100, 300, 80}, sky_direction(40, 10)), Spectrum(100.0)}};
    const Compared all = compare(std::move(d), accuracy);
    ASSERT_EQ(all.found.size(), 144u);
    double squares = 0, allowed = 0, difference = 0;
    for (std::size_t i = 0; i < all.found.size(); ++i) {
        ASSERT_TRUE(all.found[i].is_found);
        const double exact = mean_of(all.exact[i]), error = mean(all.found[i].irradiance) - exact;
        const double limit = accuracy.allowed(exact);
        squares += error * error, allowed += limit * limit, difference += error;
    }
    // Variances are at most the squared limit; four standard deviations of a sum of 144 squares are 47% of it.
    EXPECT_LT(squares, 1.47 * allowed);
    EXPECT_LT(std::abs(difference), 4 * std::sqrt(allowed));
}

TEST(DistantMeans, AreNotFoundWhereAShadowOfTheSunEnds) {
    SceneDescription d = squares(20, true, [](int, int) { return 0.0; });
    d.distant.discs.push_back({sky_direction(60, 200), 0.0047, Spectrum(500.0)});
    const Compared all = compare(std::move(d), {.relative = 0.05, .absolute = 1});
    int whole = 0, divided = 0;
    for (std::size_t i = 0; i < all.found.size(); ++i) {
        const auto [least, most] = std::minmax_element(all.exact[i].begin(), all.exact[i].end());
        if (*most - *least < 1e-6 * *most || *most == 0) {  // all lit, or all in the shadow
            // The border may cross a part of the square that none of the places is in.
            if (!all.found[i].is_found) continue;
            whole += 1;
            EXPECT_NEAR(mean(all.found[i].irradiance), *most, 1e-6 * *most) << i;
        } else {
            divided += 1;
            EXPECT_FALSE(all.found[i].is_found) << i;
        }
    }
    EXPECT_GE(divided, 16);  // each side of the shadow crosses 8 squares; two of the four may run between squares
    EXPECT_GT(whole, 300);
}

}  // namespace
}  // namespace exitance
