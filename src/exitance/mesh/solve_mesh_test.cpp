#include "exitance/mesh/solve_mesh.hpp"

#include <gtest/gtest.h>

#include "exitance/mesh/adaptive.hpp"
#include "exitance/transport/stage.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

TEST(SolveMesh, IsIndependentOfOrientationIfLengthsAreMultiplesOfTheEdge) {
    const Scene table = built_scene("table");
    const std::vector<Piece> pieces = Stage(table).pieces;
    const auto leaves = [](const Scene& scene, double edge) {
        const Stage stage(scene);
        return make_mesh(stage.pieces, stage.concave, {.edge = edge, .grading_levels = 2}).leaves().size();
    };
    const std::size_t as_it_is = leaves(table, 0.4);
    const std::size_t predicted = predict_elements(pieces, 0.4);
    for (const char* rot : {"31.7,0.3,0.5,1", "90,0,0,1", "211,-2,0.1,0.7"})
        for (const auto& more : {std::pair("shift", "1000,370,-210"), {"shift", "0,0,0"}}) {
            const Scene scene = built_scene("table", {{"rot", rot}, more});
            EXPECT_EQ(leaves(scene, 0.4), as_it_is) << rot << " " << more.second;
            EXPECT_EQ(predict_elements(Stage(scene).pieces, 0.4), predicted) << rot << " " << more.second;
        }
    EXPECT_EQ(leaves(built_scene("table", {{"rot", "31.7,0.3,0.5,1"}, {"scale", "0.001"}}), 0.0004), as_it_is);
}

TEST(RefineElement, SplitsAThreeToTwoParallelogramTheSameInEveryOrientation) {
    const double rounding = 1e-12;
    for (const double length : {3 - rounding, 3.0, 3 + rounding}) {
        ElementTree tree;
        const ElementId root =
            tree.add_root(RegionId(0u), {{0, 0, 0}, {length, 0, 0}, {0, 2, 0}, Patch::Shape::parallelogram});
        EXPECT_EQ(refine_element(tree, root).size(), 4u) << length - 3;
    }
}

}  // namespace
}  // namespace exitance
