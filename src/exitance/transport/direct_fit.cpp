#include "exitance/transport/direct_fit.hpp"

#include <algorithm>
#include <numeric>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/basis/element_fit.hpp"
#include "exitance/basis/misfit_along.hpp"

namespace exitance {
namespace {

/// Least-squares polynomial of value(x, parallel) at the nodes of the fine rule.
template <class Value>
DirectFit fit_at_places(const Stage& stage, const ElementTree& tree, ElementId e, const Value& value_at) {
    DirectFit out;
    const Patch& patch = tree.patch(e);
    const std::vector<WeightedPlace> rule = element_rule(tree, e, RuleOrder::fine);
    std::vector<Spectrum> value(rule.size());
    for (std::size_t i = 0; i < rule.size(); ++i) {
        Spectrum parallel;
        value[i] = value_at(patch.at(rule[i].uv), parallel);
        out.mean += rule[i].weight * value[i];
        out.parallel += rule[i].weight * parallel;
    }
    const ElementFit fit(tree, e, rule, value);
    for (int i = 0; i < patch.corner_count(); ++i) out.corners[static_cast<std::size_t>(i)] = fit.corner(i);
    const Spectrum w = light_weight(stage.scene.material(tree.region(e)));
    for (std::size_t i = 0; i < rule.size(); ++i) {
        value[i] = w * (value[i] - fit.at(rule[i].uv));
        out.misfit_squared += rule[i].weight * squared(value[i]) / static_cast<double>(bands);
    }
    out.misfit_along = misfit_along(tree, e, rule, value, Degree::straight);
    return out;
}

/// Share of the nodes' noise that a fit keeps: its degrees of freedom over the number of nodes.
double kept_noise_share(const ElementTree& tree, ElementId e) {
    const double places = static_cast<double>(element_rule(tree, e, RuleOrder::fine).size());
    return std::min(1.0, tree.patch(e).corner_count() / places);
}

/// Corrects a fit for noise. `noise`: mean square, over the nodes, of the noise of the values times w. A fit with one
/// degree of freedom per corner keeps a share of the noise; the remaining noise is measured as misfit and is
/// subtracted.
DirectFit count_noise(const ElementTree& tree, ElementId e, double noise, DirectFit fit) {
    const double kept = kept_noise_share(tree, e);
    constexpr double max_noise_factor = 2;  // bound on squared noise with few degrees of freedom, relative to its mean
    fit.misfit_squared = std::max(0.0, fit.misfit_squared - max_noise_factor * (1 - kept) * noise) + kept * noise;
    fit.noise_squared = kept * noise;
    return fit;
}

std::vector<Point> places_of(const ElementTree& tree, ElementId e) {
    std::vector<Point> out;
    for (const WeightedPlace& place : element_rule(tree, e, RuleOrder::fine)) out.push_back(tree.patch(e).at(place.uv));
    return out;
}

DirectFit fit_estimates(const Stage& stage, const ElementTree& tree, ElementId e,
                        std::span<const PlaceLight::Estimate> at) {
    double noise = 0;
    std::size_t next = 0;
    const DirectFit out = fit_at_places(stage, tree, e, [&](const Point&, Spectrum& parallel) {
        const PlaceLight::Estimate& estimate = at[next++];
        noise += estimate.variance, parallel += estimate.parallel;
        return estimate.irradiance;
    });
    if (noise <= 0) return out;
    const double w = mean(light_weight(stage.scene.material(tree.region(e))));
    return count_noise(tree, e, w * w * noise / static_cast<double>(next), out);
}

}  // namespace

LightAccuracy accuracy_on(double w, const NoiseAllowed& allowed) {
    const double e = std::sqrt(allowed.squared) / w;
    if (!(allowed.mean_light > 0)) return {0, e};
    const double at_dark = std::sqrt(0.5);
    return {(1 - at_dark) * e / (allowed.mean_light / w), at_dark * e};
}

void add_missed_light(const DirectLight& direct, const ElementTree& tree, ElementId e, SmallSources::Workspace& room,
                      DirectFit& fit) {
    const std::vector<Point> places = places_of(tree, e), outline = tree.outline(e);
    std::vector<double> weights;
    for (const WeightedPlace& place : element_rule(tree, e, RuleOrder::fine)) weights.push_back(place.weight);
    const Scene& scene = direct.occluders().scene();
    const RegionId region = tree.region(e);
    const SmallSources::Missed missed =
        SmallSources(direct).missed({outline, scene.regions()[region].plane.n, region, places, weights}, room);
    for (Spectrum& corner : fit.corners) corner += missed.irradiance;
    fit.mean += missed.irradiance, fit.parallel += missed.parallel;
    const Spectrum error = light_weight(scene.material(region)) * missed.irradiance;
    fit.misfit_squared = std::max(fit.misfit_squared, squared(error) / static_cast<double>(bands));
}

DirectFit fit_all_light(const FittedLight& light, const ElementTree& tree, ElementId e, const NoiseAllowed& allowed,
                        DirectFitRoom& room) {
    const Scene& scene = light.stage.scene;
    const RegionId region = tree.region(e);
    const double w = mean(light_weight(scene.material(region)));
    const std::vector<Point> places = places_of(tree, e), outline = tree.outline(e);
    light.places.at_places({outline, scene.regions()[region].plane.n, region, places}, accuracy_on(w, allowed),
                           room.place, room.found);
    DirectFit out = fit_estimates(light.stage, tree, e, room.found);
    if (tree.area(e) >= allowed.minor_area) add_missed_light(light.direct, tree, e, room.small, out);
    return out;
}

DirectFit fit_direct_light(const Stage& stage, const ElementTree& tree, ElementId e, double allowed,
                           DirectFitRoom& room) {
    return fit_all_light(stage, tree, e, {allowed}, room);
}

namespace {

Spectrum between(const std::array<Spectrum, 4>& c, const Patch& patch, Vec2 uv) {
    const auto [u, v] = uv;
    if (patch.is_triangle()) return (1 - u - v) * c[0] + u * c[1] + v * c[2];
    return (1 - v) * ((1 - u) * c[0] + u * c[1]) + v * ((1 - u) * c[3] + u * c[2]);
}

}  // namespace

Spectrum DirectProjection::at(ElementTree::Place place) const {
    return between(fit[place.element].corners, tree.patch(place.element), place.uv);
}

DirectFit inherited_fit(const ElementTree& tree, ElementId e, const DirectFit& parent) {
    const Patch &patch = tree.patch(e), &of_parent = tree.patch(tree.parent(e));
    const auto value = [&](const Point& p) {
        return between(parent.corners, of_parent, into_shape(of_parent.coordinates(p), of_parent.shape));
    };
    DirectFit out = parent;
    for (int i = 0; i < patch.corner_count(); ++i) out.corners[static_cast<std::size_t>(i)] = value(patch.corner(i));
    out.mean = value(patch.at(tree.centre(e)));
    return out;
}

Spectrum light_weight(const Material& material) {
    // Chosen: half of it and twice it give the same light, measured by `exitance solve furniture.obj --error 0.02`.
    constexpr double min_weight = 0.1;
    Spectrum w = material.reflectance;
    for (double& v : w.value) v = std::max(v, min_weight);
    return w;
}

DirectFit fit_strong_light(const FittedLight& light, const ElementTree& tree, ElementId e, const NoiseAllowed& allowed,
                           unsigned rays, DirectFitRoom& room) {
    const Scene& scene = light.stage.scene;
    const RegionId region = tree.region(e);
    if (!scene.behind(region).is_none()) return fit_all_light(light, tree, e, allowed, room);
    const Spectrum weight = light_weight(scene.material(region));
    const RayLight::ElementEstimate weak =
        light.places.rays().on_element(tree, e, weight, allowed.squared, rays, room.place);
    const std::vector<Point> places = places_of(tree, e), outline = tree.outline(e);
    const PlaceLight::Polygon on{outline, scene.regions()[region].plane.n, region, places};
    const LightAccuracy accuracy = accuracy_on(mean(weight), allowed);
    if (!light.places.exact_at_places(on, &weak.strong, accuracy, room.place, room.found))
        return fit_all_light(light, tree, e, allowed, room);
    DirectFit out = fit_estimates(light.stage, tree, e, room.found);
    for (Spectrum& corner : out.corners) corner += weak.irradiance;
    out.mean += weak.irradiance;
    // The misfit of weak sources does not trigger a split; it is the error of elements that stay whole. The noise of
    // their rays, which smaller elements would not reduce, is left out.
    out.misfit_squared = std::max(out.misfit_squared, weak.misfit_squared);
    return out;
}

namespace {

/// Light at a random place of an element by few rays. `number`: of the place.
PlaceLight::Estimate rough_light(const FittedLight& light, const ElementTree& tree, ElementId e, std::uint64_t number,
                                 DirectFitRoom& room) {
    constexpr LightAccuracy rough{.relative = 0.5, .max_rays = rays_an_element};
    const RegionId region = tree.region(e);
    const Patch& patch = tree.patch(e);
    const ScrambledSobol random(hash(RayLight::key_of(patch.at(tree.centre(e)), region), number));
    const Point x = patch.at(tree.uniform(e, random(0, 0), random(0, 1)));
    return light.places.by_rays(x, light.stage.scene.regions()[region].plane.n, region, rough, room.place);
}

}  // namespace

DirectFit fit_by_rays(const FittedLight& light, const ElementTree& tree, ElementId e, DirectFitRoom& room) {
    const PlaceLight::Estimate found = rough_light(light, tree, e, 0, room);
    const Spectrum& E = found.irradiance;
    const Spectrum error = light_weight(light.stage.scene.material(tree.region(e))) * E;
    return {{E, E, E, E}, E, found.parallel, RayLight::typical_variance * squared(error) / static_cast<double>(bands)};
}

double mean_weighted_light(const FittedLight& light, const ElementTree& tree, std::span<const ElementId> leaves,
                           const StopRequest& stop) {
    constexpr std::size_t samples = 2000;
    if (leaves.empty()) return 0;
    std::vector<double> area_before{0};
    for (ElementId e : leaves) area_before.push_back(area_before.back() + tree.area(e));
    std::vector<double> found(samples);
    parallel_ranges(samples, 16, [&](std::size_t first, std::size_t last) {
        DirectFitRoom room;
        for (std::size_t i = first; i < last && !stop.requested(); ++i) {
            const double wanted = (static_cast<double>(i) + 0.5) / samples * area_before.back();
            const auto after = std::upper_bound(area_before.begin() + 1, area_before.end() - 1, wanted);
            const ElementId e = leaves[static_cast<std::size_t>(after - area_before.begin()) - 1];
            const Spectrum w = light_weight(light.stage.scene.material(tree.region(e)));
            found[i] = mean(w * rough_light(light, tree, e, i, room).irradiance);
        }
    });
    return stop.requested() ? 0 : std::accumulate(found.begin(), found.end(), 0.0) / samples;
}

}  // namespace exitance
