#include "exitance/basis/misfit_along.hpp"

namespace exitance {

std::array<double, 2> misfit_along(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
                                   std::span<const Spectrum> rest, Degree degree) {
    if (tree.is_cell(e) || tree.patch(e).is_triangle()) return {};
    const auto P = [&](double x) {
        return degree == Degree::curved ? std::sqrt(7.0) * x * (5 * x * x - 3) / 2
                                        : std::sqrt(5.0) * (3 * x * x - 1) / 2;
    };
    std::array<Spectrum, 2> constant_part{}, linear_part{};
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double s = 2 * places[i].uv.x - 1, t = 2 * places[i].uv.y - 1;
        const Spectrum value = places[i].weight * rest[i];
        constant_part[0] += P(s) * value, linear_part[0] += std::sqrt(3.0) * t * P(s) * value;
        constant_part[1] += P(t) * value, linear_part[1] += std::sqrt(3.0) * s * P(t) * value;
    }
    const auto square = [&](std::size_t k) {
        return (squared(constant_part[k]) + squared(linear_part[k])) / static_cast<double>(bands);
    };
    return {square(0), square(1)};
}

}  // namespace exitance
