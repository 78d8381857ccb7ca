#include "exitance/visibility/traced_scene.hpp"

#include "exitance/base/triangulation.hpp"
#include "exitance/scene/other_side.hpp"

namespace exitance {

TracedScene::TracedScene(const Scene& s)
    : scene(&s),
      centre(s.box().centre()),
      scale(std::exp2(-std::ilogb(s.size()))),
      frame(find_tracing_frame(s)),
      lift_off(lift * s.size()),
      faces(s.surfaces().size()),
      other_side(other_sides_of_surfaces(s)) {
    for (SurfaceId id : s.surfaces().ids())
        faces[id] = {s.surfaces()[id].normal, s.outline(id)[0], s.surfaces()[id].region};
}

Triangles TracedScene::surfaces(std::vector<SurfaceId>& surface_of) const {
    Triangles out;
    for (SurfaceId id : scene->surfaces().ids()) {
        if (is_second_side(*scene, other_side, id)) continue;  // one triangle represents both faces
        const std::span<const Point> outline = scene->outline(id);
        const auto first = static_cast<std::uint32_t>(out.corners.size());
        const Vec3 lifted = raised(faces[id].region) * faces[id].normal;
        for (const Point& p : outline) out.corners.push_back(local(p + lifted));
        for (const auto& t : triangulate(outline, scene->surfaces()[id].normal)) {
            out.triangles.push_back({first + t[0], first + t[1], first + t[2]});
            surface_of.push_back(id);
        }
    }
    return out;
}

Triangles TracedScene::panes(std::vector<std::uint32_t>& pane_of) const {
    Triangles out;
    for (std::uint32_t number = 0; const Pane& pane : scene->panes()) {
        const auto first = static_cast<std::uint32_t>(out.corners.size());
        for (const Point& p : pane.corners) out.corners.push_back(local(p));
        for (std::uint32_t i = 2; i < pane.corners.size(); ++i) {
            out.triangles.push_back({first, first + i - 1, first + i});
            pane_of.push_back(number);
        }
        ++number;
    }
    return out;
}

NarrowGaps TracedScene::narrow_gaps() const {
    // A share of the height at which rays start: the start and a face must not be the same in single precision, which
    // has an error of a sixteenth of `lift`. Derived from 1 + 1 / 16, with a margin.
    constexpr double gap_reach = 1.25;
    Field<RegionId, double> reach, raised_by;
    for (RegionId r : scene->regions().ids()) reach.add(gap_reach * (lift_off + raised(r))), raised_by.add(raised(r));
    return {*scene, reach, raised_by};
}

}  // namespace exitance
