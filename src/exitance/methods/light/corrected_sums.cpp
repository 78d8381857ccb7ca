#include "exitance/methods/light/corrected_sums.hpp"

#include "exitance/base/parallel.hpp"
#include "exitance/basis/element_rule.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/gather/element_gather.hpp"
#include "exitance/methods/light/light_functions.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

/// Mean of rho (E_dir + H b) - b over every leaf of the method, by leaf number, W/m^2. `parts`: functions whose sum is
/// b + c M.
std::vector<Spectrum> mean_residual(const Stage& stage, const GlobalLight& light, const ElementFunction& indirect,
                                    const std::vector<ElementFunction>& parts, double share) {
    std::vector<ElementGather> sums;
    for (const ElementFunction& part : parts) sums.emplace_back(stage, part);
    const ElementLocator locator(indirect.tree, stage.scene.regions().size());
    std::vector<Spectrum> out(light.numbering.leaves.size());
    shared_ranges(
        out.size(), 8,
        [&](std::size_t begin, std::size_t end) {
            ElementGather::Workspace workspace;
            for (std::size_t i = begin; i < end; ++i) {
                const ElementId e = light.numbering.leaves[i];
                const RegionId region = light.tree.region(e);
                const Normal& n = stage.scene.regions()[region].plane.n;
                const Spectrum& rho = stage.scene.material(region).reflectance;
                for (const auto& [uv, weight] : element_rule(light.tree, e, RuleOrder::nodes)) {
                    const Point x = light.tree.patch(e).at(uv);
                    if (stage.occluders.is_covered(x, n, region)) continue;
                    Spectrum arriving;
                    for (const ElementGather& sum : sums) arriving += sum(x, n, region, share, workspace);
                    out[i] += weight * (rho * (arriving - indirect.at(locator.find(region, x))));
                }
            }
        },
        [&](std::size_t i) -> Spectrum& { return out[i]; }, {"refine"});
    return out;
}

}  // namespace

std::vector<ElementFunction> corrected_sums(const RefinementInput& in, double share) {
    const GlobalLight& light = in.light;
    const Scene& scene = in.stage.scene;
    std::vector<ElementFunction> out = delivered_functions(scene, in.indirect, in.direct, Spectrum(1.0) - in.c, in.c);
    const std::vector<Spectrum> r = mean_residual(in.stage, light, in.indirect, out, share);
    const ElementLocator locator(light.tree, scene.regions().size());
    const RayRows F(in.stage, {light.tree, light.numbering, locator},
                    {in.rays, in.seed, Dealing::by_element, RowsHeld::by_owner});
    std::vector<Spectrum> e = r;
    solve_radiosity(
        {F, leaf_reflectances(scene, light.tree, light.numbering), r, leaf_areas(light.tree, light.numbering)},
        Relaxation::gmres, e, {.residual = calibrated::refined_residual, .max_iterations = 200});
    ElementFunction& b = out.front();
    for (ElementId leaf : b.tree.leaves()) {
        const Point x = b.tree.patch(leaf).at(b.tree.centre(leaf));
        const Spectrum& more = e[light.numbering.number[locator.find(b.tree.region(leaf), x).element]];
        for (int i = 0; i < b.tree.patch(leaf).corner_count(); ++i)
            for (std::size_t k = 0; k < bands; ++k)
                b.values[b.first_value[leaf] + static_cast<std::size_t>(i)][k] += static_cast<float>(more[k]);
    }
    return out;
}

}  // namespace exitance
