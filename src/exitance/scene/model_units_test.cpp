#include "exitance/scene/model_units.hpp"

#include <gtest/gtest.h>

#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A closed room of `size`, its faces looking inwards, with a lamp below its ceiling that shines down.
Scene lit_room(const Vec3& size) {
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, size);
    const double x = size.x / 2, y = size.y / 2, z = 0.95 * size.z, half = 0.1 * size.x;
    faces.push_back(
        {{{x - half, y - half, z}, {x - half, y + half, z}, {x + half, y + half, z}, {x + half, y - half, z}}, 1});
    return test::make(faces);
}

std::string unit_of(const Scene& scene) {
    const char* const unit = guess_units(scene).unit;
    return unit ? unit : "m";
}

TEST(ModelUnits, TheUnitOfARoomIsToldByItsHeight) {
    EXPECT_EQ(unit_of(lit_room({4, 3, 2.5})), "m");
    EXPECT_EQ(unit_of(lit_room({4000, 3000, 2500})), "mm");
    EXPECT_EQ(unit_of(lit_room({400, 300, 250})), "cm");
    EXPECT_EQ(unit_of(lit_room({157, 118, 98})), "in");
    EXPECT_EQ(unit_of(lit_room({60, 40, 28})), "m") << "an atrium is possible";
    EXPECT_FALSE(guess_units(lit_room({4, 3, 2.5})).is_too_small);
    EXPECT_TRUE(guess_units(lit_room({0.4, 0.3, 0.25})).is_too_small);
}

TEST(ModelUnits, FurnitureOfAThousandMetresIsInMillimetres) {
    std::vector<test::Face> cupboard = test::closed_box({0, 0, 0}, {900, 600, 1800});
    for (test::Face& face : cupboard) std::reverse(face.corners.begin(), face.corners.end());
    EXPECT_EQ(unit_of(test::make(cupboard)), "mm");
    std::vector<test::Face> land = test::closed_box({0, 0, 0}, {9000, 6000, 300});
    for (test::Face& face : land) std::reverse(face.corners.begin(), face.corners.end());
    EXPECT_EQ(unit_of(test::make(land)), "m");
}

TEST(ModelUnits, LampsAndAnOpenTopTellTheUprightAxis) {
    EXPECT_FALSE(guess_units(lit_room({4, 3, 2.5})).y_is_up);
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {4, 2.5, 3});
    faces.push_back({{{1, 2.3, 1}, {2, 2.3, 1}, {2, 2.3, 2}, {1, 2.3, 2}}, 1});  // shines towards -y
    const Scene y_up = test::make(faces);
    ASSERT_LT(y_up.surfaces()[SurfaceId(6)].normal.y, -0.99);
    EXPECT_TRUE(guess_units(y_up).y_is_up);
    std::vector<test::Face> open = test::closed_box({0, 0, 0}, {4, 2.5, 3});
    open.erase(open.begin() + 3);  // the face at the largest y
    EXPECT_TRUE(guess_units(test::make(open)).y_is_up);
}

TEST(ModelUnits, WhatTheUserHasNamedIsNotAskedFor) {
    const Scene scene = lit_room({4000, 3000, 2500});
    const ModelUnits guess = guess_units(scene);
    const std::vector<Finding> found = findings_of(guess, scene, false, false);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NE(found[0].hint.find("--length-unit mm"), std::string::npos);
    EXPECT_TRUE(findings_of(guess, scene, true, false).empty());
}

}  // namespace
}  // namespace exitance
