#include "exitance/scene/point_light.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {

double PunctualLight::share_towards(const Normal& w) const {
    if (kind != Kind::spot) return 1;
    const double outer = std::cos(outer_cone), inner = std::cos(inner_cone), at = dot(direction, w);
    if (at <= outer) return 0;
    if (at >= inner) return 1;
    const double t = (at - outer) / (inner - outer);
    return t * t;
}

Spectrum PunctualLight::power() const {
    if (kind == Kind::directional) return {};
    if (kind == Kind::point) return 4 * pi * intensity;
    // 2 pi (1 - cos inner) for the full intensity, then 2 pi int t^2 d(cos) with t from 0 to 1 over cos inner - cos
    // outer.
    const double outer = std::cos(outer_cone), inner = std::cos(inner_cone);
    return 2 * pi * ((1 - inner) + (inner - outer) / 3) * intensity;
}

}  // namespace exitance
