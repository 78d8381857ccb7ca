#include "exitance/gather/light_choice.hpp"

#include <algorithm>

#include "exitance/base/polygon.hpp"

namespace exitance {

LightChoice::LightChoice(const DirectLight& direct) : direct_(&direct), tree_(direct, EmitterTree::Windows::left_out) {
    for (std::uint32_t i = 0; i < tree_.sources().size(); ++i) by_region_.emplace_back(tree_.sources()[i].region, i);
    std::sort(by_region_.begin(), by_region_.end());
}

/// Power times the cosines at both ends over the squared distance. Cosines are raised by the angular size of the
/// cluster, so that none that is seen in part has no chance.
double LightChoice::light_of(const EmitterTree::Node& node, const Point& x, const Normal& n) const {
    double squared_size = node.radius * node.radius;
    if (node.is_leaf()) {
        const EmitterTree::Source& source = tree_.sources()[node.first];
        const double height = direct_->emitters()[source.name.emitter].plane.signed_distance(x);
        if (!(height > direct_->occluders().rounding())) return 0;
        squared_size = source.area;
    }
    const Vec3 w = node.centre - x;
    const double r2 = squared_norm(w) + squared_size, r = std::sqrt(r2), spread = std::sqrt(squared_size / r2);
    const double at_x = std::min(1.0, std::max(0.0, dot(n, w) / r) + spread);
    // The smallest angle between the direction to x and the normals of the cluster, which are in a cone.
    const double c = std::clamp(-dot(node.axis, w) / r, -1.0, 1.0), s = std::sqrt(1 - c * c);
    const double towards = c >= node.cosine ? 1 : c * node.cosine + s * node.sine;
    const double at_light = std::min(1.0, std::max(0.0, node.is_leaf() ? c : towards) + spread);
    return node.power * at_x * at_light / r2;
}

double LightChoice::chance_of_left(const EmitterTree::Node& node, const Point& x, const Normal& n) const {
    const double left = light_of(tree_.nodes()[node.left], x, n), right = light_of(tree_.nodes()[node.right], x, n);
    return left + right > 0 ? left / (left + right) : 0.5;
}

LightChoice::Chosen LightChoice::choose(const Point& x, const Normal& n, double u) const {
    const EmitterTree::Node* node = &tree_.nodes().front();
    double chance = 1;
    while (!node->is_leaf()) {
        const double left = chance_of_left(*node, x, n);
        const bool goes_left = u < left;
        u = goes_left ? u / left : (u - left) / (1 - left);
        chance *= goes_left ? left : 1 - left;
        node = &tree_.nodes()[goes_left ? node->left : node->right];
    }
    return {node->first, light_of(*node, x, n) > 0 ? chance : 0};
}

double LightChoice::chance_of(std::uint32_t number, const Point& x, const Normal& n) const {
    const EmitterTree::Node* node = &tree_.nodes().front();
    double chance = 1;
    while (!node->is_leaf() && chance > 0) {
        const double left = chance_of_left(*node, x, n);
        const bool goes_left = number < tree_.nodes()[node->left].last;
        chance *= goes_left ? left : 1 - left;
        node = &tree_.nodes()[goes_left ? node->left : node->right];
    }
    return light_of(*node, x, n) > 0 ? chance : 0;
}

std::optional<std::uint32_t> LightChoice::source_at(RegionId region, const Point& at) const {
    const auto first = std::lower_bound(by_region_.begin(), by_region_.end(), std::pair(region, std::uint32_t(0)));
    if (first == by_region_.end() || first->first != region) return std::nullopt;
    const auto is_last = [&](auto i) { return i + 1 == by_region_.end() || (i + 1)->first != region; };
    auto i = first;
    // If rounding places a hit next to all pieces, it counts for the last one.
    for (; !is_last(i); ++i) {
        const DirectLight::SourceName& name = source(i->second).name;
        if (contains(direct_->occluders().corners(name.piece), direct_->emitters()[name.emitter].plane.n, at)) break;
    }
    return i->second;
}

}  // namespace exitance
