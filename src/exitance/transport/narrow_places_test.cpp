#include "exitance/transport/narrow_places.hpp"

#include <gtest/gtest.h>

#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// The area of narrow leaves, m^2, of elements about `edge` metres wide.
double narrow_area(const Scene& scene, double edge) {
    const Stage stage(scene);
    const ElementTree tree = stage.make_elements({.edge = edge, .grading_levels = 0});
    const Field<ElementId, std::uint8_t> narrow = find_narrow_leaves(stage, tree);
    double out = 0;
    for (ElementId e : tree.leaves()) out += narrow[e] ? tree.area(e) : 0;
    return out;
}

TEST(NarrowPlaces, AreThoseInGapsThatElementsAreLargerThan) {
    // Both sides of the gaps over the lamp (1 m x 0.5 m) and behind the board (1.8 m x 1 m); between the boxes the
    // smaller one's face (0.7 m x 0.6 m). Elements that reach out of a gap count as a whole.
    const double in_gaps = 2 * (0.5 + 1.8 + 0.42);
    const double area = narrow_area(built_scene("gaps"), 0.25);
    EXPECT_GT(area, 0.9 * in_gaps);
    EXPECT_LT(area, 1.5 * in_gaps);
}

TEST(NarrowPlaces, AreNoneWhereElementsAreSmallerThanTheRoom) {
    EXPECT_EQ(narrow_area(box_scene(2, 1, 1.5, 0.5, 1), 0.5), 0);
    // What stands on the floor touches it: no gap.
    EXPECT_EQ(narrow_area(built_scene("bright"), 0.2), 0);
}

}  // namespace
}  // namespace exitance
