#include "exitance/scene/locator.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"
#include "exitance/scene/add_polygon.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

Scene scene_of(const std::vector<std::vector<Point>>& faces) {
    SceneDescription d;
    d.materials = {{"grey", Spectrum(0.5), {}}, {"other", Spectrum(0.4), {}}};
    d.groups = {"all"};
    for (const auto& outline : faces) {
        const bool is_odd = d.faces.size() % 2 == 1;
        add_polygon(d, outline).material = is_odd ? 1 : 0;  // alternating materials prevent joining
    }
    CheckedScene made = make_scene(d);
    EXPECT_TRUE(made.scene);
    return *made.scene;
}

std::vector<Point> rectangle(double x0, double y0, double x1, double y1, double z) {
    return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

TEST(Locator, FindsTheFaceOfEveryPointOnOne) {
    const Scene scene = sample_scene();
    const Locator locator(scene);
    RandomStream random(1, Stream::mesh);
    for (SurfaceId s : scene.surfaces().ids()) {
        const auto outline = scene.outline(s);
        for (int i = 0; i < 200; ++i) {
            const double u = random.uniform(), v = random.uniform() * (outline.size() == 3 ? 1 - u : 1);
            const Point p = outline[0] + u * (outline[1] - outline[0]) + v * (outline.back() - outline[0]);
            EXPECT_EQ(locator.find(p, scene.surfaces()[s].normal), s);
        }
    }
}

TEST(Locator, FindsNoFaceForPointsInFreeSpace) {
    const Scene scene = sample_scene();
    const Locator locator(scene);
    EXPECT_TRUE(locator.find({1, 0.5, 0.5}, {0, 0, 1}).is_none());
    EXPECT_TRUE(locator.find({1, 0.5, 2 * locator.tolerance()}, {0, 0, 1}).is_none());
    EXPECT_TRUE(locator.find({1, 0.5, 0}, {0, 0, -1}).is_none());                // from behind
    EXPECT_TRUE(locator.find({1, 0.5, 0}, normalized({0.05, 0, 1})).is_none());  // 2.9 degrees
    EXPECT_FALSE(locator.find({1, 0.5, 0}, normalized({0.04, 0, 1})).is_none());
    EXPECT_TRUE(locator.find({NAN, 0, 0}, {0, 0, 1}).is_none());
}

TEST(Locator, AcceptsPointsOutsideByLessThanTheTolerance) {
    const Scene scene = scene_of({rectangle(0, 0, 1, 1, 0)});
    const Locator locator(scene);
    const double t = locator.tolerance();
    EXPECT_EQ(locator.find({1 + 0.9 * t, 0.5, 0}, {0, 0, 1}), SurfaceId(0u));
    EXPECT_EQ(locator.find({0.5, 0.5, -0.9 * t}, {0, 0, 1}), SurfaceId(0u));
    EXPECT_TRUE(locator.find({1 + 1.1 * t, 0.5, 0}, {0, 0, 1}).is_none());
    EXPECT_TRUE(locator.find({0.5, 0.5, 1.1 * t}, {0, 0, 1}).is_none());
}

TEST(Locator, FindsTheNearestOfCloseParallelFaces) {
    const double gap = 5e-6;  // less than the tolerance of 1.4e-5
    const Scene scene = scene_of({rectangle(0, 0, 1, 1, 0), rectangle(0.2, 0.2, 0.8, 0.8, gap)});
    const Locator locator(scene);
    EXPECT_EQ(locator.find({0.5, 0.5, 0.4 * gap}, {0, 0, 1}), SurfaceId(0u));
    EXPECT_EQ(locator.find({0.5, 0.5, 0.6 * gap}, {0, 0, 1}), SurfaceId(1u));
    EXPECT_EQ(locator.find({0.1, 0.5, gap}, {0, 0, 1}), SurfaceId(0u));
}

TEST(Locator, FindsOneFaceForABorderRegardlessOfRounding) {
    const Scene scene = scene_of({rectangle(0, 0, 1, 1, 0), rectangle(1, 0, 2, 1, 0)});
    const Locator locator(scene);
    EXPECT_FALSE(locator.find({1, 0.5, 0}, {0, 0, 1}).is_none());
    EXPECT_EQ(locator.find({1 - 1e-12, 0.5, 1e-12}, {0, 0, 1}), SurfaceId(0u));
    EXPECT_EQ(locator.find({1 + 1e-12, 0.5, 1e-12}, {0, 0, 1}), SurfaceId(1u));
}

TEST(Locator, ExcludesTheNotchesOfConcaveFaces) {
    const Scene scene = scene_of({{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}}});
    const Locator locator(scene);
    EXPECT_FALSE(locator.find({0.5, 0.5, 0}, {0, 0, 1}).is_none());
    EXPECT_FALSE(locator.find({1.5, 1.5, 0}, {0, 0, 1}).is_none());
    EXPECT_TRUE(locator.find({0.5, 1.5, 0}, {0, 0, 1}).is_none());
}

TEST(Locator, FindsTheFaceAmongManyFaces) {
    std::vector<std::vector<Point>> faces;
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 20; ++j)
            for (int i = 0; i < 20; ++i) faces.push_back(rectangle(i, j, i + 0.9, j + 0.9, k));
    const Scene scene = scene_of(faces);
    const Locator locator(scene);
    for (SurfaceId s : scene.surfaces().ids()) EXPECT_EQ(locator.find(centroid(scene.outline(s)), {0, 0, 1}), s);
}

}  // namespace
}  // namespace exitance
