#include "exitance/view_factors/ray_check.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/view_factors/entry_factors.hpp"
#include "exitance/view_factors/row_scene.hpp"

namespace exitance {
namespace {

/// Two unit squares facing each other at 1 m, and half-way between them a board that covers half of the view.
Scene squares_with_a_board(bool with_board) {
    SceneDescription d;
    d.materials.push_back({"grey", Spectrum(0.25), Spectrum()});
    d.groups.push_back("all");
    const auto add = [&](double x0, double x1, double z, bool up) {
        std::vector<Point> corners = {{x0, 0, z}, {x1, 0, z}, {x1, 1, z}, {x0, 1, z}};
        if (!up) std::swap(corners[1], corners[3]);
        SceneDescription::Face face;
        for (const Point& p : corners) {
            face.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(p);
        }
        d.faces.push_back(face);
    };
    add(0, 1, 0, true), add(0, 1, 1, false);
    if (with_board) add(-5, 0.5, 0.5, true);
    return *make_scene(d).scene;
}

SparseFactors table_of(const Scene& scene) {
    Progress progress;
    return compute_entry_factors(scene, {.tolerance = 1e-5}, nullptr, progress, StopRequest());
}

// view factor of parallel unit squares at a distance of 1 [Howell]
constexpr double parallel_squares = 0.199824895698387;

TEST(RayCheck, RaysAgreeWithThePublishedFactorWithinTheirErrors) {
    const Scene scene = squares_with_a_board(false);
    const RayEntry found = view_factor_by_rays(RowScene(scene, StopRequest()), 0, 1, 1u << 14, 1);
    EXPECT_NEAR(found.F, parallel_squares, 4 * found.standard_error);
    EXPECT_LT(found.standard_error, 0.01 * parallel_squares);
}

TEST(RayCheck, ACorrectTableIsWithinAFewStandardErrors) {
    const Scene scene = squares_with_a_board(true);
    const RayCheck check = check_by_rays(scene, table_of(scene), {}, StopRequest());
    EXPECT_EQ(check.entries, 2u + 1u * 2u);  // the two squares to each other, the board's front and the upper square
    EXPECT_GE(check.rays, check.entries << 14);
    EXPECT_LT(check.largest_deviation, 4);
    EXPECT_EQ(check.wrong, 0u);
    EXPECT_LT(check.usual_relative_error, 0.01);
    EXPECT_TRUE(check.is_complete);
}

TEST(RayCheck, AWrongEntryIsFound) {
    const Scene scene = squares_with_a_board(true);
    SparseFactors table = table_of(scene);
    table.values[0] *= 1.2;
    const RayCheck check = check_by_rays(scene, table, {}, StopRequest());
    EXPECT_GT(check.largest_deviation, 10);
    EXPECT_NEAR(check.largest_relative, 1 - 1 / 1.2, 0.02);
    EXPECT_EQ(check.wrong, 1u);
    EXPECT_EQ(check_by_rays(scene, table, {.tolerance = 0.2}, StopRequest()).wrong, 0u) << "so much it may be off";
}

TEST(RayCheck, AStopRequestEndsTheCheck) {
    const Scene scene = squares_with_a_board(true);
    StopRequest stop;
    stop.interrupt();
    const RayCheck check = check_by_rays(scene, table_of(scene), {}, stop);
    EXPECT_FALSE(check.is_complete);
    EXPECT_EQ(check.entries, 0u);
}

}  // namespace
}  // namespace exitance
