#include "exitance/mesh/dm_tree/light_layers.hpp"

namespace exitance {

std::size_t LightLayers::size() const {
    std::size_t sum = 0;
    for (const Sheet& sheet : sheets) sum += sheet.light.size();
    return sum;
}

std::size_t LightLayers::memory_bytes() const {
    std::size_t sum = 0;
    for (const Sheet& sheet : sheets) sum += sheet.light.memory_bytes();
    return sum;
}

LayerFunction::LayerFunction(const LightLayers& layers, const Scene& scene)
    : layers_(&layers), scene_(&scene), first_(scene.regions().size() + 1) {
    for (const LightLayers::Sheet& sheet : layers.sheets) ++first_[sheet.region.value + 1];
    for (std::size_t r = 1; r < first_.size(); ++r) first_[r] += first_[r - 1];
}

Spectrum LayerFunction::at(RegionId region, const Point& p) const {
    Spectrum sum;
    if (region.is_none()) return sum;
    const std::uint32_t begin = first_[region.value], end = first_[region.value + 1];
    if (begin == end) return sum;
    const Vec2 place = layer_place(scene_->regions()[region], p);
    for (std::uint32_t i = begin; i < end; ++i) {
        const LightLayers::Sheet& sheet = layers_->sheets[i];
        sum += sheet.light.at(place) * sheet.colour;
    }
    return sum;
}

Vec2 layer_place(const Region& region, const Point& p) {
    const Frame frame(region.plane.n);
    const Vec3 d = p - region.loops.front().front();
    return {dot(frame.u, d), dot(frame.v, d)};
}

}  // namespace exitance
