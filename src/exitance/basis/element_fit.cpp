#include "exitance/basis/element_fit.hpp"

namespace exitance {

ElementFit::ElementFit(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
                       std::span<const Spectrum> values)
    : polynomials_(tree, e, places, false) {
    const Patch& patch = tree.patch(e);
    for (int i = 0; i < patch.corner_count(); ++i) corner_uv_[static_cast<std::size_t>(i)] = patch.corner_uv(i);
    for (std::size_t p = 0; p < places.size(); ++p) {
        const ElementPolynomials::Values phi = polynomials_.at(places[p].uv);
        for (std::size_t k = 0; k < freedoms(); ++k) coefficient_[k] += (places[p].weight * phi[k]) * values[p];
    }
}

Spectrum ElementFit::at(Vec2 uv) const {
    const ElementPolynomials::Values phi = polynomials_.at(uv);
    Spectrum sum;
    for (std::size_t k = 0; k < freedoms(); ++k) sum += phi[k] * coefficient_[k];
    return sum;
}

}  // namespace exitance
