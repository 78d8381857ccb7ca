#include "exitance/discontinuity/cover_ends.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/solved.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

using test::Face;

constexpr double tilt = 1e-5;

/// A box rotated about the x axis by a tiny angle, as in imprecise models.
std::vector<Face> tilted_box(const Point& lo, const Vec3& size) {
    std::vector<Face> faces = test::closed_box(lo, size);
    for (Face& face : faces) {
        std::reverse(face.corners.begin(), face.corners.end());
        for (Point& p : face.corners) p = {p.x, p.y - tilt * p.z, p.z + tilt * p.y};
    }
    return faces;
}

TEST(CoverEnds, AreWhereATiltedPlateIsItsThicknessAboveAFloor) {
    const Scene scene = test::make({{{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}},
                                    {{{-1, 0, 0}, {-1, 1, tilt}, {1, 1, tilt}, {1, 0, 0}}},
                                    {{{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}}, 3}});
    const Occluders occluders(scene);
    const RegionId floor = scene.surfaces()[SurfaceId(0)].region, plate = scene.surfaces()[SurfaceId(1)].region;
    const auto lines = cover_ends(occluders, floor);
    ASSERT_EQ(lines.size(), 1u);
    const double y = occluders.pieces()[*occluders.pieces(plate).begin()].thickness / tilt;
    ASSERT_LT(y, 0.9);
    EXPECT_NEAR(lines[0].first.y, y, 1e-9);
    EXPECT_NEAR(lines[0].second.y, y, 1e-9);
    EXPECT_NEAR(std::abs(lines[0].first.x - lines[0].second.x), 2, 1e-9);
    const Normal& n = scene.regions()[floor].plane.n;
    EXPECT_TRUE(occluders.is_covered({0, y - 1e-6, 0}, n, floor));
    EXPECT_FALSE(occluders.is_covered({0, y + 1e-6, 0}, n, floor));
}

TEST(CoverEnds, AreNoneIfNothingIsTilted) {
    const Scene scene = test::make({{{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}},
                                    {{{-1, 0, 0}, {-1, 1, 0}, {1, 1, 0}, {1, 0, 0}}},
                                    {{{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}}, 3}});
    EXPECT_TRUE(cover_ends(Occluders(scene), scene.surfaces()[SurfaceId(0)].region).empty());
}

/// Boxes on a floor, with faces that overlap those of other boxes. They are out of plane by less than the coplanarity
/// tolerance, or by more at their far ends.
TEST(CoverEnds, KeepTheNumberOfTrianglesLow) {
    std::vector<Face> faces = {{{{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}}}};
    for (const auto& box : {tilted_box({0.25, 0.75, 0}, {1, 1.5, 0.75}),
                            tilted_box({-0.25, 0.75, 0}, {0.75, 0.25, 0.5}), tilted_box({-1.25, 0, 0}, {0.75, 1.5, 1})})
        faces.insert(faces.end(), box.begin(), box.end());
    faces.push_back({{{0.75, 0.5, 3}, {2.25, 0.5, 3}, {2.25, -1, 3}, {0.75, -1, 3}}, 100});
    const Solution s =
        solved(test::make(faces), {.method = Method::discontinuity, .bounces = 0, .error_interpolant = 0.02});
    EXPECT_LE(*s.statistics.relative_error_estimate_interpolant, 0.02);
    // 863 triangles if the boxes are exactly aligned; tens of thousands if a jump has no curve along it.
    EXPECT_LT(s.statistics.discontinuity->triangles, 2'000u);
}

}  // namespace
}  // namespace exitance
