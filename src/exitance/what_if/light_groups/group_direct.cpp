#include "exitance/what_if/light_groups/group_direct.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/transport/direct_fit.hpp"

namespace exitance {

Scene alone(const Scene& scene, const EmitterGroup& group) {
    Scene out = scene;
    for (const MaterialId m : scene.materials().ids()) {
        const bool own = std::find(group.materials.begin(), group.materials.end(), m) != group.materials.end();
        if (!own && scene.materials()[m].emits()) out.relight(m, scene.materials()[m].reflectance, Spectrum());
    }
    std::vector<PunctualLight> lights;
    for (const std::uint32_t i : group.lights) lights.push_back(scene.lights()[i]);
    out.put_lights(std::move(lights));
    if (!group.is_distant) out.put_under({});
    return out;
}

std::vector<DirectFit> fit_direct_of(const Scene& lit, const Stage& stage, const ElementTree& tree,
                                     std::span<const ElementId> elements, double tolerance, const StopRequest& stop) {
    const DirectLight direct(lit, stage.occluders);
    const PlaceLight places(direct, stage.tracer);
    const FittedLight light(stage, direct, places);
    std::vector<DirectFit> out(elements.size());
    // With many emitters and elements, most sources contribute little to an element.
    constexpr std::size_t max_exact_elements = 2000, max_exact_emitters = 8;
    const bool has_weak_sources = elements.size() > max_exact_elements &&
                                  direct.emitters().size() > max_exact_emitters && !stage.scene.has_light_apart();
    const bool is_noisy = has_weak_sources || !stage.occluders.has_nothing_inside();
    const double allowed = is_noisy ? std::pow(tolerance * mean_weighted_light(light, tree, elements, stop), 2) : 0;
    const double mean_area = stage.area / static_cast<double>(elements.size());
    parallel_ranges(elements.size(), 8, [&](std::size_t begin, std::size_t end) {
        DirectFitRoom room;
        for (std::size_t i = begin; i < end && !stop.requested(); ++i) {
            const ElementId e = elements[i];
            const NoiseAllowed noise{.squared = allowed * mean_area / tree.area(e)};
            out[i] = has_weak_sources ? fit_strong_light(light, tree, e, noise, rays_an_element, room)
                                      : fit_all_light(light, tree, e, noise, room);
        }
    });
    return out;
}

}  // namespace exitance
