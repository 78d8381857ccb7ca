#include <algorithm>

#include "exitance/calibration/numbers.hpp"
#include "exitance/methods/patch_steps.hpp"
#include "exitance/methods/shooting_setup.hpp"

namespace exitance {
namespace {

/// Reflected light of a leaf, W/m^2, mean over bands.
double light_of(const ShootingSetup& setup, ElementId leaf) {
    const std::size_t i = setup.numbering.number[leaf];
    return mean(setup.reflectance[i] *
                (setup.shoots_direct_light() ? setup.irradiance[i] : setup.direct[i] + setup.irradiance[i]));
}

}  // namespace

/// Substructuring radiosity [Cohen86], shooting form: patches shoot, and elements, which are finer where light varies
/// strongly, receive. Refining during the first shots would cut along gradients that later shots even out. Therefore
/// all light is solved on the patches first. Then elements are split by the converged light, in sweeps, and gather the
/// light that the patches have sent. Finally the patches take their elements' means and shoot the difference
/// [Willmott97]. One form factor per element and patch.
GlobalLight solve_substructuring(const MethodInput& input) {
    input.progress.phase("mesh");
    MeshSize coarse = input.knobs.solve_mesh;
    if (!input.options.mesh_size)
        coarse = {calibrated::patch_edge * coarse.edge, std::max(0, coarse.grading_levels - 1)};
    const DirectProjection direct =
        project_direct_light(input.stage, {.mesh = coarse, .tolerance = 2 * input.knobs.direct_tolerance}, input.stop);
    ShootingSetup setup(input, direct);
    input.progress.phase("shoot");
    SolveReport report = setup.run();

    double mean_light = 0;
    for (std::size_t p = 0; p < setup.patches.size(); ++p)
        mean_light += setup.patch_area[p] * mean(setup.sent[p]) / input.stage.area;
    const double threshold = steep_step(input.options.error_target(), mean_light);
    const double min_area = input.options.min_area.value_or(calibrated::min_patch_element * input.stage.area);
    for (int sweep = 0; sweep < patch_sweeps && !input.stop.requested(); ++sweep) {
        input.progress.phase("refine");
        const ElementLocator locator(setup.tree, input.stage.scene.regions().size());
        const auto light = [&](ElementId leaf) { return light_of(setup, leaf); };
        std::vector<ElementId> steep;
        for (std::size_t i = 0; i < setup.numbering.leaves.size(); ++i) {
            const ElementId leaf = setup.numbering.leaves[i];
            if (setup.area[i] > 2 * min_area && steepest_step(setup.tree, locator, leaf, light) > threshold)
                steep.push_back(leaf);
        }
        if (steep.empty()) break;
        setup.split(steep);
    }
    setup.update_patches();
    const std::size_t shots = report.iterations;
    report = setup.run();
    report.iterations += shots;
    return setup.finish(report);
}

}  // namespace exitance
