#pragma once

#include <cmath>
#include <cstdlib>

#include "exitance/base/random.hpp"
#include "exitance/scene/add_polygon.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// A room of 2 m x 1 m x 1 m. Its floor is divided into two faces, its ceiling has a luminous strip, and a triangle
/// with two sides is inside. There are a spot, parallel light and a camera. Eleven faces in lines 10 to 20, four
/// materials, three groups. If `photometric`, its light is in lumens.
inline Scene sample_scene(bool photometric = false) {
    SceneDescription d;
    d.photometric = photometric;
    d.file = "sample room.obj";
    const auto grey = [](double r, double g, double b) {
        Spectrum s(g);
        s[0] = r, s[bands - 1] = b;
        return s;
    };
    d.materials = {{"wall", grey(0.5, 0.6, 0.7), Spectrum()},
                   {"floor", grey(0.3, 0.2, 0.1), Spectrum()},
                   {"lamp", Spectrum(), exitance_of_radiance(grey(10, 9, 8))},
                   {"sign \xc3\xa9", grey(0.8, 0.1, 0.1), exitance_of_radiance(grey(0.1, 0.2, 0.3))}};
    d.groups = {"shell", "lamp", "sign"};
    int line = 10;
    const auto face = [&](const std::vector<Point>& corners, std::uint32_t material, std::uint32_t group) {
        SceneDescription::Face& f = add_polygon(d, corners);
        f.material = material, f.group = group, f.line = line++;
    };
    face({{0, 0, 0}, {1.25, 0, 0}, {1.25, 1, 0}, {0, 1, 0}}, 1, 0);
    face({{1.25, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1.25, 1, 0}}, 1, 0);
    face({{0, 0, 1}, {0, 0.4, 1}, {2, 0.4, 1}, {2, 0, 1}}, 0, 0);
    face({{0, 0.4, 1}, {0, 0.6, 1}, {2, 0.6, 1}, {2, 0.4, 1}}, 2, 1);
    face({{0, 0.6, 1}, {0, 1, 1}, {2, 1, 1}, {2, 0.6, 1}}, 0, 0);
    face({{0, 0, 0}, {0, 0, 1}, {2, 0, 1}, {2, 0, 0}}, 0, 0);
    face({{0, 1, 0}, {2, 1, 0}, {2, 1, 1}, {0, 1, 1}}, 0, 0);
    face({{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}, 0, 0);
    face({{2, 0, 0}, {2, 0, 1}, {2, 1, 1}, {2, 1, 0}}, 0, 0);
    face({{0.5, 0.3, 0.2}, {0.9, 0.3, 0.3}, {0.6, 0.5, 0.7}}, 3, 2);
    face({{0.5, 0.3, 0.2}, {0.6, 0.5, 0.7}, {0.9, 0.3, 0.3}}, 3, 2);
    d.lights = {{"spot", PunctualLight::Kind::spot, {0.3, 0.2, 0.9}, {0, 0, -1}, grey(3, 2, 1), 0.2, 0.7},
                {"sun", PunctualLight::Kind::directional, {}, {0.6, 0, -0.8}, grey(9, 8, 7)}};
    d.cameras = {{"door", {0.1, 0.1, 0.5}, {1.5, 0.5, 0.5}, {0, 0, 1}, 70, 0}};
    CheckedScene made = make_scene(d);
    if (!made.scene) std::abort();  // the sample is valid
    return *made.scene;
}

/// A function on a randomly split tree with random values, for a scene whose regions are rectangles and triangles.
inline ElementFunction sample_function(const Scene& scene, std::uint64_t seed, int cuts) {
    ElementFunction f;
    for (RegionId r : scene.regions().ids()) {
        const std::vector<Point>& loop = scene.regions()[r].loops[0];
        const bool triangle = loop.size() == 3;
        f.tree.add_root(r, {loop[0], loop[1] - loop[0], loop.back() - loop[0],
                            triangle ? Patch::Shape::triangle : Patch::Shape::parallelogram});
    }
    RandomStream random(seed, Stream::mesh);
    for (int i = 0; i < cuts; ++i) {
        const auto leaves = f.tree.leaves();
        const ElementId leaf = leaves[random.bits() % leaves.size()];
        if (i % 7 == 3 || f.tree.is_cell(leaf)) {
            const Vec2 n = {random.uniform() - 0.5, random.uniform() - 0.5};
            f.tree.split_by_line(leaf, {n, dot(n, f.tree.centre(leaf))});
            continue;
        }
        const double ratio = 0.2 + 0.6 * random.uniform();
        f.tree.split(leaf, static_cast<Cut>(1 + random.bits() % 3), ratio);
    }
    f.first_value.resize(f.tree.size(), 0);
    for (ElementId e : f.tree.leaves()) {
        f.first_value[e] = static_cast<std::uint32_t>(f.values.size());
        for (int k = 0; k < f.tree.patch(e).corner_count(); ++k) {
            f.values.emplace_back();
            for (float& v : f.values.back()) v = static_cast<float>(30 * random.uniform());
        }
    }
    return f;
}

/// A solution whose elements, split `cuts` times, all receive the same reflected light.
inline Solution even_solution(Scene scene, double irradiance, int cuts = 0) {
    Solution s;
    s.scene = std::move(scene);
    s.indirect = sample_function(s.scene, 1, cuts);
    for (auto& value : s.indirect.values) value.fill(static_cast<float>(irradiance));
    s.interpolant = s.indirect;
    return s;
}

inline Solution sample_solution(int cuts = 40, bool photometric = false) {
    Solution s;
    s.scene = sample_scene(photometric);
    s.indirect = sample_function(s.scene, 1, cuts / 2);
    s.direct_share[0] = 0.9;
    s.interpolant = sample_function(s.scene, 2, cuts);
    s.options = R"({"method": "hierarchical", "error": 0.02})";
    s.bounces = -1;
    SolveStatistics& t = s.statistics;
    t.method = "hierarchical", t.basis = "constant", t.schedule = "stealing";
    t.threads = 2, t.surfaces = 11, t.elements = 123, t.leaf_elements = 100, t.links = std::size_t(5) << 32;
    t.rays = 7, t.form_factors = 8, t.iterations = 9, t.converged = true, t.residual = 1e-5;
    t.relative_error_estimate = 0.011, t.relative_error_bound = 0.02, t.relative_error_estimate_interpolant = 0.03;
    t.energy = {100, 99.5, 0.005};
    t.seconds[RunPart::total] = 1.5, t.seconds[RunPart::read] = 0.1, t.seconds[RunPart::link] = 1.0 / 3;
    t.peak_memory_bytes = 1000000, t.link_memory_bytes = 2000;
    t.warnings = {"the room is open", "it is dark in there"};
    return s;
}

}  // namespace exitance
