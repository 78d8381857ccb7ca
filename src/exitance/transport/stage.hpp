#pragma once

#include <atomic>
#include <vector>

#include "exitance/mesh/contact_lines.hpp"
#include "exitance/mesh/solve_mesh.hpp"
#include "exitance/transport/direct_light.hpp"
#include "exitance/transport/occluders.hpp"
#include "exitance/transport/visibility.hpp"

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
          direct(s, occluders) {
        for (const Piece& piece : pieces) area += piece.patch.area();
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
    /// Elements over all pieces, graded towards concave edges and cut where other polygons touch them.
    ElementTree make_elements(MeshSize size) const {
        ElementTree tree = make_mesh(pieces, concave, size);
        cut_along_contacts(tree, tree.leaves(), contacts);
        return tree;
    }

    double area = 0;  ///< Of all surfaces, m^2.

    /// Is there anything that emits, and anything that reflects? Without either no light is indirect.
    bool has_indirect_light() const {
        bool reflects = false;
        for (const Region& region : scene.regions())
            reflects |= max(scene.materials()[region.material].reflectance) > 0;
        return reflects && scene.has_light();
    }
};

}  // namespace exitance
