#include "exitance/view_factors/face_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/samples/generate.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {
namespace {

std::vector<double> random_values(std::size_t count, std::uint64_t seed) {
    RandomStream random(seed, Stream::reference);
    std::vector<double> values(count);
    for (double& value : values) value = random.uniform();
    return values;
}

TEST(FaceTree, NodesAreHalvedUntilTheyAreFaces) {
    for (const std::uint32_t n : {0u, 1u, 2u, 3u, 7u, 100u}) {
        std::vector<std::uint32_t> order(n);
        for (std::uint32_t k = 0; k < n; ++k) order[k] = (3 * k + 1) % std::max(n, 1u);
        const FaceTree tree(order);
        EXPECT_EQ(tree.nodes(), n > 0 ? n - 1 : 0);
        for (std::size_t k = 0; k < tree.nodes(); ++k) {
            const FaceTree::Range range = tree.range(k);
            ASSERT_GE(range.size(), 2u);
            if (range.middle() - range.first > 1) {
                EXPECT_EQ(tree.range(FaceTree::first_child(k)).first, range.first);
                EXPECT_EQ(tree.range(FaceTree::first_child(k)).last, range.middle());
            }
            if (range.last - range.middle() > 1) {
                EXPECT_EQ(tree.range(tree.second_child(k)).first, range.middle());
                EXPECT_EQ(tree.range(tree.second_child(k)).last, range.last);
            }
        }
    }
}

TEST(FaceTree, SumsAreThoseOfTheFacesAndHandingDownIsTheirAdjoint) {
    const Scene scene = *make_scene(*generate_scene("complex", {{"m", "6"}})).scene;
    const std::vector<ViewFace> faces = make_view_faces(scene);
    const FaceTree tree(faces);
    const std::vector<double> x = random_values(tree.size(), 1), y = random_values(tree.nodes(), 2);
    std::vector<double> sums(tree.nodes()), handed = y, received(tree.size());
    tree.sum_up(x, sums);
    double forward = 0, backward = 0;
    for (std::size_t k = 0; k < tree.nodes(); ++k) {
        double sum = 0;
        for (std::uint32_t p = tree.range(k).first; p < tree.range(k).last; ++p) sum += x[tree.order()[p]];
        EXPECT_NEAR(sums[k], sum, 1e-12 * sum);  // rounding of up to 167 terms
        forward += sums[k] * y[k];
    }
    tree.hand_down(handed, received);
    for (std::size_t j = 0; j < tree.size(); ++j) backward += x[j] * received[j];
    EXPECT_NEAR(forward, backward, 1e-12 * forward);
}

/// Floors and undersides of tables next to each other must not share small nodes.
TEST(FaceTree, SmallNodesHaveOneDirection) {
    const Scene scene = *make_scene(*generate_scene("complex", {{"m", "36"}})).scene;
    const std::vector<ViewFace> faces = make_view_faces(scene);
    const FaceTree tree(faces);
    std::size_t small = 0, mixed = 0;
    for (std::size_t k = 0; k < tree.nodes(); ++k) {
        if (tree.range(k).size() > 4) continue;
        ++small;
        const auto members = tree.order().subspan(tree.range(k).first, tree.range(k).size());
        mixed += std::any_of(members.begin(), members.end(),
                             [&](std::uint32_t j) { return dot(faces[j].plane.n, faces[members[0]].plane.n) < 0.5; });
    }
    EXPECT_GT(small, 300u);
    EXPECT_LT(mixed, small / 20);  // medians cut a group of one direction here and there
}

}  // namespace
}  // namespace exitance
