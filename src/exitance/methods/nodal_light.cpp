#include "exitance/methods/nodal_light.hpp"

namespace exitance {
namespace {

const Material& material(const LinkSites& sites, ElementId e) {
    return sites.stage().scene.material(sites.tree().region(e));
}

/// The leaf of the direct projection that `e` is part of, or is.
ElementId projected(const DirectProjection& projection, const ElementTree& tree, ElementId e) {
    while (e.value >= projection.tree.size()) e = tree.parent(e);
    return e;
}

}  // namespace

Spectrum mean_over(const LinkSites& sites, const NodalField& field, ElementId e) {
    Spectrum sum;
    for (std::size_t k = 0; k < sites.nodes(); ++k) sum += sites.weight(e, k) * field.node(e, k);
    return sum;
}

ElementFit fit_polynomial(const LinkSites& sites, const NodalField& field, ElementId e) {
    const Patch& patch = sites.tree().patch(e);
    std::vector<WeightedPlace> places;
    std::vector<Spectrum> values;
    for (std::size_t k = 0; k < sites.nodes(); ++k) {
        if (sites.weight(e, k) == 0) continue;
        places.push_back({patch.coordinates(sites.node(e, k)), sites.weight(e, k)});
        values.push_back(field.node(e, k));
    }
    return ElementFit(sites.tree(), e, places, values);
}

std::vector<ElementId> rough_elements(const LinkSites& sites, const NodalField& E,
                                      const std::vector<ElementId>& elements, double allowed) {
    std::vector<ElementId> rough;
    for (ElementId e : elements) {
        const ElementFit bilinear = fit_polynomial(sites, E, e);
        double sum = 0;
        for (std::size_t k = 0; k < sites.nodes(); ++k) {
            const Spectrum off = E.node(e, k) - bilinear.at(sites.tree().patch(e).coordinates(sites.node(e, k)));
            sum += sites.weight(e, k) * squared(light_weight(material(sites, e)) * off) / static_cast<double>(bands);
        }
        if (sum > allowed * allowed) rough.push_back(e);
    }
    return rough;
}

void write_nodal_light(const LinkSites& sites, const NodalField& direct, const NodalField& indirect,
                       const DirectProjection& projection, GlobalLight& light) {
    for (ElementId e : light.numbering.leaves) {
        const Spectrum E_dir = mean_over(sites, direct, e), E_ind = mean_over(sites, indirect, e);
        light.direct.push_back(E_dir);
        light.indirect.push_back(E_ind);
        light.reflected.push_back(material(sites, e).reflectance * (E_dir + E_ind));
        const ElementFit polynomial = fit_polynomial(sites, indirect, e);
        std::array<Spectrum, 4>& indirect_corners = light.indirect_corners.emplace_back();
        std::array<Spectrum, 4>& direct_corners = light.direct_corners.emplace_back();
        const ElementId own = projected(projection, light.tree, e);
        const Patch &patch = light.tree.patch(e), &of_own = projection.tree.patch(own);
        for (int i = 0; i < patch.corner_count(); ++i) {
            indirect_corners[static_cast<std::size_t>(i)] = polynomial.corner(i);
            direct_corners[static_cast<std::size_t>(i)] = projection.at({own, of_own.coordinates(patch.corner(i))});
        }
    }
}

}  // namespace exitance
