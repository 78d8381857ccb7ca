#include "exitance/scene/bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/checked_scene.hpp"

namespace exitance {
namespace {

/// Adds a cube of `size` metres with its lower corner at `at`; every face has its own corners.
void add_cube(SceneDescription& d, const Point& at, double size, std::uint32_t group) {
    const std::vector<std::vector<int>> faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                 {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};
    for (const std::vector<int>& face : faces) {
        SceneDescription::Face out{{}, 0, group, 0};
        for (const int corner : face) {
            out.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(at + size * Vec3{1.0 * (corner & 1), 1.0 * (corner >> 1 & 1), 1.0 * (corner >> 2)});
        }
        d.faces.push_back(out);
    }
}

SceneDescription with_groups(std::vector<std::string> groups) {
    SceneDescription d;
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = std::move(groups);
    return d;
}

TEST(Bodies, AreFacesThatShareEdges) {
    SceneDescription d = with_groups({"default"});
    add_cube(d, {0, 0, 0}, 1, 0), add_cube(d, {3, 0, 0}, 2, 0);
    const Scene scene = checked_scene(std::move(d));
    const SceneBodies bodies = find_bodies(scene);
    ASSERT_EQ(bodies.all.size(), 2u);
    EXPECT_EQ(bodies.all[0].surfaces, 6u);
    EXPECT_NEAR(bodies.all[0].area, 6, 1e-12);
    EXPECT_NEAR(bodies.all[1].area, 24, 1e-12);
    EXPECT_NEAR(norm(bodies.all[1].centre - Point{4, 1, 1}), 0, 1e-12);
    for (SurfaceId s : scene.surfaces().ids()) EXPECT_EQ(bodies.body[s], s.value / 6);
}

TEST(Bodies, OfNearlyFlatMeshesAreWhole) {
    // A sheet of triangles with bumps of some thousandths of a millimetre per metre, as of a scanned surface. Some of
    // them count as coplanar and are moved into one plane, apart from the others.
    for (const double scale : {1.0, 1e-3, 1e3}) {
        SceneDescription d = with_groups({"default"});
        constexpr std::uint32_t n = 24;
        for (std::uint32_t i = 0; i <= n; ++i)
            for (std::uint32_t k = 0; k <= n; ++k)
                d.points.push_back(scale * Vec3{1.0 * i / n, 1.0 * k / n, 2e-5 * std::sin(1.7 * i + 2.9 * k * k)} +
                                   Point{});
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::uint32_t k = 0; k < n; ++k) {
                const std::uint32_t a = i * (n + 1) + k, b = a + n + 1;
                d.faces.push_back({{a, b, b + 1}, 0, 0, 0});
                d.faces.push_back({{a, b + 1, a + 1}, 0, 0, 0});
            }
        EXPECT_EQ(find_bodies(checked_scene(std::move(d))).all.size(), 1u) << scale;
    }
}

TEST(Bodies, AreFacesOfOneNamedObject) {
    SceneDescription d = with_groups({"table", "default"});
    add_cube(d, {0, 0, 0}, 1, 0), add_cube(d, {3, 0, 0}, 1, 0), add_cube(d, {6, 0, 0}, 1, 1),
        add_cube(d, {9, 0, 0}, 1, 1);
    const SceneBodies bodies = find_bodies(checked_scene(std::move(d)));
    ASSERT_EQ(bodies.all.size(), 3u);  // "default" is the name given to faces without a name
    EXPECT_EQ(bodies.all[0].surfaces, 12u);
}

/// Adds a box with its lower corner at `at`, after a rotation by an odd angle about an odd axis.
void add_turned_box(SceneDescription& d, const Point& at, const Vec3& size, bool inwards, bool with_rim = true) {
    const Frame frame(normalized(Vec3{1, 2, 3}));
    const std::vector<std::vector<int>> faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                 {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};
    for (std::size_t f = 0; f < (with_rim ? 6 : 2); ++f) {
        SceneDescription::Face out{{}, 0, 0, 0};
        for (const int corner : faces[f]) {
            out.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            const Vec3 p{size.x * (corner & 1), size.y * (corner >> 1 & 1), size.z * (corner >> 2)};
            d.points.push_back(at + p.x * frame.u + p.y * frame.v + p.z * frame.n);
        }
        if (inwards) std::reverse(out.corners.begin(), out.corners.end());
        d.faces.push_back(out);
    }
}

SceneBodies bodies_of_box(const Vec3& size, bool inwards = false, bool with_rim = true) {
    SceneDescription d = with_groups({"default"});
    add_turned_box(d, {500, -300, 20}, size, inwards, with_rim);
    return find_bodies(checked_scene(std::move(d)));
}

TEST(Bodies, AreTheSidesOfPlatesAndSheets) {
    for (const double scale : {1e-3, 1.0, 1e3}) {
        const SceneBodies plate = bodies_of_box(scale * Vec3{4, 4, 0.1});
        ASSERT_EQ(plate.all.size(), 2u);
        EXPECT_NEAR(plate.all[0].area, scale * scale * 17.6, scale * scale * 1e-6);  // area with the rim of the plate
        EXPECT_NEAR(plate.all[1].area, scale * scale * 16, scale * scale * 1e-6);
        EXPECT_EQ(plate.all[1].surfaces, 1u);
        const SceneBodies sheet = bodies_of_box(scale * Vec3{4, 4, 0}, false, false);
        ASSERT_EQ(sheet.all.size(), 2u);
        EXPECT_EQ(sheet.all[0].surfaces, 1u);
    }
}

TEST(Bodies, OfCompactShapesAndFlatHallsAreWhole) {
    EXPECT_EQ(bodies_of_box({4, 4, 1.1}).all.size(), 1u);
    EXPECT_EQ(bodies_of_box({60, 40, 3}, true).all.size(), 1u);  // the floor and the ceiling see each other
}

TEST(Bodies, TheSmallestAreMergedWithNeighbours) {
    SceneDescription d = with_groups({"default"});
    for (int i = 0; i < 20; ++i) add_cube(d, {i < 10 ? 2.0 * i : 1000 + 2.0 * i, 0, 0}, i < 10 ? 0.1 : 1, 0);
    const Scene scene = checked_scene(std::move(d));
    const SceneBodies bodies = find_bodies(scene, 11);
    ASSERT_EQ(bodies.all.size(), 11u);
    double area = 0;
    std::size_t surfaces = 0;
    for (const SceneBody& body : bodies.all) area += body.area, surfaces += body.surfaces;
    EXPECT_NEAR(area, 10 * 6 * 1.01, 1e-9);
    EXPECT_EQ(surfaces, 120u);
    // The ten small cubes are one body, and no large one was merged with them.
    EXPECT_EQ(bodies.all[0].surfaces, 60u);
    EXPECT_NEAR(bodies.all[0].area, 0.6, 1e-9);
}

}  // namespace
}  // namespace exitance
