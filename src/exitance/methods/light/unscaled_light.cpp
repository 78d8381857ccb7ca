#include "exitance/methods/light/unscaled_light.hpp"

#include <cmath>

#include "exitance/scene/photometric_units.hpp"

namespace exitance {

Spectrum inverse(const Spectrum& s) {
    Spectrum out;
    for (std::size_t band = 0; band < bands; ++band) out[band] = 1 / s[band];
    return out;
}

Spectrum unscaled_sent(const Scene& scene, const GlobalLight& light, const Spectrum& direct, const Spectrum& returned,
                       const Spectrum& c) {
    Spectrum sent, unscaled;  // W
    for (RegionId r : scene.regions().ids()) {
        const Spectrum power = scene.regions()[r].area * (c * scene.material(r).exitance);
        sent += power, unscaled += power;
    }
    for (std::size_t i = 0; i < light.reflected.size(); ++i) {
        const ElementId e = light.numbering.leaves[i];
        const double area = light.tree.area(e);
        const Spectrum all = area * light.reflected[i];
        const Spectrum again = area * (scene.material(light.tree.region(e)).reflectance * light.indirect[i]);
        sent += all, unscaled += direct * (all - again + returned * again);
    }
    Spectrum out(1.0);
    for (std::size_t band = 0; band < bands; ++band)
        if (sent[band] > 0) out[band] = unscaled[band] / sent[band];
    return out;
}

double energy_defect_before(const EnergyBalance& energy, const Solution& solution, const DirectProjection& direct,
                            const UnscaledShare& unscaled) {
    if (!(energy.emitted > 0)) return 0;
    Spectrum added;  // W
    const auto absorb = [&](RegionId region, double area, const Spectrum& more) {
        added += area * ((Spectrum(1.0) - solution.scene.material(region).reflectance) * more);
    };
    const Spectrum of_direct = (Spectrum(1.0) - solution.direct_share) * (Spectrum(1.0) - unscaled.direct);
    if (solution.discontinuity.empty() && !solution.layers && !solution.direct_in_elements)
        for (ElementId e : direct.tree.leaves())
            absorb(direct.tree.region(e), direct.tree.area(e), of_direct * direct.fit[e].mean);
    const ElementTree& tree = solution.indirect.tree;
    // A linear or bilinear function has its mean at the centre of its element.
    for (ElementId e : tree.leaves())
        absorb(tree.region(e), tree.area(e),
               (Spectrum(1.0) - unscaled.indirect) * solution.indirect.at({e, tree.centre(e)}));
    const double more = own_unit(solution.scene.is_photometric())(added);
    return std::abs(energy.emitted - (energy.absorbed - more) - energy.escaped) / energy.emitted;
}

}  // namespace exitance
