#include "exitance/what_if/light_groups/group_direct.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/basis/element_fit.hpp"
#include "exitance/direct/sampled_light.hpp"

namespace exitance {
namespace {

/// Direct light of some emitters of a stage's scene.
class PartOfLight {
  public:
    PartOfLight(const Scene& lit, const Stage& stage, const ElementTree& tree)
        : stage_(stage), tree_(tree), direct_(lit, stage.occluders), place_light_(direct_, stage.tracer) {}

    const DirectLight& direct() const { return direct_; }

    /// Fits the light of all emitters. `allowed`: permitted mean square of w (E - polynomial) by noise, (W/m^2)^2.
    DirectFit fit(ElementId e, double allowed, DirectFitRoom& room) const {
        const Places at(*this, e);
        place_light_.at_places(at.polygon(), {0, std::sqrt(allowed) / weight(e)}, room.place, room.found);
        DirectFit out = fit_found(e, room.found);
        add_missed_light(direct_, tree_, e, room.small, out);
        return out;
    }

    /// Fits the strong emitters exactly and the others by rays.
    DirectFit fit_strong(ElementId e, double allowed, SampledLight& sampled, DirectFitRoom& room) const {
        const RegionId region = tree_.region(e);
        if (!stage_.scene.behind(region).is_none()) return fit(e, allowed, room);
        constexpr unsigned rays = 16;
        const Spectrum w = light_weight(stage_.scene.material(region));
        const SampledLight::Estimate& of = sampled(tree_, e, w, allowed, rays);
        const Places at(*this, e);
        const LightAccuracy accuracy{0, std::sqrt(allowed) / weight(e)};
        if (!place_light_.exact_at_places(at.polygon(), &of.strong, accuracy, room.place, room.found))
            return fit(e, allowed, room);
        DirectFit out = fit_found(e, room.found);
        for (Spectrum& corner : out.corners) corner += of.weak;
        out.mean += of.weak;
        return out;
    }

    double weight(ElementId e) const { return mean(light_weight(stage_.scene.material(tree_.region(e)))); }

  private:
    /// The nodes of an element's rule.
    struct Places {
        Places(const PartOfLight& part, ElementId e)
            : outline(part.tree_.outline(e)),
              region(part.tree_.region(e)),
              n(part.stage_.scene.regions()[region].plane.n) {
            for (const WeightedPlace& place : element_rule(part.tree_, e, RuleOrder::fine))
                places.push_back(part.tree_.patch(e).at(place.uv));
        }
        PlaceLight::Polygon polygon() const { return {outline, n, region, places}; }

        std::vector<Point> outline, places;
        RegionId region;
        Normal n;
    };

    DirectFit fit_found(ElementId e, std::span<const PlaceLight::Estimate> found) const {
        DirectFit out;
        const std::vector<WeightedPlace> places = element_rule(tree_, e, RuleOrder::fine);
        std::vector<Spectrum> values;
        for (std::size_t i = 0; i < places.size(); ++i) {
            values.push_back(found[i].irradiance);
            out.mean += places[i].weight * values.back();
        }
        const ElementFit fit(tree_, e, places, values);
        for (int i = 0; i < tree_.patch(e).corner_count(); ++i)
            out.corners[static_cast<std::size_t>(i)] = fit.corner(i);
        return out;
    }

    const Stage& stage_;
    const ElementTree& tree_;
    DirectLight direct_;
    PlaceLight place_light_;
};

/// Mean of w E_dir over the elements, estimated from a subset with loose accuracy.
double estimated_mean(const PartOfLight& part, const ElementTree& tree, std::span<const ElementId> elements,
                      const StopRequest& stop) {
    constexpr std::size_t samples = 512;
    constexpr double any_error = 1e300;  // derived from the largest double: the square of this error is still finite
    const std::size_t step = std::max<std::size_t>(1, elements.size() / samples);
    DirectFitRoom room;
    double flux = 0, area = 0;
    for (std::size_t i = step / 2; i < elements.size() && !stop.requested(); i += step) {
        const ElementId e = elements[i];
        flux += tree.area(e) * part.weight(e) * mean(part.fit(e, any_error, room).mean);
        area += tree.area(e);
    }
    return area > 0 ? flux / area : 0;
}

}  // namespace

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
                                     std::span<const ElementId> elements, double tolerance, std::uint64_t seed,
                                     const StopRequest& stop) {
    const PartOfLight part(lit, stage, tree);
    std::vector<DirectFit> out(elements.size());
    // With many emitters and elements, most sources contribute little to an element.
    constexpr std::size_t max_exact_elements = 2000, max_exact_emitters = 8;
    const bool has_weak_sources = elements.size() > max_exact_elements &&
                                  part.direct().emitters().size() > max_exact_emitters &&
                                  !stage.scene.has_light_apart();
    const bool is_noisy = has_weak_sources || !stage.occluders.has_nothing_inside();
    const double allowed = is_noisy ? std::pow(tolerance * estimated_mean(part, tree, elements, stop), 2) : 0;
    const double mean_area = stage.area / static_cast<double>(elements.size());
    parallel_ranges(elements.size(), 8, [&](std::size_t begin, std::size_t end) {
        DirectFitRoom room;
        SampledLight sampled(part.direct(), stage.tracer, seed);
        for (std::size_t i = begin; i < end && !stop.requested(); ++i) {
            const ElementId e = elements[i];
            const double share = allowed * mean_area / tree.area(e);
            out[i] = has_weak_sources ? part.fit_strong(e, share, sampled, room) : part.fit(e, share, room);
        }
    });
    return out;
}

}  // namespace exitance
