#pragma once

#include <algorithm>
#include <vector>

#include "exitance/scene/add_polygon.hpp"

namespace exitance::test {

/// Describes a scene in few words. Every polygon has its own points, as in the files of many programs.
struct Sketch {
    SceneDescription d;

    Sketch() {
        d.file = "sketch.obj";
        d.groups = {"all"};
        d.materials = {{"grey", Spectrum(0.5), {}}, {"light", Spectrum(0), Spectrum(1)}, {"dark", Spectrum(0.1), {}}};
    }
    Sketch& add(const std::vector<Point>& outline, std::uint32_t material = 0) {
        SceneDescription::Face& face = add_polygon(d, outline);
        face.material = material;
        face.line = static_cast<int>(d.faces.size());
        return *this;
    }
    Sketch& rectangle(double x0, double y0, double x1, double y1, std::uint32_t material = 0) {
        return add({{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}}, material);
    }
    /// Adds a light far above the other faces, so that it touches none of them.
    Sketch& light() { return add({{0, 0, 9}, {0, 1, 9}, {1, 1, 9}, {1, 0, 9}}, 1); }
    CheckedScene make() const { return make_scene(d); }
};

/// Number of findings of a kind.
inline int count(const CheckedScene& s, Finding::Kind kind) {
    return static_cast<int>(
        std::count_if(s.findings.begin(), s.findings.end(), [&](const Finding& f) { return f.kind == kind; }));
}

inline const Region& region(const CheckedScene& s, std::size_t i) {
    return s.scene->regions()[RegionId(i)];
}

}  // namespace exitance::test
