#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/polygon.hpp"
#include "exitance/scene/point_light.hpp"
#include "exitance/scene/sky/distant_light.hpp"

namespace exitance {

/// Faces as the search for bodies sees them.
struct BodyFaces {
    std::vector<std::vector<Point>> outlines;  ///< Metres; holes are joined to the rim by bridges.
    std::vector<Normal> normals;
    std::vector<bool> emits;
    std::vector<Point> lights;         ///< Sources without extent.
    bool has_light_from_afar = false;  ///< A sky, a sun, parallel light.
    double size = 0;                   ///< Of the scene, metres.

    void add_lights(std::span<const PunctualLight> all, const DistantLight& distant);
    void add(std::span<const Point> outline, const Normal& n, bool is_emitter) {
        outlines.emplace_back(outline.begin(), outline.end());
        normals.push_back(n), emits.push_back(is_emitter);
    }
};

/// A closed body whose faces show their backs where there is air.
struct InsideOut {
    std::vector<std::uint32_t> faces;  ///< Ascending.
    bool is_room = false;              ///< Its faces look outwards, away from light that it encloses; else inwards.
};

/// Finds the closed bodies that are inside out. A body's faces hang together by their edges, cut where corners of
/// others lie on them; corners within a millionth of the scene's size are one. Reported are
///
/// - a body with all fronts inside that stands in a space whose walls show mostly fronts (furniture in a room), or in
///   the open, if there is light outside of all closed bodies and the body holds neither light nor other faces;
/// - a body with all fronts outside that encloses light, or outside of which there is neither a face nor light: a room.
///
/// A body within a body that is reported is judged as if the outer one were turned. A cavity within a solid body is
/// none. O(n log n) in edges, and O(faces of the enclosing body) per body.
std::vector<InsideOut> find_inside_out(const BodyFaces& faces);

}  // namespace exitance
