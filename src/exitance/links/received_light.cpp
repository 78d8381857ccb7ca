#include "exitance/links/received_light.hpp"

#include "exitance/calibration/numbers.hpp"

namespace exitance {

FoundLink::FoundLink(const LinkDecision& decision, bool is_open)
    : link(decision.link),
      squared_error(static_cast<float>(decision.squared_error)),
      light(static_cast<float>(decision.light)),
      undersampling(static_cast<float>(decision.undersampling)),
      near(decision.near),
      open(is_open),
      cuts_receiver(decision.cuts_receiver) {
    for (std::size_t c = 0; c < departure.size(); ++c) departure[c] = static_cast<float>(decision.departure[c]);
}

void ReceivedLight::add(const FoundLink& link, const float* shadow, std::size_t nodes) {
    for (std::size_t c = 0; c < departure.size(); ++c) departure[c] += static_cast<double>(link.departure[c]);
    for (std::size_t k = 0; shadow && k < nodes; ++k) {
        shadowed[k] += static_cast<double>(shadow[k]);
        variance[k] += static_cast<double>(shadow[nodes + k]);
    }
}

double ReceivedLight::squared_error(const LinkSites& sites, ElementId e) const {
    double mean = 0, square = 0, noise = 0;
    for (std::size_t k = 0; k < sites.nodes(); ++k) {
        const double w = sites.weight(e, k);
        mean += w * shadowed[k], square += w * shadowed[k] * shadowed[k], noise += w * variance[k];
    }
    constexpr double of_linear = 0.5;
    const double share = sites.nodes() > 4 ? calibrated::shadow_share_of_quadratics : of_linear;
    return mean_square(departure) + share * share * std::max(0.0, square - mean * mean - noise);
}

}  // namespace exitance
