#include "exitance/measure/measuring_grid.hpp"

#include <gtest/gtest.h>

#include "exitance/error/error_percentile.hpp"
#include "exitance/evaluate/surface_levels.hpp"
#include "support/built_scene.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

/// A box whose faces all emit 1 W/m^2, with E = factor / (1 - rho), all of it in the elements.
Solution furnace(double rho, double factor = 1) {
    Solution s;
    s.scene = box_scene(1, 2, 1, rho, 1, 1);
    s.indirect = sample_function(s.scene, 1, 20);
    for (auto& value : s.indirect.values) value.fill(static_cast<float>(factor / (1 - rho)));
    s.interpolant = s.indirect;
    s.direct_in_elements = true;
    return s;
}

GridLight grid_of(const MeasuringPlane& plane) {
    Result<GridLight> grid = make_grid(plane);
    EXI_CHECK(static_cast<bool>(grid));
    return std::move(*grid);
}

TEST(MeasuringGrid, SpacingIsThatOfTheStandard) {
    // EN 12464-1, table A.1: lengths and spacings, metres; the table has rounded values.
    for (const auto& [d, p] : {std::pair{1.0, 0.2}, {2.0, 0.3}, {5.0, 0.6}, {10.0, 1.0}, {25.0, 2.0}, {50.0, 3.0}})
        EXPECT_NEAR(en_12464_spacing(d, d), p, 0.09 * p) << d;
    EXPECT_EQ(en_12464_spacing(10, 2), en_12464_spacing(2, 2));
    EXPECT_EQ(en_12464_spacing(3, 2), en_12464_spacing(3, 3));
}

TEST(MeasuringGrid, PointsAreAtTheCentresOfEqualCellsWithinTheMargin) {
    const GridLight grid = grid_of({{1, 2, 3}, {0, 4, 0}, {0, 0, 2}, 0.5, 0.25});
    ASSERT_EQ(grid.columns, 7);
    ASSERT_EQ(grid.rows, 3);
    EXPECT_NEAR(norm(grid.n - Normal{1, 0, 0}), 0, 1e-15);
    EXPECT_NEAR(norm(grid.points[0] - Point{1, 2.5, 3.5}), 0, 1e-12);
    EXPECT_NEAR(norm(grid.points.back() - Point{1, 5.5, 4.5}), 0, 1e-12);
    EXPECT_NEAR(norm(grid.points[7] - Point{1, 2.5, 4.0}), 0, 1e-12);  // second row
}

TEST(MeasuringGrid, RefusesPlanesThatCannotBeMeasured) {
    EXPECT_FALSE(make_grid({{}, {1, 0, 0}, {2, 0, 0}, 0.1}));
    EXPECT_FALSE(make_grid({{}, {0, 0, 0}, {0, 1, 0}, 0.1}));
    EXPECT_FALSE(make_grid({{}, {1, 0, 0}, {0, 1, 0}, 0.1, 0.5}));
    EXPECT_FALSE(make_grid({{}, {1, 0, 0}, {0, 1, 0}, 0.1, -1}));
    EXPECT_FALSE(make_grid({{}, {1, 0, 0}, {0, 1, 0}, 1e-9}));
    EXPECT_FALSE(make_grid({{std::nan(""), 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}));
}

TEST(MeasuringGrid, AgreesWithProbe) {
    const Solution s = sample_solution();
    const RadiosityFunction light(s);
    Progress progress;
    const StopRequest stop;
    GridLight grid = grid_of({{0.1, 0.1, 0}, {1.8, 0, 0}, {0, 0.8, 0}, 0.3});
    measure(light, grid, progress, stop);
    std::vector<ProbePoint> points;
    for (const Point& p : grid.points) points.push_back({p, grid.n});
    const std::vector<Light> expected = light.at(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_TRUE(grid.is_open[i]);
        EXPECT_EQ(grid.irradiance[i], expected[i].irradiance);
    }
}

TEST(MeasuringGrid, LevelsAreComputedFromTheValues) {
    const Levels levels = levels_of(std::array<double, 3>{2, 4, 6});
    EXPECT_EQ(levels.mean, 4);
    EXPECT_EQ(levels.uniformity(), 0.5);
    EXPECT_EQ(levels.diversity(), 2.0 / 6);
    EXPECT_EQ(levels_of({}).count, 0u);
    EXPECT_EQ(levels_of({}).uniformity(), 0);
}

TEST(SurfaceLevels, AreEvenInAFurnaceAndEveryFaceHasItsShareOfPoints) {
    const Solution s = furnace(0.5);
    const RadiosityFunction light(s);
    Progress progress;
    const StopRequest stop;
    std::vector<SurfaceId> faces;
    for (SurfaceId id : s.scene.surfaces().ids()) faces.push_back(id);
    const std::vector<SurfacePoints> found = measure_surfaces(light, faces, 500, progress, stop);
    ASSERT_EQ(found.size(), 6u);
    for (const SurfacePoints& face : found) {
        EXPECT_NEAR(static_cast<double>(face.light.size()), 50 * s.scene.surfaces()[face.surface].area, 1);
        for (const Light& there : face.light) {
            EXPECT_NEAR(there.irradiance[0], 2, 1e-6);
            EXPECT_NEAR(there.radiosity[0], 2, 1e-6);
        }
    }
}

TEST(ErrorPercentile, IsZeroInAFurnaceAndTheDifferenceInABrighterOne) {
    Progress progress;
    const StopRequest stop;
    const Solution right = furnace(0.5), bright = furnace(0.5, 1.1);
    const ErrorPercentile none = find_error_percentile(RadiosityFunction(right), 40, 64, progress, stop);
    EXPECT_EQ(none.points, 40u);
    EXPECT_NEAR(none.p99, 0, 1e-6);  // elements store floats
    // E = 2.2, E' = 1 + 0.5 x 2.2 = 2.1
    const ErrorPercentile off = find_error_percentile(RadiosityFunction(bright), 40, 64, progress, stop);
    EXPECT_NEAR(off.p99, 0.1 / 2.2, 1e-5);
    EXPECT_NEAR(off.median, 0.1 / 2.2, 1e-5);
}

}  // namespace
}  // namespace exitance
