#include "exitance/reconstruct/energy.hpp"

#include <numeric>

namespace exitance {
namespace {

double sum(const Spectrum& s) {
    return std::accumulate(s.value.begin(), s.value.end(), 0.0);
}

}  // namespace

EnergyBalance energy_balance(const Solution& solution, const DirectProjection& direct) {
    const Scene& scene = solution.scene;
    EnergyBalance out;
    for (const Region& region : scene.regions())
        out.emitted += region.area * sum(scene.materials()[region.material].exitance);
    for (const PunctualLight& light : scene.lights()) out.emitted += sum(light.power());
    // Parallel light comes from outside: what meets a surface counts as emitted.
    for (ElementId e : direct.tree.leaves()) out.emitted += direct.tree.area(e) * sum(direct.fit[e].parallel);
    const auto absorb = [&](RegionId region, double area, const Spectrum& E) {
        out.absorbed += area * sum((Spectrum(1.0) - scene.material(region).reflectance) * E);
    };
    if (!solution.direct_in_elements)
        for (ElementId e : direct.tree.leaves())
            absorb(direct.tree.region(e), direct.tree.area(e),
                   (Spectrum(1.0) - solution.direct_share) * direct.fit[e].mean);
    // A linear or bilinear function has its mean at the centre of its element.
    const ElementTree& tree = solution.indirect.tree;
    for (ElementId e : tree.leaves()) absorb(tree.region(e), tree.area(e), solution.indirect.at({e, tree.centre(e)}));
    out.defect = out.emitted > 0 ? std::abs(out.emitted - out.absorbed) / out.emitted : 0;
    return out;
}

double mean_direct_light(const Stage& stage, const DirectProjection& direct) {
    double flux = 0;
    for (ElementId e : direct.tree.leaves()) flux += direct.tree.area(e) * mean(direct.fit[e].mean);
    return flux / stage.area;
}

}  // namespace exitance
