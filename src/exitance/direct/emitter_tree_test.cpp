#include "exitance/direct/emitter_tree.hpp"

#include <gtest/gtest.h>

#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/visibility/occluders.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// 100 square lamps at steps of a metre in the plane z = 3, turned by `tilt` and -`tilt` radians in turn, with their
/// fronts downwards.
Scene lamps(double tilt) {
    std::vector<test::Face> faces;
    for (int i = 0; i < 100; ++i) {
        const Point at{i % 10 + 0.5, i / 10 + 0.5, 3};
        const double angle = i % 2 == 0 ? tilt : -tilt;
        const Vec3 u = 0.1 * Vec3{std::cos(angle), 0, std::sin(angle)}, v{0, 0.1, 0};
        faces.push_back({{at - u - v, at - u + v, at + u + v, at + u - v}, 1.0 + i});
    }
    return test::make(faces);
}

/// Sum over all lamps, W/m^2.
double light_of_all(const DirectLight& direct, const SurfacePoint& at) {
    double sum = 0;
    for (const DirectLight::Emitter& emitter : direct.emitters())
        for (PieceId piece : emitter.pieces)
            if (emitter.plane.signed_distance(at.x) > 0)
                sum += mean(emitter.exitance) * point_to_polygon(at.x, at.n, direct.occluders().corners(piece));
    return sum;
}

TEST(EmitterTree, CutsWithoutErrorGiveTheLightOfAllLamps) {
    for (const double tilt : {0.0, 0.3}) {
        const Scene scene = lamps(tilt);
        const Occluders occluders(scene);
        const DirectLight direct(scene, occluders);
        const EmitterTree tree(direct);
        EmitterTree::Cut cut;
        RandomStream random(1, Stream::direct);
        for (int k = 0; k < 1000; ++k) {
            // above the lamps, among them and below them, facing any direction
            const Point x = Point{5, 5, 3} + 12 * test::any_in_cube(random);
            const Normal n = normalized(test::any_in_cube(random));
            tree.cut({x, n, {}}, 0, 0, cut);
            EXPECT_NEAR(cut.light, light_of_all(direct, {x, n, {}}),
                        1e-9 * light_of_all(direct, {x, {0, 0, 1}, {}}) + 1e-9);
            EXPECT_EQ(cut.error, 0);
        }
    }
}

TEST(EmitterTree, PlacesBesideAndBehindLampsInOnePlaneNeedNoSearch) {
    const Scene scene = lamps(0);
    const Occluders occluders(scene);
    const DirectLight direct(scene, occluders);
    const EmitterTree tree(direct);
    EmitterTree::Cut cut;
    const SurfacePoint beside{{5.1, 5.3, 3}, {0, 0, -1}, {}}, behind{{5.1, 5.3, 3.01}, {0, 0, -1}, {}};
    for (const SurfacePoint& at : {beside, behind}) {
        tree.cut(at, 1e-3, 0, cut);
        ASSERT_EQ(cut.terms.size(), 1u);  // the whole tree, which was not split
        EXPECT_EQ(cut.light, 0);
        EXPECT_EQ(cut.error, 0);
    }
}

}  // namespace
}  // namespace exitance
