#include "exitance/transport/direct_projection.hpp"

#include "exitance/core/parallel.hpp"
#include "exitance/transport/hemisphere.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

std::vector<Spectrum> project_direct_light(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                                           double points, std::uint64_t seed) {
    const std::size_t n = numbering.leaves.size();
    const RayBudget budget{.average = points, .least = 1, .most = 64};
    const double mean_area = stage.area / static_cast<double>(n);
    std::vector<Spectrum> mean(n);
    parallel_ranges(n, 16, [&](std::size_t begin, std::size_t end) {
        DirectLight::Workspace workspace;
        for (std::size_t i = begin; i < end; ++i) {
            const ElementId e = numbering.leaves[i];
            const Patch& patch = tree.patch(e);
            const Normal n = stage.scene.regions()[tree.region(e)].plane.n;
            const unsigned count = budget.rays(tree.area(e), mean_area);
            const ScrambledSobol places(hash(seed, static_cast<std::uint64_t>(Stream::direct), i));
            for (std::uint32_t k = 0; k < count; ++k) {
                const Point x = patch.at(tree.uniform(e, places(k, 0), places(k, 1)));
                mean[i] += stage.direct.irradiance(x, n, tree.region(e), workspace) / count;
            }
        }
    });
    return mean;
}

}  // namespace exitance
