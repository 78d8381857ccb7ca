#include "exitance/measure/working_plane.hpp"

#include <gtest/gtest.h>

#include "exitance/measure/floor_rooms.hpp"
#include "support/built_scene.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

/// Floors at z = 0 with given outlines, each in a group "floor" with its own material, and a table of 1 m^2 at 0.8 m.
Scene scene_of(const std::vector<std::vector<Vec2>>& outlines) {
    SceneDescription d;
    d.groups = {"floor", "table"};
    const auto add = [&](const std::vector<Vec2>& outline, double z, std::uint32_t group) {
        SceneDescription::Face f;
        for (const Vec2& p : outline) {
            f.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back({p.x, p.y, z});
        }
        f.group = group, f.material = static_cast<std::uint32_t>(d.materials.size());
        d.materials.push_back({"m" + std::to_string(f.material), Spectrum(0.5), Spectrum(1)});
        d.faces.push_back(f);
    };
    for (const auto& outline : outlines) add(outline, 0, 0);
    add({{1, 1}, {2, 1}, {2, 2}, {1, 2}}, 0.8, 1);
    CheckedScene checked = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

std::size_t counted(const GridLight& grid) {
    return static_cast<std::size_t>(std::count(grid.counts.begin(), grid.counts.end(), true));
}

Result<std::vector<GridLight>> planes_of(const Scene& scene, const PlaneRequest& request) {
    const RayTracer tracer(scene);
    return make_working_planes(scene, FloorRooms(scene, tracer), request);
}

PlaneRequest at_height(double height) {
    PlaneRequest request;
    request.height = height;
    return request;
}

TEST(WorkingPlane, HasTheStandardSpacingWithinABorderOfHalfAMetre) {
    // 6 x 4 m: 5 x 3 m within the border, p = 0.2 * 5^log10(5) = 0.616 m: 9 x 5 points.
    const Scene scene = scene_of({{{0, 0}, {6, 0}, {6, 4}, {0, 4}}});
    const auto planes = planes_of(scene, at_height(0.75));
    ASSERT_TRUE(planes) << planes.error().message;
    ASSERT_EQ(planes->size(), 1u);
    const GridLight& grid = planes->front();
    EXPECT_EQ(grid.columns, 9);
    EXPECT_EQ(grid.rows, 5);
    EXPECT_EQ(counted(grid), 45u);
    EXPECT_NEAR(norm(grid.points[0] - Point{0.5 + 2.5 / 9, 0.8, 0.75}), 0, 1e-12);
    EXPECT_EQ(grid.name, "0.75 m above floor");
}

TEST(WorkingPlane, OmitsPointsOutsideTheOutlineOrNearIt) {
    // An L of 6 x 6 m without its upper right quarter, split into two faces along x = 3.
    const Scene scene = scene_of({{{0, 0}, {3, 0}, {3, 6}, {0, 6}}, {{3, 0}, {6, 0}, {6, 3}, {3, 3}}});
    PlaneRequest request = at_height(1);
    request.spacing = 0.5;
    const auto planes = planes_of(scene, request);
    ASSERT_TRUE(planes);
    ASSERT_EQ(planes->size(), 1u);
    const GridLight& grid = planes->front();
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
        const Point& p = grid.points[i];
        const bool far_from_corner = norm(p - Point{3, 3, 1}) > 0.51;
        const bool is_inside = p.x < 2.5 || p.y < 2.5;
        if (!is_inside || far_from_corner) {
            EXPECT_EQ(grid.counts[i], is_inside) << p.x << " " << p.y;
        }
    }
}

TEST(WorkingPlane, NamedFacesAreMeasuredOnThemselves) {
    const Scene scene = scene_of({{{0, 0}, {6, 0}, {6, 4}, {0, 4}}});
    PlaneRequest request;
    request.group = "table";
    const auto planes = planes_of(scene, request);
    ASSERT_TRUE(planes);
    EXPECT_EQ(planes->front().points.size(), 25u);  // spacing p = 0.2 m
    EXPECT_NEAR(planes->front().points[0].z, 0.8, 1e-12);
    request.group = "chair";
    const auto missing = planes_of(scene, request);
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().hint.find("table"), std::string::npos);
}

TEST(WorkingPlane, SurroundingsAreABandAroundTheTaskArea) {
    // Around the table of 1 x 1 m: a band of 0.5 m has 3 m^2 and four quarters of a circle of 0.5 m, 3 - 1 + pi / 4.
    const Scene scene = scene_of({{{0, 0}, {6, 0}, {6, 4}, {0, 4}}});
    PlaneRequest request;
    request.group = "table", request.surroundings = 0.5, request.spacing = 0.02;
    const auto planes = planes_of(scene, request);
    ASSERT_TRUE(planes);
    ASSERT_EQ(planes->size(), 2u);
    EXPECT_EQ(planes->back().name, "table, surroundings");
    const double cell = planes->back().step_u * planes->back().step_v;
    EXPECT_NEAR(static_cast<double>(counted(planes->back())) * cell, 2 + pi / 4, 0.02);  // measured in cells of 0.02 m
    EXPECT_EQ(planes->back().zone, PlaneZone::surroundings);
}

TEST(WorkingPlane, TheBackgroundIsABandAroundTheSurroundings) {
    // Around the table of 1 x 1 m: 4 m x 0.4 m, and a ring with radii of 0.5 and 0.9 m.
    const Scene scene = scene_of({{{0, 0}, {6, 0}, {6, 4}, {0, 4}}});
    PlaneRequest request;
    request.group = "table", request.surroundings = 0.5, request.background = 0.4, request.spacing = 0.02;
    const auto planes = planes_of(scene, request);
    ASSERT_TRUE(planes);
    ASSERT_EQ(planes->size(), 3u);
    const GridLight& background = planes->back();
    EXPECT_EQ(background.name, "table, background");
    EXPECT_EQ(background.zone, PlaneZone::background);
    const double cell = background.step_u * background.step_v;
    EXPECT_NEAR(static_cast<double>(counted(background)) * cell, 1.6 + pi * (0.9 * 0.9 - 0.5 * 0.5), 0.03);
}

TEST(WorkingPlane, SeparateRoomsHaveOnePlaneEach) {
    const Scene scene = scene_of({{{0, 0}, {3, 0}, {3, 4}, {0, 4}}, {{3.2, 0}, {8, 0}, {8, 4}, {3.2, 4}}});
    const auto planes = planes_of(scene, at_height(0.75));
    ASSERT_TRUE(planes);
    ASSERT_EQ(planes->size(), 2u);
    EXPECT_GT(counted(planes->front()), counted(planes->back()));
}

TEST(WorkingPlane, BordersOfNarrowPlanesShrink) {
    EXPECT_EQ(default_border(6, 4, true), 0.5);
    EXPECT_EQ(default_border(2, 2, true), 0.5);
    EXPECT_NEAR(default_border(8, 1, true), 0.15, 1e-12);
    EXPECT_EQ(default_border(6, 4, false), 0);
}

TEST(WorkingPlane, CylindricalIlluminanceInAFurnaceEqualsThatOfItsWalls) {
    // E = 1 / (1 - 0.5) everywhere, on planes of every direction.
    Solution s;
    s.scene = box_scene(3, 2, 2, 0.5, 1, 1);
    s.indirect = sample_function(s.scene, 1, 20);
    for (auto& value : s.indirect.values) value.fill(2.0F);
    s.interpolant = s.indirect;
    s.direct_in_elements = true;
    PlaneRequest request = at_height(1.2);
    request.is_cylindrical = true, request.spacing = 1;
    auto planes = planes_of(s.scene, request);
    ASSERT_TRUE(planes);
    Progress progress;
    measure(RadiosityFunction(s), planes->front(), progress, StopRequest());
    for (std::size_t i = 0; i < planes->front().points.size(); ++i)
        EXPECT_NEAR(planes->front().irradiance[i][0], 2, 2e-3);
}

}  // namespace
}  // namespace exitance
