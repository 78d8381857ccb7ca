#pragma once

#include <algorithm>
#include <vector>

#include "exitance/scene/add_polygon.hpp"

namespace exitance {

using Outline = std::vector<Point>;  ///< Corners of a face, counter-clockwise seen from its front, metres.
using Outlines = std::vector<Outline>;

/// Adds the faces of a prism over a polygon, which is counter-clockwise seen from above: bottom, top, sides.
inline void add_prism_faces(Outlines& faces, const std::vector<Vec2>& base, double low, double high,
                            bool inwards = false) {
    const std::size_t first = faces.size();
    Outline bottom, top;
    for (const Vec2& p : base) bottom.insert(bottom.begin(), {p.x, p.y, low}), top.push_back({p.x, p.y, high});
    faces.push_back(bottom), faces.push_back(top);
    for (std::size_t i = 0; i < base.size(); ++i) {
        const Vec2 p = base[i], q = base[(i + 1) % base.size()];
        faces.push_back({{p.x, p.y, low}, {q.x, q.y, low}, {q.x, q.y, high}, {p.x, p.y, high}});
    }
    for (std::size_t k = first; inwards && k < faces.size(); ++k) std::reverse(faces[k].begin(), faces[k].end());
}

/// Adds the faces of a box between two corners in the same order: bottom, top, sides y = a.y, x = b.x, y = b.y, x =
/// a.x.
inline void add_box_faces(Outlines& faces, const Point& a, const Point& b, bool inwards = false) {
    add_prism_faces(faces, {{a.x, a.y}, {b.x, a.y}, {b.x, b.y}, {a.x, b.y}}, a.z, b.z, inwards);
}

/// Returns a scene of these faces, which have no common corners and reflect a quarter of the light.
inline Scene scene_of(const std::vector<Outline>& outlines) {
    SceneDescription d;
    d.materials.push_back({"grey", Spectrum(0.25), Spectrum()});
    d.groups.push_back("all");
    for (const Outline& outline : outlines) add_polygon(d, outline);
    return *make_scene(d).scene;
}

}  // namespace exitance
