#include "exitance/methods/hierarchical/hand_over.hpp"

#include <cmath>

#include "exitance/calibration/numbers.hpp"
#include "exitance/mesh/adaptive.hpp"

namespace exitance {
namespace {

/// Splits leaves for delivery until linear functions approximate the quadratic ones.
void cut_for_delivery(Hierarchy& h, const NodalLight& E) {
    const double allowed =
        calibrated::delivery_share * h.input.knobs.link_error * h.light_norm() / std::sqrt(h.input.stage.area);
    ElementTree& tree = h.light.tree;
    std::vector<ElementId> active = tree.leaves();
    constexpr int max_levels = 3;
    for (int level = 0; level < max_levels && !active.empty(); ++level) {
        const std::vector<ElementId> too_coarse = rough_elements(h.sites, E, active, allowed);
        for (ElementId e : too_coarse) refine_element(tree, e);
        active.clear();
        for (ElementId e : too_coarse)
            for (ElementId child : tree.children(e)) active.push_back(child);
    }
    h.light.numbering = LeafNumbering(tree);
    h.light.kept.clear();  // these values belong to the leaves before the split
}

}  // namespace

void hand_over(Hierarchy& h) {
    GlobalLight& light = h.light;
    // The mesh below the elements with coefficients counts as direct light's.
    const std::size_t element_bytes = light.tree.memory_bytes() * h.sites.size() / light.tree.size() +
                                      h.sites.memory_bytes() + h.reflected_direct_below.memory_bytes() +
                                      h.refiner.field_bytes() + 2 * h.radiosity.memory_bytes();
    const NodalField F_b = h.gather();
    const NodalLight E = [&](ElementId e) { return h.indirect_light(F_b, e); };
    if (h.basis.order() > 2 && (light.delivers() || h.input.options.smoothing)) cut_for_delivery(h, E);
    write_nodal_light(h.sites, E, h.input.direct, light);
    light.work.links = h.system.size();
    if (h.input.options.keep_links) light.kept_links = h.system.links().list();
    light.work.link_memory_bytes = h.system.memory_bytes();
    light.work.element_memory_bytes = element_bytes;
    light.work.elements_by_level = h.sites.count_by_level();
    light.work.rays += h.rays();
    light.work.form_factors = h.refiner.form_factors();
}

}  // namespace exitance
