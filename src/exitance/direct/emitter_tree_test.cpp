#include "exitance/direct/emitter_tree.hpp"

#include <gtest/gtest.h>

#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/visibility/occluders.hpp"
#include "support/motion.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// How the normals of lamps differ.
enum class Facing { down, tilted, up_and_down, all_directions };

/// 100 square lamps at steps of a metre in the plane z = 3.
Scene lamps(Facing facing, const Motion& motion = as_written) {
    std::vector<test::Face> faces;
    RandomStream random(2, Stream::direct);
    for (int i = 0; i < 100; ++i) {
        Vec3 n{0, 0, i % 3 == 0 && facing == Facing::up_and_down ? 1.0 : -1.0};
        if (facing == Facing::tilted) n = normalized(Vec3{i % 2 == 0 ? 0.3 : -0.3, 0, -1});
        if (facing == Facing::all_directions) n = normalized(test::any_in_cube(random));
        const Frame frame(n);
        const Point at{i % 10 + 0.5, i / 10 + 0.5, 3};
        const Vec3 u = 0.1 * frame.u, v = 0.1 * frame.v;
        test::Face face{{at - u - v, at + u - v, at + u + v, at - u + v}, 1.0 + i};
        for (Point& p : face.corners) p = motion(p);
        faces.push_back(face);
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
    for (const Facing facing : {Facing::down, Facing::tilted, Facing::up_and_down, Facing::all_directions}) {
        const Scene scene = lamps(facing);
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
    for (const Motion& motion : {as_written, turned_and_moved}) {
        const Scene scene = lamps(Facing::down, motion);
        const Occluders occluders(scene);
        const DirectLight direct(scene, occluders);
        const EmitterTree tree(direct);
        EmitterTree::Cut cut;
        for (const double z : {3.0, 3.01}) {
            tree.cut({motion({5.1, 5.3, z}), motion.turned({0, 0, -1}), {}}, 1e-3, 0, cut);
            ASSERT_EQ(cut.terms.size(), 1u);  // the whole tree, which was not split
            EXPECT_EQ(cut.light, 0);
            EXPECT_EQ(cut.error, 0);
        }
    }
}

}  // namespace
}  // namespace exitance
