#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/polygon.hpp"
#include "exitance/scene/point_light.hpp"
#include "exitance/scene/sky/distant_light.hpp"

namespace exitance {

/// Input of the search for inside-out bodies.
struct BodyFaces {
    std::vector<std::vector<Point>> outlines;  ///< Metres; holes are joined to the rim by bridges.
    std::vector<Normal> normals;
    std::vector<bool> emits;
    std::vector<Point> lights;         ///< Positions of point lights and spotlights.
    bool has_light_from_afar = false;  ///< True if there is a sky, a sun or parallel light.
    double size = 0;                   ///< Diameter of the scene, metres.

    void add_lights(std::span<const PunctualLight> all, const DistantLight& distant);
    void add(std::span<const Point> outline, const Normal& n, bool is_emitter) {
        outlines.emplace_back(outline.begin(), outline.end());
        normals.push_back(n), emits.push_back(is_emitter);
    }
};

/// A closed body whose faces have the wrong orientation.
struct InsideOut {
    std::vector<std::uint32_t> faces;  ///< Numbers of its faces, ascending.
    /// True: a room whose fronts face outwards, away from its light. False: an object whose fronts face inwards.
    bool is_room = false;
};

/// Finds the closed bodies that are inside out. A body consists of faces connected by edges, split at corners of other
/// faces; corners within a millionth of the scene's size are equal. Reported are
///
/// - a body with all fronts inside, if it is in a space whose walls show mostly fronts (furniture in a room); or in the
/// open, if there is light outside of all closed bodies and the body contains neither light nor other faces;
/// - a body with all fronts outside, if it encloses light, or if there is neither a face nor light outside of it: a
/// room.
///
/// A body inside a reported body is classified as if the outer one were corrected. Cavities of solid bodies are
/// ignored. Bodies may lie on each other's faces, like a cupboard on the floor and against a wall. O(n log n) in edges
/// if few bodies overlap at any one point.
std::vector<InsideOut> find_inside_out(const BodyFaces& faces);

}  // namespace exitance
