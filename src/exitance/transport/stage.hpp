#pragma once

#include <algorithm>
#include <atomic>
#include <iterator>
#include <utility>
#include <vector>

#include "exitance/direct/place_light.hpp"
#include "exitance/mesh/contact_lines.hpp"
#include "exitance/mesh/solve_mesh.hpp"
#include "exitance/transport/light_rooms.hpp"
#include "exitance/visibility/glass/glass_colours.hpp"
#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/rays.hpp"
#include "exitance/visibility/thin_walls.hpp"

namespace exitance {

/// A scene prepared for transport: the data that every method needs, computed once.
struct Stage {
    explicit Stage(const Scene& s)
        : scene(s),
          pieces(cut_into_pieces(s)),
          concave(find_concave_borders(s, pieces)),
          contacts(s),
          tracer(s),
          glass(s),
          occluders(s),
          direct(s, occluders),
          place_light(direct, tracer) {
        occluders.set_thin_walls(find_thin_walls(occluders, tracer));
        set_unlit_sides({});
    }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    const Scene& scene;
    std::vector<Piece> pieces;
    std::vector<ConcaveBorders> concave;
    ContactLines contacts;
    RayTracer tracer;
    GlassColours glass;  ///< Colours of the rays of `tracer`.
    Occluders occluders;
    DirectLight direct;
    PlaceLight place_light;  ///< Direct light at places, exact or by rays.
    /// Sets the sides of sheets that no light reaches: they do not count in `area` and are not meshed in advance. Light
    /// that does reach them is handled as on any other side.
    void set_unlit_sides(Field<RegionId, std::uint8_t> sides) {
        unlit = std::move(sides);
        area = 0;
        for (const Piece& piece : pieces)
            if (!is_unlit(piece.region)) area += piece.patch.area();
    }
    bool is_unlit(RegionId region) const { return unlit.size() > 0 && unlit[region]; }

    /// Pieces on other than unlit sides.
    std::vector<Piece> lit_pieces() const {
        std::vector<Piece> out;
        std::copy_if(pieces.begin(), pieces.end(), std::back_inserter(out),
                     [&](const Piece& piece) { return !is_unlit(piece.region); });
        return out;
    }

    /// Pieces on other than unlit sides, with the factor on their elements that follows from `rooms`.
    LitSpaces lit_spaces() const { return {lit_pieces(), rooms.multiplicity()}; }

    /// True if most of this many elements are whole small polygons (`ErrorShare`), and not those of many rooms.
    bool is_crowd(std::size_t elements) const;
    /// `ErrorShare::small_area` of this many elements, m^2.
    double small_area(std::size_t elements) const;

    /// Sets the rooms. If there are many, the concave borders are found again: those that were left out because the
    /// polygons of all rooms together looked like a crowd of small ones.
    void set_rooms(LightRooms found);

    /// Meshes all pieces: graded towards concave edges, split along contacts with other polygons, and finer in rooms
    /// that are smaller than others. On a stop request the mesh is valid but not everywhere split.
    ElementTree make_elements(MeshSize size, const StopRequest* stop = nullptr) const;

    double area = 0;                      ///< Area of all surfaces but unlit sides, m^2.
    Field<RegionId, std::uint8_t> unlit;  ///< 1 for unlit sides; empty: there is none.
    LightRooms rooms;                     ///< Rooms by which errors are judged.

    /// Area of an element as weighted in error measures, m^2.
    double counted_area(const ElementTree& tree, ElementId e) const {
        return rooms.count() > 0 ? tree.area(e) * rooms.weight(tree, e) : tree.area(e);
    }

    /// Area of an element, weighted by how much its light matters to the rooms it illuminates, m^2.
    double important_area(const ElementTree& tree, ElementId e) const {
        return rooms.count() > 0 ? tree.area(e) * rooms.importance(tree, e) : tree.area(e);
    }

    /// Mean number of times that light is reflected: 1 / (1 - mean reflectance), at most
    /// `calibrated::largest_reflection_count`. An error that every reflection repeats grows by this factor.
    double expected_reflections() const;

    /// True if something emits and something reflects. Otherwise all light is direct.
    bool has_indirect_light() const {
        bool reflects = false;
        for (const Region& region : scene.regions())
            reflects |= max(scene.materials()[region.material].reflectance) > 0;
        return reflects && scene.has_light();
    }
};

}  // namespace exitance
