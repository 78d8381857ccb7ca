#include "exitance/visibility/edge_sum.hpp"

#include <gtest/gtest.h>

#include "exitance/direct/direct_light.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

using test::Face;

struct Tally {
    int compared = 0, given_up = 0;
    double worst = 0;
};

/// Compares both methods at random points below the light of a scene.
void compare(std::vector<Face> occluding, std::uint64_t seed, Tally& tally) {
    occluding.push_back({{{-0.5, -0.5, 1.2}, {-0.5, 0.5, 1.2}, {0.5, 0.5, 1.2}, {0.5, -0.5, 1.2}}, 1});
    const Scene scene = test::make(occluding);
    const Occluders occluders(scene);
    const DirectLight light(scene, occluders);
    const PieceId source = light.emitters()[0].pieces.front();
    VisibilityWorkspace scratch;
    RandomStream random(seed, Stream::direct);
    for (int i = 0; i < 20; ++i) {
        const Normal n = normalized(Vec3{0, 0, 0.6} + test::any_in_cube(random));
        const SurfacePoint at{Point{0, 0, -0.8} + test::any_in_cube(random), n, {}};
        const double cut = visible_form_factor(occluders, at, source, scratch, VisiblePartMethod::subtraction);
        if (scratch.source.empty() || scratch.shadows.empty() || cut == 0) continue;
        const double summed = edge_sum(at.n, scratch);
        ++tally.compared;
        tally.given_up += std::isnan(summed);
        if (!std::isnan(summed)) tally.worst = std::max(tally.worst, std::abs(summed - cut));
        EXPECT_NEAR(visible_form_factor(occluders, at, source, scratch, VisiblePartMethod::edge_sums), cut, 1e-12);
    }
}

TEST(EdgeSum, EqualsSubtractionInTriangleSoups) {
    Tally tally;
    for (int trial = 0; trial < 60; ++trial)
        compare(test::triangle_soup(1 + trial, trial % 2 ? 0.3 : 0.9, 400 + trial, {0, 0, 0.5}), trial, tally);
    EXPECT_GT(tally.compared, 600);
    EXPECT_EQ(tally.given_up, 0);
    EXPECT_LT(tally.worst, 1e-13);
}

TEST(EdgeSum, EqualsSubtractionForSolidsWithSharedEdges) {
    RandomStream random(31, Stream::mesh);
    Tally tally;
    for (int trial = 0; trial < 60; ++trial) {
        std::vector<Face> faces;
        for (int box = 0; box <= trial % 6; ++box) {
            const Frame frame(normalized(test::any_in_cube(random)));
            const Point middle = Point{0, 0, 0.5} + 0.8 * test::any_in_cube(random);
            for (Face& face : test::closed_box({-0.1, -0.1, -0.1}, {0.2, 0.15, 0.3})) {
                for (Point& p : face.corners) p = middle + frame.to_world(p.x, p.y, p.z);
                faces.push_back(face);
            }
        }
        compare(faces, 100 + trial, tally);
    }
    EXPECT_GT(tally.compared, 400);
    EXPECT_EQ(tally.given_up, 0);
    EXPECT_LT(tally.worst, 1e-13);
}

TEST(EdgeSum, EqualsSubtractionForCoplanarPiecesWithCoincidentEdges) {
    Tally tally;
    for (int trial = 0; trial < 20; ++trial) {
        std::vector<Face> tiles;  // tiles of different materials, some with a second tile on top
        for (int i = 0; i < 16; ++i) {
            const double x = 0.1 * (i % 4) - 0.2, y = 0.1 * (i / 4) - 0.2, z = 0.3 + 0.02 * trial;
            if ((i * 7 + trial) % 5 == 0) continue;
            tiles.push_back({{{x, y, z}, {x + 0.1, y, z}, {x + 0.1, y + 0.1, z}, {x, y + 0.1, z}}});
            if ((i + trial) % 3 == 0)
                tiles.push_back({{{x, y, z + 0.1}, {x + 0.1, y, z + 0.1}, {x + 0.1, y + 0.1, z}, {x, y + 0.1, z}}});
        }
        compare(tiles, 200 + trial, tally);
    }
    EXPECT_GT(tally.compared, 100);
    EXPECT_LT(tally.given_up, 0.02 * tally.compared);
    EXPECT_LT(tally.worst, 1e-13);
}

}  // namespace
}  // namespace exitance
