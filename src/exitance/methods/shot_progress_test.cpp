#include "exitance/solve/shot_progress.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "exitance/methods/solve_scene.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

class KeepsShots final : public ShotProgress {
  public:
    void shot(std::span<const Point> outline, double unshot) override {
        corners.push_back(outline.size()), left.push_back(unshot);
        for (const Point& p : outline) inside &= p.x > -1e-6 && p.x < 2 + 1e-6 && p.z > -1e-6 && p.z < 1 + 1e-6;
    }
    std::vector<std::size_t> corners;
    std::vector<double> left;
    bool inside = true;
};

TEST(ShotProgress, ReceivesEveryPatchThatShoots) {
    SolveOptions options;
    options.method = Method::progressive;
    options.error = 0.2;
    KeepsShots shots;
    const Result<Solution> solution = solve_scene(sample_scene(), options, shots, StopRequest());
    ASSERT_TRUE(solution);
    ASSERT_GT(shots.left.size(), 2u);
    EXPECT_EQ(shots.left.front(), 1);
    EXPECT_LT(shots.left.back(), 0.1);
    EXPECT_TRUE(shots.inside);
    for (const std::size_t n : shots.corners) EXPECT_TRUE(n == 3 || n == 4) << n;
}

}  // namespace
}  // namespace exitance
