#include "exitance/transport/direct_projection.hpp"

#include "exitance/basis/element_fit.hpp"
#include "exitance/core/error_share.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/direct/crowd_by_light.hpp"
#include "exitance/direct/sampled_light.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/transport/distributed.hpp"

namespace exitance {
namespace {

/// The polynomial nearest to value(x, parallel) at the places of the fine rule.
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
    for (std::size_t i = 0; i < rule.size(); ++i)
        out.misfit_squared +=
            rule[i].weight * squared(w * (value[i] - fit.at(rule[i].uv))) / static_cast<double>(bands);
    return out;
}

/// A fit, and how much of its misfit is noise that it keeps, (W/m^2)^2: more rays would help, smaller elements would
/// not.
struct NoisyFit {
    DirectFit fit;
    double noise = 0;
};

/// How much of the noise of its places a fit keeps: as many parts as it has freedoms.
double kept_noise_share(const ElementTree& tree, ElementId e) {
    const double places = static_cast<double>(element_rule(tree, e, RuleOrder::fine).size());
    return std::min(1.0, tree.patch(e).corner_count() / places);
}

/// Leaves noise in a fit to values whose noise has the mean square `noise`, by weight w: it has as many freedoms as the
/// element has corners, as much of the noise stays in it, and the rest looks like misfit.
NoisyFit count_noise(const ElementTree& tree, ElementId e, double noise, DirectFit fit) {
    const double kept = kept_noise_share(tree, e);
    constexpr double seldom = 2;  // of noise alone, the squares of a few freedoms are seldom more than this
    fit.misfit_squared = std::max(0.0, fit.misfit_squared - seldom * (1 - kept) * noise) + kept * noise;
    return {fit, kept * noise};
}

/// What noise of rays to crowded sources a fit may keep.
struct NoiseAllowed {
    double squared = 0;     ///< Mean square of w (E - polynomial) that noise may leave, (W/m^2)^2; 0: exact.
    double mean_light = 0;  ///< Mean of w E over all surfaces, W/m^2, where it is dealt out by light; else 0.
};

/// Exact, but where rays find what is hidden for less (`CrowdedLight`). `named`: the sources to look at; none: all, and
/// beams.
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

/// What clusters of emitters may miss at one place of an element that an error of `allowed` is left to.
LightAccuracy accuracy_on(const Stage& stage, RegionId region, double allowed) {
    constexpr double of_error = 0.5;   // an RMS error; a fit leaves a part of that
    constexpr double at_least = 0.05;  // no place needs more than this part of its own light
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

/// Would clusters do at the middle of an element?
bool suits_clusters(const Stage& stage, const ElementTree& tree, ElementId e, double allowed,
                    ClusteredLight::Workspace& workspace) {
    if (!stage.clustered.is_possible()) return false;
    const RegionId region = tree.region(e);
    return stage.clustered.pays(tree.patch(e).at(tree.centre(e)), stage.scene.regions()[region].plane.n, region,
                                accuracy_on(stage, region, allowed), workspace);
}

NoisyFit fit_all_light(const Stage& stage, const ElementTree& tree, ElementId e, const NoiseAllowed& allowed,
                       DirectFitRoom& room) {
    if (suits_clusters(stage, tree, e, allowed.squared, room.clustered))
        return fit_clusters(stage, tree, e, allowed.squared, room.clustered);
    return fit_values(stage, tree, e, allowed, room.light, room.clustered.exact);
}

}  // namespace

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
    constexpr double least = 0.1;
    Spectrum w = material.reflectance;
    for (double& v : w.value) v = std::max(v, least);
    return w;
}

namespace {

constexpr unsigned rays_an_element = 16;  ///< For weak sources; more on elements larger than the first ones on average.

constexpr std::size_t few_strong = 24;  ///< Sources of which exact visible parts cost no more than clusters do.

/// The same where there are many elements: sources that do not count on this one are left to rays.
NoisyFit fit_strong_light(const Stage& stage, const ElementTree& tree, ElementId e, const NoiseAllowed& allowed,
                          unsigned rays, SampledLight& sampled, DirectFitRoom& room) {
    const RegionId region = tree.region(e);
    if (!stage.scene.behind(region).is_none()) return fit_all_light(stage, tree, e, allowed, room);
    // Each source is looked at, if only roughly: where they are too many even for that, clusters are first.
    constexpr std::size_t too_many = 10000;
    const bool clusters_first = stage.clustered.tree().sources().size() > too_many;
    if (clusters_first && suits_clusters(stage, tree, e, allowed.squared, room.clustered))
        return fit_clusters(stage, tree, e, allowed.squared, room.clustered);
    const SampledLight::Estimate& of =
        sampled(tree, e, light_weight(stage.scene.material(region)), allowed.squared, rays);
    if (of.strong.size() > few_strong && suits_clusters(stage, tree, e, allowed.squared, room.clustered))
        return fit_clusters(stage, tree, e, allowed.squared, room.clustered);
    NoisyFit out = fit_values(stage, tree, e, allowed, room.light, room.clustered.exact, &of.strong);
    for (Spectrum& corner : out.fit.corners) corner += of.weak;
    out.fit.mean += of.weak;
    // What weak sources may leave is no reason to cut, but is counted where nothing is cut.
    out.fit.misfit_squared = std::max(out.fit.misfit_squared, of.misfit_squared);
    return out;
}

constexpr double time_for_rays = 0.2;  ///< Seconds after a stop was asked for.

/// By rays alone, constant: for work that is cut short.
DirectFit fit_by_rays(const Stage& stage, const ElementTree& tree, ElementId e, SampledLight& sampled) {
    constexpr double anything = 1e300;
    const Spectrum w = light_weight(stage.scene.material(tree.region(e)));
    const SampledLight::Estimate& of = sampled(tree, e, w, anything, rays_an_element);
    const auto& emitters = stage.direct.emitters();
    const bool all_outside = !emitters.empty() && stage.direct.is_distant(0);  // those of the sky come last
    const Spectrum parallel = all_outside ? of.weak : Spectrum();
    return {{of.weak, of.weak, of.weak, of.weak}, of.weak, parallel, of.misfit_squared};
}

/// Sum of w E_dir over leaves, W.
double weighted_flux(const Stage& stage, const ElementTree& tree, std::span<const ElementId> leaves,
                     const Field<ElementId, DirectFit>& fit) {
    double flux = 0;
    for (ElementId e : leaves)
        flux += tree.area(e) * mean(light_weight(stage.scene.material(tree.region(e))) * fit[e].mean);
    return flux;
}

/// Of all surfaces, from leaves at even steps of their running sum of areas.
double estimated_flux(const Stage& stage, const ElementTree& tree, std::span<const ElementId> leaves,
                      std::uint64_t seed, const StopRequest& stop) {
    constexpr double samples = 2000;
    SampledLight sampled(stage.direct, stage.tracer, seed);
    double flux = 0, area = 0, next = 0.5 * stage.area / samples;
    for (ElementId e : leaves) {
        area += tree.area(e);
        if (area <= next) continue;
        if (stop.requested()) return 0;
        const double steps = std::ceil((area - next) * samples / stage.area);
        next += steps * stage.area / samples;
        const Spectrum w = light_weight(stage.scene.material(tree.region(e)));
        flux += steps / samples * mean(w * sampled(tree, e, w, HUGE_VAL, rays_an_element).weak);
    }
    return flux * stage.area;
}

/// The same where light comes from outside, too, and parallel: by some elements that rays do for wherever many things
/// stand before a source.
double estimated_flux_apart(const Stage& stage, const ElementTree& tree, std::span<const ElementId> leaves,
                            const StopRequest& stop) {
    constexpr std::size_t samples = 512;
    constexpr double anything = 1e300;
    DirectFitRoom room;
    double flux = 0, area = 0;
    const std::size_t step = std::max<std::size_t>(1, leaves.size() / samples);
    for (std::size_t i = step / 2; i < leaves.size() && !stop.requested(); i += step) {
        const ElementId e = leaves[i];
        const Spectrum w = light_weight(stage.scene.material(tree.region(e)));
        flux += tree.area(e) * mean(w * fit_direct_light(stage, tree, e, anything, room).mean);
        area += tree.area(e);
    }
    return area > 0 ? flux * stage.area / area : 0;
}

/// What squared error an element may have where rooms are judged apart: each room as if it were alone, but none for
/// less than a hundredth of the light of all. (W/m^2)^2 m^2
std::vector<double> shares_by_room(const Stage& stage, const DirectProjection& light,
                                   const std::vector<ElementId>& leaves, double tolerance) {
    const std::size_t rooms = stage.rooms.count();
    if (rooms == 0) return {};
    std::vector<double> flux(rooms), elements(rooms);
    double all = 0;
    for (ElementId e : leaves) {
        const std::size_t room = stage.rooms.of(light.tree, e);
        const double own =
            light.tree.area(e) * mean(light_weight(stage.scene.material(light.tree.region(e))) * light.fit[e].mean);
        flux[room] += own, all += own, elements[room] += 1;
    }
    std::vector<double> out(rooms);
    for (std::size_t room = 0; room < rooms; ++room) {
        constexpr double least = 0.01;
        const double light_there = std::max(flux[room] / stage.rooms.area(room), least * all / stage.area);
        out[room] =
            tolerance * light_there * tolerance * light_there * stage.rooms.area(room) / std::max(1.0, elements[room]);
    }
    return out;
}

/// The squared error of an element that smaller ones would not have, (W/m^2)^2 m^2. `noise`: see `NoisyFit`.
double error_of_shape(const DirectProjection& light, const Field<ElementId, double>& noise, ElementId e) {
    return light.tree.area(e) * std::max(0.0, light.fit[e].misfit_squared - noise[e]);
}

/// Of a bound on the sum of the leaves' squared errors, (W/m^2)^2 m^2.
double share_in_crowd(const DirectProjection& light, const Field<ElementId, double>& noise, double bound) {
    std::vector<double> errors;
    for (ElementId e : light.tree.leaves()) errors.push_back(error_of_shape(light, noise, e));
    return share_of_crowd(std::move(errors), bound);
}

}  // namespace

DirectProjection project_direct_light(const Stage& stage, const DirectProjectionOptions& options,
                                      const StopRequest& stop) {
    DirectProjection out{stage.make_elements(options.mesh, &stop), {}};
    std::vector<ElementId> active = out.tree.leaves();
    const double mean_area = stage.area / static_cast<double>(active.size());
    const auto share_of = [&](double flux) {
        const double allowed = options.tolerance * flux / stage.area;
        return allowed * allowed * mean_area;
    };
    // Where elements or emitters are few, or emitters large, all of them are looked at well. Then the elements tell
    // what share of the squared error one may have.
    constexpr std::size_t few = 2000, few_emitters = 8;
    constexpr double small = 0.25;  // of all area
    double emitting = 0;
    for (const DirectLight::Emitter& emitter : stage.direct.emitters())
        if (!emitter.region.is_none()) emitting += stage.scene.regions()[emitter.region].area;
    const bool many = active.size() > few && stage.direct.emitters().size() > few_emitters &&
                      (emitting < small * stage.area || stage.clustered.is_possible()) &&
                      !stage.scene.has_light_apart();
    // The flux of weak sources is known best where rays lie evenly over the surfaces.
    const auto rays_of = [&](ElementId e) {
        const double rays = rays_an_element * out.tree.area(e) / mean_area;
        return static_cast<unsigned>(
            std::clamp(rays, static_cast<double>(rays_an_element), static_cast<double>(SampledLight::most_rays)));
    };
    // Where elements are many, the first of them are to know what they may leave, too.
    double share = 0;
    if (active.size() > few)
        share = share_of(stage.scene.has_light_apart() ? estimated_flux_apart(stage, out.tree, active, stop)
                                                       : estimated_flux(stage, out.tree, active, options.seed, stop));
    std::vector<double> share_in;               // of the rooms, where there are several
    const auto allowed_on = [&](ElementId e) {  // (W/m^2)^2 m^2
        if (share_in.empty()) return share;
        const double relative = stage.rooms.importance(out.tree, e) / stage.rooms.weight(out.tree, e);
        return share_in[stage.rooms.of(out.tree, e)] / relative;
    };
    // Noise of small elements is small by itself, and that of large ones not to be less the more of those there are.
    const bool is_crowd = stage.rooms.count() == 0 && ErrorShare::is_crowd(active.size(), stage.pieces.size());
    const auto noise_on = [&](ElementId e) -> NoiseAllowed {
        const double of_area =
            share * std::min(1.0, stage.area / (ErrorShare::most_even * out.tree.area(e))) / mean_area;
        const double even = allowed_on(e) / out.tree.area(e);
        if (!is_crowd) return {even};
        return {std::max(even, of_area), std::sqrt(share / mean_area) / options.tolerance};
    };
    std::vector<NoisyFit> found;
    Field<ElementId, double> noise;
    for (int depth = 0; !active.empty(); ++depth) {
        found.assign(active.size(), {});
        shared_ranges(
            active.size(), 8,
            [&](std::size_t begin, std::size_t end) {
                if (options.may_give_up && stop.requested()) return;
                DirectFitRoom room;
                SampledLight sampled(stage.direct, stage.tracer, options.seed);
                for (std::size_t i = begin; i < end; ++i) {
                    const ElementId e = active[i];
                    NoisyFit& fit = found[i];
                    if (stop.requested() && depth > 0)
                        fit.fit = inherited_fit(out.tree, e, out.fit[out.tree.parent(e)]);
                    else if (stop.requested() && stop.seconds_overdue() < time_for_rays)
                        fit.fit = fit_by_rays(stage, out.tree, e, sampled);
                    else if (stop.requested())
                        continue;  // dark, where even rays would take too long
                    else if (many)
                        fit = fit_strong_light(stage, out.tree, e, noise_on(e), rays_of(e), sampled, room);
                    else
                        fit = fit_all_light(stage, out.tree, e, noise_on(e), room);
                }
            },
            [&](std::size_t i) -> NoisyFit& { return found[i]; },
            {"direct light", [&](std::size_t i) { return out.tree.region(active[i]).value; }});
        out.fit.resize(out.tree.size()), noise.resize(out.tree.size());
        for (std::size_t i = 0; i < active.size(); ++i)
            out.fit[active[i]] = found[i].fit, noise[active[i]] = is_crowd ? found[i].noise : 0;
        if (options.may_give_up && stop.requested()) return {};
        if (depth == 0 && !many) share = share_of(weighted_flux(stage, out.tree, active, out.fit));
        if (depth == 0) share_in = shares_by_room(stage, out, active, options.tolerance);
        if (depth == options.max_depth || stop.requested()) break;
        const double least = is_crowd ? share_in_crowd(out, noise, share * stage.area / mean_area) : 0;
        std::vector<ElementId> fresh;
        for (ElementId e : active) {
            if (error_of_shape(out, noise, e) <= std::max(least, allowed_on(e))) continue;
            if (options.least_area && out.tree.area(e) < 2 * *options.least_area) continue;
            for (ElementId child : refine_element(out.tree, e)) fresh.push_back(child);
        }
        active = std::move(fresh);
    }
    out.tree.shrink_to_fit(), out.fit.shrink_to_fit();
    share_on_node(out.tree), share_on_node(out.fit.span());
    return out;
}

}  // namespace exitance
