#include "exitance/io/tone_map.hpp"

#include <cmath>

namespace exitance {

DisplayColour ToneMap::operator()(const Spectrum& light) const {
    const double level = scale * mean(light);
    if (!(level > 0)) return {0, 0, 0};
    const double shown = scale * (1 + level / (white * white)) / (1 + level);  // per unit of light
    DisplayColour colour;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t band = bands == 3 ? i : i * (bands - 1) / 2;  // other counts: the ends and the middle
        colour[i] = std::clamp(shown * light[band], 0.0, 1.0);
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
