#include "exitance/transport/direct_fit.hpp"

#include "exitance/basis/element_fit.hpp"
#include "exitance/basis/misfit_along.hpp"
#include "exitance/direct/crowd_by_light.hpp"

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
/// degree of freedom per corner keeps a share of the noise; the remaining noise looks like misfit and is subtracted.
NoisyFit count_noise(const ElementTree& tree, ElementId e, double noise, DirectFit fit) {
    const double kept = kept_noise_share(tree, e);
    constexpr double max_noise_factor = 2;  // bound on the square of noise with few degrees of freedom, by its mean
    fit.misfit_squared = std::max(0.0, fit.misfit_squared - max_noise_factor * (1 - kept) * noise) + kept * noise;
    return {fit, kept * noise};
}

/// Fits exact values, or values by rays if these are cheaper (`CrowdedLight`). `named`: the sources to evaluate; null:
/// all sources and beams.
NoisyFit fit_values(const Stage& stage, const ElementTree& tree, ElementId e, const NoiseAllowed& allowed,
                    ReceiverLight& light, DirectLight::Workspace& workspace,
                    const std::vector<DirectLight::SourceName>* named = nullptr) {
    const RegionId region = tree.region(e);
    const double w = mean(light_weight(stage.scene.material(region)));
    const CrowdedLight::Crowd crowd = stage.crowded.prepare(tree.outline(e), stage.scene.regions()[region].plane.n,
                                                            region, allowed.squared / (w * w), light, workspace, named);
    if (light.is_dark() && crowd.empty()) return {};
    std::vector<CrowdedLight::Estimate> by_rays;
    if (!crowd.empty()) {
        std::vector<Point> places;
        for (const WeightedPlace& place : element_rule(tree, e, RuleOrder::fine))
            places.push_back(tree.patch(e).at(place.uv));
        by_rays = allowed.mean_light > 0
                      ? estimates_by_light(stage.crowded, light, crowd, places, kept_noise_share(tree, e),
                                           allowed.mean_light / w, workspace)
                      : stage.crowded.at(light, crowd, places, workspace);
    }
    double noise = 0;
    std::size_t next = 0;
    const DirectFit out = fit_at_places(stage, tree, e, [&](const Point& x, Spectrum& parallel) {
        const Spectrum E = stage.direct.irradiance(light, x, workspace, &parallel);
        if (crowd.empty()) return E;
        const CrowdedLight::Estimate& more = by_rays[next++];
        noise += more.variance, parallel += more.parallel;
        return E + more.irradiance;
    });
    if (noise <= 0) return {out};
    return count_noise(tree, e, w * w * noise / static_cast<double>(next), out);
}

/// Largest error of clustered light at a point of an element, if the element's fit may have the mean squared error
/// `allowed`.
LightAccuracy accuracy_on(const Stage& stage, RegionId region, double allowed) {
    constexpr double of_error = 0.5;   // the error of a fit is an RMS error, and smaller than that of its values
    constexpr double at_least = 0.05;  // relative error that is always accepted
    return {at_least, of_error * std::sqrt(allowed) / mean(light_weight(stage.scene.material(region)))};
}

NoisyFit fit_clusters(const Stage& stage, const ElementTree& tree, ElementId e, double allowed,
                      ClusteredLight::Workspace& workspace) {
    const RegionId region = tree.region(e);
    const Normal& n = stage.scene.regions()[region].plane.n;
    const LightAccuracy accuracy = accuracy_on(stage, region, allowed);
    double noise = 0, places = 0;
    const bool parallel_light = !stage.direct.beams().empty();
    const DirectFit out = fit_at_places(stage, tree, e, [&](const Point& x, Spectrum& parallel) {
        const ClusteredLight::Estimate at = stage.clustered.by_clusters(x, n, region, accuracy, workspace);
        noise += at.variance, ++places;
        if (parallel_light) stage.direct.beams().irradiance({x, n, region}, &parallel);
        return at.irradiance;
    });
    const double w = mean(light_weight(stage.scene.material(region)));
    return count_noise(tree, e, w * w * noise / places, out);
}

/// True if clusters are cheaper than exact light at the centre of an element.
bool suits_clusters(const Stage& stage, const ElementTree& tree, ElementId e, double allowed,
                    ClusteredLight::Workspace& workspace) {
    if (!stage.clustered.is_possible()) return false;
    const RegionId region = tree.region(e);
    return stage.clustered.pays(tree.patch(e).at(tree.centre(e)), stage.scene.regions()[region].plane.n, region,
                                accuracy_on(stage, region, allowed), workspace);
}

}  // namespace

NoisyFit fit_all_light(const Stage& stage, const ElementTree& tree, ElementId e, const NoiseAllowed& allowed,
                       DirectFitRoom& room) {
    if (suits_clusters(stage, tree, e, allowed.squared, room.clustered))
        return fit_clusters(stage, tree, e, allowed.squared, room.clustered);
    return fit_values(stage, tree, e, allowed, room.light, room.clustered.exact);
}

DirectFit fit_direct_light(const Stage& stage, const ElementTree& tree, ElementId e, double allowed,
                           DirectFitRoom& room) {
    return fit_all_light(stage, tree, e, {allowed}, room).fit;
}

DirectFit fit_direct_light(const Stage& stage, const ElementTree& tree, ElementId e, ReceiverLight& light,
                           DirectLight::Workspace& workspace) {
    return fit_values(stage, tree, e, {}, light, workspace).fit;
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
    constexpr double min_weight = 0.1;
    Spectrum w = material.reflectance;
    for (double& v : w.value) v = std::max(v, min_weight);
    return w;
}

NoisyFit fit_strong_light(const Stage& stage, const ElementTree& tree, ElementId e, const NoiseAllowed& allowed,
                          unsigned rays, SampledLight& sampled, DirectFitRoom& room) {
    const RegionId region = tree.region(e);
    if (!stage.scene.behind(region).is_none()) return fit_all_light(stage, tree, e, allowed, room);
    constexpr std::size_t max_strong = 24;  // exact light of up to this many sources costs no more than clusters
    // Each source is evaluated, if only approximately. Above this number of sources even that is expensive, and
    // clusters are tried first.
    constexpr std::size_t max_examined = 10000;
    const bool clusters_first = stage.clustered.tree().sources().size() > max_examined;
    if (clusters_first && suits_clusters(stage, tree, e, allowed.squared, room.clustered))
        return fit_clusters(stage, tree, e, allowed.squared, room.clustered);
    const SampledLight::Estimate& of =
        sampled(tree, e, light_weight(stage.scene.material(region)), allowed.squared, rays);
    if (of.strong.size() > max_strong && suits_clusters(stage, tree, e, allowed.squared, room.clustered))
        return fit_clusters(stage, tree, e, allowed.squared, room.clustered);
    NoisyFit out = fit_values(stage, tree, e, allowed, room.light, room.clustered.exact, &of.strong);
    for (Spectrum& corner : out.fit.corners) corner += of.weak;
    out.fit.mean += of.weak;
    // The error bound of weak sources does not trigger a split; it is added to the error of elements that stay whole.
    out.fit.misfit_squared = std::max(out.fit.misfit_squared, of.misfit_squared);
    return out;
}

DirectFit fit_by_rays(const Stage& stage, const ElementTree& tree, ElementId e, SampledLight& sampled) {
    constexpr double no_limit = 1e300;
    const Spectrum w = light_weight(stage.scene.material(tree.region(e)));
    const SampledLight::Estimate& of = sampled(tree, e, w, no_limit, rays_an_element);
    const auto& emitters = stage.direct.emitters();
    const bool all_outside = !emitters.empty() && stage.direct.is_distant(0);  // emitters of the sky come last
    const Spectrum parallel = all_outside ? of.weak : Spectrum();
    return {{of.weak, of.weak, of.weak, of.weak}, of.weak, parallel, of.misfit_squared, {}};
}

}  // namespace exitance
