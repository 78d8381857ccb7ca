#include "exitance/methods/hierarchical/ray_correction.hpp"

#include "exitance/base/parallel.hpp"
#include "exitance/methods/constant_elements.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

void correct_by_rays(Hierarchy& h) {
    h.input.progress.phase("correct");
    GlobalLight& light = h.light;
    const std::vector<ElementId>& leaves = light.numbering.leaves;
    NodalField F_b = h.gather();
    light.direct.resize(leaves.size()), light.reflected.resize(leaves.size());
    parallel_for(leaves.size(), 64, [&](std::size_t i) {
        const ElementId e = leaves[i];
        light.direct[i] = mean_over(h.sites, projected_light(h.sites, h.input.direct, e), e);
        light.reflected[i] =
            h.material(e).reflectance * (light.direct[i] + mean_over(h.sites, h.indirect_light(F_b, e), e));
    });
    const ElementLocator locator(light.tree, h.input.stage.scene.regions().size());
    const RayRows rows(h.input.stage, {light.tree, light.numbering, locator},
                       {h.input.knobs.solve_rays, h.input.options.seed});
    light.work.rays += rows.rays();
    light.kept = kept_light(rows, h.input.stage);
    const std::size_t before = light.report.iterations;
    relax_constant_elements(h.input, rows, light);
    light.report.iterations += before;
    h.missed = Field<ElementId, Spectrum>(light.tree.size());
    const auto find_missed = [&] {
        parallel_for(leaves.size(), 64, [&](std::size_t i) {
            h.missed[leaves[i]] += light.indirect[i] - mean_over(h.sites, h.indirect_light(F_b, leaves[i]), leaves[i]);
        });
    };
    find_missed();
    h.radiosity = h.pulled([&](ElementId leaf) {
        NodalValues out = projected_light(h.sites, h.input.direct, leaf);
        const NodalValues E_ind = h.indirect_light(F_b, leaf);
        for (std::size_t k = 0; k < h.sites.nodes(); ++k) out[k] = h.material(leaf).reflectance * (out[k] + E_ind[k]);
        return out;
    });
    F_b = h.gather();
    find_missed();
}

}  // namespace exitance
