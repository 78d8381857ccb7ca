#include "exitance/scene/opposed_faces.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "exitance/scene/other_side.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

constexpr double tolerance = 1e-6;  ///< Metres.
const Vec3 down{0, 0, -1}, up{0, 0, 1};

/// A rectangle in the plane of height z that faces up or down.
test::Face rectangle(const Point& lo, const Point& hi, bool looks_up) {
    std::vector<Point> p{lo, {hi.x, lo.y, lo.z}, hi, {lo.x, hi.y, lo.z}};
    if (!looks_up) std::reverse(p.begin(), p.end());
    return {p};
}

bool any(const OpposedFaces& faces, const Scene& scene) {
    for (SurfaceId s : scene.surfaces().ids())
        if (faces.has(s)) return true;
    return false;
}

}  // namespace

TEST(OpposedFaces, FindsTheFaceThatFacesARay) {
    // One square facing up, and a face of half its size facing down in the same plane.
    const Scene scene = test::make({rectangle({0, 0, 1}, {1, 1, 1}, true), rectangle({0, 0, 1}, {0.5, 1, 1}, false)});
    const OpposedFaces faces(scene, other_sides_of_surfaces(scene), tolerance);
    ASSERT_TRUE(faces.has(SurfaceId(0)) && faces.has(SurfaceId(1)));
    EXPECT_EQ(faces.facing({0.25, 0.5, 1}, down), SurfaceId(0));
    EXPECT_EQ(faces.facing({0.25, 0.5, 1}, up), SurfaceId(1));
    EXPECT_TRUE(faces.facing({0.75, 0.5, 1}, up).is_none()) << "a back with nothing below it";
    EXPECT_TRUE(faces.facing({0.25, 0.5, 1.1}, up).is_none()) << "of another plane";
}

TEST(OpposedFaces, OmitSheetsOfOneOutlineAndSlabs) {
    const Scene sheet = test::make({rectangle({0, 0, 1}, {1, 1, 1}, true), rectangle({0, 0, 1}, {1, 1, 1}, false)});
    EXPECT_FALSE(any(OpposedFaces(sheet, other_sides_of_surfaces(sheet), tolerance), sheet));
    const Scene slab = test::make({rectangle({0, 0, 1}, {1, 1, 1}, true), rectangle({0, 0, 0.9}, {1, 1, 0.9}, false)});
    EXPECT_FALSE(any(OpposedFaces(slab, other_sides_of_surfaces(slab), tolerance), slab));
}

}  // namespace exitance
