#pragma once

#include <algorithm>
#include <atomic>
#include <iterator>
#include <utility>
#include <vector>

#include "exitance/direct/clustered_light.hpp"
#include "exitance/direct/crowded_light.hpp"
#include "exitance/mesh/contact_lines.hpp"
#include "exitance/mesh/solve_mesh.hpp"
#include "exitance/transport/light_rooms.hpp"
#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// A scene made ready for transport: what every method needs of it, made once.
struct Stage {
    explicit Stage(const Scene& s)
        : scene(s),
          pieces(cut_into_pieces(s)),
          concave(find_concave_borders(s, pieces)),
          contacts(s),
          tracer(s),
          occluders(s),
          direct(s, occluders),
          clustered(direct, tracer),
          crowded(direct, tracer) {
        leave_out({});
    }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    const Scene& scene;
    std::vector<Piece> pieces;
    std::vector<ConcaveBorders> concave;
    ContactLines contacts;
    RayTracer tracer;
    Occluders occluders;
    DirectLight direct;
    ClusteredLight clustered;  ///< The same where emitters are many and small,
    CrowdedLight crowded;      ///< and where many things stand before them.
    /// Sides of sheets that no light reaches are no surfaces to anybody: they do not count in `area` and are not cut
    /// into elements in advance. Light that comes there after all is treated as everywhere.
    void leave_out(Field<RegionId, std::uint8_t> sides) {
        unlit = std::move(sides);
        area = 0;
        for (const Piece& piece : pieces)
            if (!is_left_out(piece.region)) area += piece.patch.area();
    }
    bool is_left_out(RegionId region) const { return unlit.size() > 0 && unlit[region]; }

    /// The pieces that are not left out.
    std::vector<Piece> lit_pieces() const {
        std::vector<Piece> out;
        std::copy_if(pieces.begin(), pieces.end(), std::back_inserter(out),
                     [&](const Piece& piece) { return !is_left_out(piece.region); });
        return out;
    }

    /// Elements over all pieces, graded towards concave edges and cut where other polygons touch them; finer in rooms
    /// that are small beside others. Where a stop is asked for, not all are cut.
    ElementTree make_elements(MeshSize size, const StopRequest* stop = nullptr) const;

    double area = 0;                      ///< Of all surfaces but those left out, m^2.
    Field<RegionId, std::uint8_t> unlit;  ///< What is left out; empty: nothing.
    LightRooms rooms;                     ///< By which errors are judged.

    /// The area of an element as errors are judged by it, m^2.
    double counted_area(const ElementTree& tree, ElementId e) const {
        return rooms.count() > 0 ? tree.area(e) * rooms.weight(tree, e) : tree.area(e);
    }

    /// The same as errors of what is gathered from it are, m^2.
    double important_area(const ElementTree& tree, ElementId e) const {
        return rooms.count() > 0 ? tree.area(e) * rooms.importance(tree, e) : tree.area(e);
    }

    /// Is there anything that emits, and anything that reflects? Without either no light is indirect.
    bool has_indirect_light() const {
        bool reflects = false;
        for (const Region& region : scene.regions())
            reflects |= max(scene.materials()[region.material].reflectance) > 0;
        return reflects && scene.has_light();
    }
};

}  // namespace exitance
