#include "exitance/solve/global_light.hpp"

namespace exitance {

double GlobalLight::mean_reflected(double surface_area) const {
    double flux = 0;
    for (std::size_t i = 0; i < reflected.size(); ++i) flux += tree.area(numbering.leaves[i]) * mean(reflected[i]);
    return surface_area > 0 ? flux / surface_area : 0;
}

std::vector<Spectrum> leaf_reflectances(const Scene& scene, const ElementTree& tree, const LeafNumbering& numbering) {
    std::vector<Spectrum> rho;
    rho.reserve(numbering.leaves.size());
    for (ElementId e : numbering.leaves) rho.push_back(scene.material(tree.region(e)).reflectance);
    return rho;
}

}  // namespace exitance
