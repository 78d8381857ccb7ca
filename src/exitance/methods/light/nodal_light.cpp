#include "exitance/methods/light/nodal_light.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

const Material& material(const LinkSites& sites, ElementId e) {
    return sites.stage().scene.material(sites.tree().region(e));
}

/// Returns the leaf of the direct projection that is or contains `e`.
ElementId projected(const DirectProjection& projection, const ElementTree& tree, ElementId e) {
    while (e.value >= projection.tree.size()) e = tree.parent(e);
    return e;
}

}  // namespace

Spectrum mean_over(const LinkSites& sites, const NodalValues& values, ElementId e) {
    Spectrum sum;
    for (std::size_t k = 0; k < sites.nodes(); ++k) sum += sites.weight(e, k) * values[k];
    return sum;
}

void keep_positive(const ElementTree& tree, ElementId e, std::array<Spectrum, 4>& corners) {
    const Patch& patch = tree.patch(e);
    const auto count = static_cast<std::size_t>(patch.corner_count());
    const auto at = [&](const Vec2& uv, std::size_t band) {
        const double u = uv.x, v = uv.y;
        if (patch.is_triangle()) return (1 - u - v) * corners[0][band] + u * corners[1][band] + v * corners[2][band];
        return (1 - v) * ((1 - u) * corners[0][band] + u * corners[1][band]) +
               v * (u * corners[2][band] + (1 - u) * corners[3][band]);
    };
    const std::vector<Vec2> outline = tree.domain(e);
    const Vec2 centre = tree.centre(e);
    for (std::size_t band = 0; band < bands; ++band) {
        double lowest = 0;
        for (const Vec2& uv : outline) lowest = std::min(lowest, at(uv, band));
        if (lowest >= 0) continue;
        const double mean = std::max(0.0, at(centre, band)), share = mean / (mean - lowest);
        for (std::size_t k = 0; k < count; ++k) corners[k][band] = mean + share * (corners[k][band] - mean);
    }
}

ElementFit fit_polynomial(const LinkSites& sites, const NodalValues& values, ElementId e) {
    const Patch& patch = sites.tree().patch(e);
    const Patch frame = sites.frame(e);
    std::vector<WeightedPlace> places;
    std::vector<Spectrum> at_places;
    for (std::size_t k = 0; k < sites.nodes(); ++k) {
        if (sites.weight(e, k) == 0) continue;
        places.push_back({patch.coordinates(sites.node(frame, k)), sites.weight(e, k)});
        at_places.push_back(values[k]);
    }
    return ElementFit(sites.tree(), e, places, at_places);
}

std::vector<ElementId> rough_elements(const LinkSites& sites, const NodalLight& E,
                                      const std::vector<ElementId>& elements, double allowed) {
    std::vector<std::uint8_t> is_too_coarse(elements.size());
    parallel_for(elements.size(), 64, [&](std::size_t i) {
        const ElementId e = elements[i];
        const NodalValues values = E(e);
        const ElementFit bilinear = fit_polynomial(sites, values, e);
        const Patch frame = sites.frame(e);
        const Spectrum weight = light_weight(material(sites, e));
        double sum = 0;
        for (std::size_t k = 0; k < sites.nodes(); ++k) {
            const Spectrum off = values[k] - bilinear.at(sites.tree().patch(e).coordinates(sites.node(frame, k)));
            sum += sites.weight(e, k) * squared(weight * off) / static_cast<double>(bands);
        }
        is_too_coarse[i] = sum > allowed * allowed;
    });
    std::vector<ElementId> too_coarse;
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (is_too_coarse[i]) too_coarse.push_back(elements[i]);
    return too_coarse;
}

NodalValues projected_light(const LinkSites& sites, const DirectProjection& projection, ElementId leaf) {
    const ElementId own = projected(projection, sites.tree(), leaf);
    NodalValues out{};
    if (sites.nodes() == 1) {
        out[0] = projection.fit[own].mean;
        return out;
    }
    const Patch& patch = projection.tree.patch(own);
    const Patch frame = sites.frame(leaf);
    for (std::size_t k = 0; k < sites.nodes(); ++k)
        out[k] = projection.at({own, patch.coordinates(sites.node(frame, k))});
    return out;
}

void write_nodal_light(const LinkSites& sites, const NodalLight& indirect, const DirectProjection& projection,
                       GlobalLight& light) {
    const std::vector<ElementId>& leaves = light.numbering.leaves;
    light.direct.resize(leaves.size()), light.indirect.resize(leaves.size()), light.reflected.resize(leaves.size());
    light.indirect_corners.resize(leaves.size()), light.direct_corners.resize(leaves.size());
    parallel_for(leaves.size(), 64, [&](std::size_t leaf) {
        const ElementId e = leaves[leaf];
        const NodalValues E = indirect(e);
        light.direct[leaf] = mean_over(sites, projected_light(sites, projection, e), e);
        light.indirect[leaf] = mean_over(sites, E, e);
        light.reflected[leaf] = material(sites, e).reflectance * (light.direct[leaf] + light.indirect[leaf]);
        const ElementFit polynomial = fit_polynomial(sites, E, e);
        const ElementId own = projected(projection, light.tree, e);
        const Patch &patch = light.tree.patch(e), &of_own = projection.tree.patch(own);
        for (int i = 0; i < patch.corner_count(); ++i) {
            const auto corner = static_cast<std::size_t>(i);
            light.indirect_corners[leaf][corner] = polynomial.corner(i);
            light.direct_corners[leaf][corner] = projection.at({own, of_own.coordinates(patch.corner(i))});
        }
        keep_positive(light.tree, e, light.indirect_corners[leaf]);
    });
}

}  // namespace exitance
