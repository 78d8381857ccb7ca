#include "exitance/gather/lost_light.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/motion.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A box of 2 x 1 x 1.5 m with its ceiling or without, and a tilted sheet in it whose back faces the floor.
Scene box(bool with_ceiling, bool with_sheet, const Motion& motion) {
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {2, 1, 1.5});
    if (!with_ceiling)
        std::erase_if(faces, [](const test::Face& face) {
            return std::all_of(face.corners.begin(), face.corners.end(), [](const Point& p) { return p.z > 1; });
        });
    if (with_sheet) faces.push_back({{{0.9, 0.4, 0.7}, {1.2, 0.4, 0.8}, {1.2, 0.6, 0.8}, {0.9, 0.6, 0.7}}});
    for (test::Face& face : faces)
        for (Point& p : face.corners) p = motion(p);
    return test::make(faces);
}

/// Light of radiosity 1 that is lost, over the area through which it is lost. `uneven`: the rays are distributed as if
/// the elements of the left half were ten times as bright.
double lost_share(const Scene& scene, double area, bool uneven, const Motion& motion) {
    const Stage stage(scene);
    const ElementTree tree = stage.make_elements({.edge = 0.4 * motion.scale, .grading_levels = 0});
    const LeafNumbering numbering(tree);
    std::vector<double> power = leaf_areas(tree, numbering);
    const double middle = scene.box().centre().y;
    for (std::size_t i = 0; i < power.size(); ++i)
        if (uneven && tree.patch(numbering.leaves[i]).centre().y < middle) power[i] *= 10;
    const LostLight lost(stage, tree, numbering, power, 1);
    return lost.uniform_power([](RegionId) { return Spectrum(1.0); })[0] / area;
}

TEST(LostLight, IsWhatTheBackOfASheetTakes) {
    // All that the back meets is a front of radiosity 1, so that rays from the back have no noise.
    for (const Motion& motion : {as_written, turned_and_moved})
        for (const bool uneven : {false, true}) {
            const double area = 0.2 * std::hypot(0.3, 0.1) * motion.scale * motion.scale;
            EXPECT_NEAR(lost_share(box(true, true, motion), area, uneven, motion), 1, 1e-3);
        }
}

TEST(LostLight, IsWhatLeavesThroughAnOpening) {
    // Four standard errors of 2^15 rays, of which at least a tenth leave, with weights of up to ten to one.
    const double tolerance = 4 * std::sqrt(10 / (0.1 * (1 << 15)));
    for (const Motion& motion : {as_written, turned_and_moved})
        for (const bool uneven : {false, true})
            EXPECT_NEAR(lost_share(box(false, false, motion), 2 * motion.scale * motion.scale, uneven, motion), 1,
                        uneven ? tolerance : tolerance / 3);
}

TEST(LostLight, IsZeroInAClosedBox) {
    EXPECT_EQ(lost_share(box(true, false, as_written), 1, false, as_written), 0);
}

}  // namespace
}  // namespace exitance
