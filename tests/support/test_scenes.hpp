#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/scene/add_polygon.hpp"

namespace exitance::test {

/// A face of a hand-made scene; it emits if its exitance is not 0.
struct Face {
    std::vector<Point> corners;
    double exitance = 0;
};

inline Scene make(const std::vector<Face>& faces) {
    SceneDescription description;
    description.groups = {"all"};
    for (const Face& face : faces) {
        SceneDescription::Face& f = add_polygon(description, face.corners);
        f.material = static_cast<std::uint32_t>(description.materials.size());
        description.materials.push_back({std::to_string(f.material), Spectrum(0.5), Spectrum(face.exitance)});
    }
    CheckedScene checked = make_scene(std::move(description));
    EXPECT_TRUE(checked.scene) << checked.scene.error().message;
    return std::move(*checked.scene);
}

/// An L-shaped room of 3 x 3 m, 1 m wide, whose faces point inwards and emit equally.
inline std::vector<Face> l_room(double height, double exitance) {
    const std::vector<Vec2> L = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    std::vector<Face> faces = {{{}, exitance}, {{}, exitance}};
    for (std::size_t i = 0; i < L.size(); ++i) {
        const Vec2 a = L[i], b = L[(i + 1) % L.size()], top = L[L.size() - 1 - i];
        faces[0].corners.push_back({a.x, a.y, 0});
        faces[1].corners.push_back({top.x, top.y, height});
        faces.push_back({{{a.x, a.y, 0}, {a.x, a.y, height}, {b.x, b.y, height}, {b.x, b.y, 0}}, exitance});
    }
    return faces;
}

inline Vec3 any_in_cube(RandomStream& random) {
    const double x = random.uniform() - 0.5, y = random.uniform() - 0.5;
    return {x, y, random.uniform() - 0.5};
}

/// Faces of a box, with fronts inwards.
inline std::vector<Face> closed_box(const Point& lo, const Vec3& size) {
    const auto face = [&](std::initializer_list<int> corners) {
        Face f;
        for (int i : corners)
            f.corners.push_back(lo + Vec3{(i & 1) * size.x, (i >> 1 & 1) * size.y, (i >> 2 & 1) * size.z});
        return f;
    };
    return {face({0, 1, 3, 2}), face({4, 6, 7, 5}), face({0, 4, 5, 1}),
            face({2, 3, 7, 6}), face({0, 2, 6, 4}), face({1, 5, 7, 3})};
}

/// `count` random triangles of about `size` in a cube of side 1 around `middle`.
inline std::vector<Face> triangle_soup(std::size_t count, double size, std::uint64_t seed, const Point& middle = {}) {
    RandomStream random(seed, Stream::mesh, count);
    std::vector<Face> faces;
    while (faces.size() < count) {
        const Point a = middle + any_in_cube(random);
        const Point b = a + size * any_in_cube(random), c = a + size * any_in_cube(random);
        if (norm(cross(b - a, c - a)) > 0.01 * size * size) faces.push_back({{a, b, c}});
    }
    return faces;
}

/// The first face on a ray, found by testing all faces in double precision.
inline SurfaceId first_on_ray(const Scene& scene, const Point& origin, const Vec3& direction, double& distance,
                              RegionId own = {}) {
    SurfaceId first;
    distance = HUGE_VAL;
    for (SurfaceId s : scene.surfaces().ids()) {
        const Surface& surface = scene.surfaces()[s];
        const double t = dot(surface.normal, scene.outline(s)[0] - origin) / dot(surface.normal, direction);
        if (surface.region == own || !(t > 1e-12) || t >= distance) continue;
        if (contains(scene.outline(s), surface.normal, origin + t * direction)) first = s, distance = t;
    }
    return first;
}

}  // namespace exitance::test
