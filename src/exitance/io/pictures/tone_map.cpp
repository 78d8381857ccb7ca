#include "exitance/io/pictures/tone_map.hpp"

#include <cmath>

namespace exitance {

namespace {

/// The curve of [Narkowicz15], with its argument scaled so that 0.18 is mapped to 0.18.
double filmic(double light) {
    const double x = 0.7232 * light;
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

}  // namespace

DisplayColour ToneMap::operator()(const Spectrum& light) const {
    DisplayColour colour = red_green_blue(light);
    const double level = scale * mean(light);
    for (double& c : colour) {
        c = std::max(0.0, scale * c);
        if (curve == ToneCurve::photographic && level > 0) c *= (1 + level / (white * white)) / (1 + level);
        if (curve == ToneCurve::filmic) c = c < 1e6 ? filmic(c) : 1;
        c = std::min(c, 1.0);
    }
    return colour;
}

ToneMap make_tone_map(const Solution& solution) {
    const ElementTree& tree = solution.interpolant.tree;
    double sum = 0, area = 0;
    for (ElementId e : tree.ids()) {
        if (!tree.is_leaf(e)) continue;
        const Material& material = solution.scene.material(tree.region(e));
        if (material.emits()) continue;
        const double reflected = mean(material.reflectance * solution.interpolant.at({e, tree.centre(e)}));
        if (!(reflected > 0)) continue;
        sum += tree.area(e) * std::log(reflected), area += tree.area(e);
    }
    ToneMap map;
    map.scale = area > 0 ? 0.18 / std::exp(sum / area) : 1;
    return map;
}

double srgb_encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace exitance
