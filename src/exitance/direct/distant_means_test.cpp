#include "exitance/direct/distant_means.hpp"

#include <gtest/gtest.h>

#include "exitance/mesh/pieces.hpp"
#include "exitance/scene/sky/perez_sky.hpp"
#include "exitance/scene/sky/sun_position.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// Small squares at several heights below a sky.
Scene squares_under_sky() {
    SceneDescription d;
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.groups = {"squares"};
    for (int i = 0; i < 20; ++i)
        for (int k = 0; k < 20; ++k) {
            const auto first = static_cast<std::uint32_t>(d.points.size());
            const Point o{0.12 * i, 0.12 * k, 0.05 * ((7 * i + 3 * k) % 5)};
            for (const Vec3& more : {Vec3{}, Vec3{0.1, 0, 0}, Vec3{0.1, 0.1, 0}, Vec3{0, 0.1, 0}})
                d.points.push_back(o + more);
            d.faces.push_back({{first, first + 1, first + 2, first + 3}});
        }
    d.distant.domes = {{perez_sky({100, 300, 80}, sky_direction(40, 10)), Spectrum(100.0)}};
    CheckedScene checked = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

TEST(DistantMeans, AreThoseOfExactLight) {
    const Scene scene = squares_under_sky();
    const Occluders occluders(scene);
    const RayTracer tracer(scene);
    const DirectLight direct(scene, occluders);
    ASSERT_TRUE(DistantMeans::suits(direct));
    ElementTree tree;
    for (const Piece& piece : cut_into_pieces(scene)) tree.add_root(piece.region, piece.patch);
    const std::vector<ElementId> elements = tree.leaves();
    ASSERT_GT(elements.size(), 100u);
    const std::vector<LightAccuracy> accuracy(elements.size(), LightAccuracy{.relative = 0.05, .absolute = 1});
    std::vector<DistantMeans::Mean> found(elements.size());
    DistantMeans::Workspace room;
    DistantMeans(direct, tracer).find(tree, elements, accuracy, room, found);
    DirectLight::Workspace scratch;
    double squares = 0, allowed = 0, difference = 0, all = 0;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        if (!found[i].is_found) continue;
        const RegionId region = tree.region(elements[i]);
        const double exact =
            mean(direct.irradiance(tree.patch(elements[i]).centre(), scene.regions()[region].plane.n, region, scratch));
        const double error = mean(found[i].irradiance) - exact;
        squares += error * error, difference += error, all += exact, allowed += std::pow(0.05 * exact + 1, 2);
    }
    // The light also varies over a square, so that its centre differs from the mean.
    EXPECT_LT(squares, 4 * allowed);
    EXPECT_LT(std::abs(difference), 0.02 * all);
}

}  // namespace
}  // namespace exitance
