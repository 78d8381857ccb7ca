#include "exitance/transport/fit_together.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "exitance/base/parallel.hpp"
#include "exitance/direct/distant_means.hpp"
#include "exitance/mesh/spatial_order.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

constexpr double unknown = -1;  ///< Value of `misfit_squared` that marks elements that are not done.

DirectFit as_constant(const DistantMeans::Mean& found, double w) {
    DirectFit out;
    out.corners.fill(found.irradiance);
    out.mean = out.parallel = found.irradiance;
    out.misfit_squared = out.noise_squared = w * w * found.variance;
    return out;
}

}  // namespace

bool may_fit_together(const Stage& stage) {
    return DistantMeans::suits(stage.direct);
}

std::vector<ElementId> fit_together(const Stage& stage, const ElementTree& tree, const std::vector<ElementId>& elements,
                                    double minor_area, const std::function<NoiseAllowed(ElementId)>& noise_on,
                                    Field<ElementId, DirectFit>& fit, const StopRequest& stop) {
    constexpr std::size_t together = 64;  // elements that are traced at once: about 100 packets of 16 rays
    const Scene& scene = stage.scene;
    std::vector<ElementId> small;
    std::copy_if(elements.begin(), elements.end(), std::back_inserter(small),
                 [&](ElementId e) { return tree.area(e) < minor_area && scene.behind(tree.region(e)).is_none(); });
    sort_by_place(tree, small);
    const DistantMeans means(stage.direct, stage.tracer);
    fit.resize(tree.size());
    for (const ElementId e : small) fit[e].misfit_squared = unknown;
    shared_ranges_of(
        fit.span(), small.size(), together,
        [&](std::size_t begin, std::size_t end) {
            DistantMeans::Workspace room;
            std::vector<LightAccuracy> accuracy;
            const auto block = std::span<const ElementId>(small).subspan(begin, end - begin);
            for (const ElementId e : block)
                accuracy.push_back(accuracy_on(mean(light_weight(scene.material(tree.region(e)))), noise_on(e)));
            if (stop.requested()) return;
            std::vector<DistantMeans::Mean> found(block.size());
            means.find(tree, block, accuracy, room, found);
            for (std::size_t i = 0; i < block.size(); ++i)
                if (found[i].is_found)
                    fit[block[i]] = as_constant(found[i], mean(light_weight(scene.material(tree.region(block[i])))));
        },
        [&](std::size_t i) -> DirectFit& { return fit[small[i]]; },
        {"direct light", [&](std::size_t i) { return tree.region(small[i]).value; }});
    std::vector<std::uint8_t> is_done(tree.size(), 0);
    for (const ElementId e : small) is_done[e.value] = fit[e].misfit_squared != unknown;
    std::vector<ElementId> rest;
    std::copy_if(elements.begin(), elements.end(), std::back_inserter(rest),
                 [&](ElementId e) { return !is_done[e.value]; });
    return rest;
}

}  // namespace exitance
