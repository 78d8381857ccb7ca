#include "exitance/transport/direct_projection.hpp"

#include "exitance/basis/element_fit.hpp"
#include "exitance/core/parallel.hpp"
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

/// Leaves noise in a fit to values whose noise has the mean square `noise`, by weight w: it has as many freedoms as the
/// element has corners, as much of the noise stays in it, and the rest looks like misfit.
void count_noise(const ElementTree& tree, ElementId e, double noise, DirectFit& fit) {
    const double places = static_cast<double>(element_rule(tree, e, RuleOrder::fine).size());
    const double kept = std::min(1.0, tree.patch(e).corner_count() / places);
    constexpr double seldom = 2;  // of noise alone, the squares of a few freedoms are seldom more than this
    fit.misfit_squared = std::max(0.0, fit.misfit_squared - seldom * (1 - kept) * noise) + kept * noise;
}

/// Exact, but where rays find what is hidden for less (`CrowdedLight`). `allowed`: mean square of w (E - polynomial)
/// that noise may leave; 0: exact.
DirectFit fit_values(const Stage& stage, const ElementTree& tree, ElementId e, double allowed, ReceiverLight& light,
                     DirectLight::Workspace& workspace) {
    if (light.is_dark()) return {};
    const double w = mean(light_weight(stage.scene.material(tree.region(e))));
    unsigned rays = 0;
    const std::vector<CrowdedLight::Source> crowded =
        stage.crowded.take_crowded(light, tree.patch(e).at(tree.centre(e)), allowed / (w * w), workspace, rays);
    double noise = 0, places = 0;
    DirectFit out = fit_at_places(stage, tree, e, [&](const Point& x, Spectrum& parallel) {
        Spectrum E = stage.direct.irradiance(light, x, workspace, &parallel);
        if (!crowded.empty()) {
            const CrowdedLight::Estimate more = stage.crowded.at(light, crowded, x, rays, workspace, &parallel);
            E += more.irradiance, noise += more.variance, ++places;
        }
        return E;
    });
    if (noise > 0) count_noise(tree, e, w * w * noise / places, out);
    return out;
}

/// What clusters of emitters may miss at one place of an element that an error of `allowed` is left to.
LightAccuracy accuracy_on(const Stage& stage, RegionId region, double allowed) {
    constexpr double of_error = 0.5;   // an RMS error; a fit leaves a part of that
    constexpr double at_least = 0.05;  // no place needs more than this part of its own light
    return {at_least, of_error * std::sqrt(allowed) / mean(light_weight(stage.scene.material(region)))};
}

DirectFit fit_clusters(const Stage& stage, const ElementTree& tree, ElementId e, double allowed,
                       ClusteredLight::Workspace& workspace) {
    const RegionId region = tree.region(e);
    const Normal& n = stage.scene.regions()[region].plane.n;
    const LightAccuracy accuracy = accuracy_on(stage, region, allowed);
    double noise = 0, places = 0;
    const bool parallel_light = !stage.direct.beams().empty();
    DirectFit out = fit_at_places(stage, tree, e, [&](const Point& x, Spectrum& parallel) {
        const ClusteredLight::Estimate at = stage.clustered.by_clusters(x, n, region, accuracy, workspace);
        noise += at.variance, ++places;
        if (parallel_light) stage.direct.beams().irradiance({x, n, region}, &parallel);
        return at.irradiance;
    });
    const double w = mean(light_weight(stage.scene.material(region)));
    count_noise(tree, e, w * w * noise / places, out);
    return out;
}

/// Would clusters do at the middle of an element?
bool suits_clusters(const Stage& stage, const ElementTree& tree, ElementId e, double allowed,
                    ClusteredLight::Workspace& workspace) {
    if (!stage.clustered.is_possible()) return false;
    const RegionId region = tree.region(e);
    return stage.clustered.pays(tree.patch(e).at(tree.centre(e)), stage.scene.regions()[region].plane.n, region,
                                accuracy_on(stage, region, allowed), workspace);
}

}  // namespace

DirectFit fit_direct_light(const Stage& stage, const ElementTree& tree, ElementId e, double allowed,
                           DirectFitRoom& room) {
    if (suits_clusters(stage, tree, e, allowed, room.clustered))
        return fit_clusters(stage, tree, e, allowed, room.clustered);
    const RegionId region = tree.region(e);
    stage.direct.prepare(tree.outline(e), stage.scene.regions()[region].plane.n, region, room.light,
                         room.clustered.exact);
    return fit_values(stage, tree, e, allowed, room.light, room.clustered.exact);
}

DirectFit fit_direct_light(const Stage& stage, const ElementTree& tree, ElementId e, ReceiverLight& light,
                           DirectLight::Workspace& workspace) {
    const RegionId region = tree.region(e);
    stage.direct.prepare(tree.outline(e), stage.scene.regions()[region].plane.n, region, light, workspace);
    return fit_values(stage, tree, e, 0, light, workspace);
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
DirectFit fit_strong_light(const Stage& stage, const ElementTree& tree, ElementId e, double allowed, unsigned rays,
                           SampledLight& sampled, DirectFitRoom& room) {
    const RegionId region = tree.region(e);
    if (!stage.scene.behind(region).is_none()) return fit_direct_light(stage, tree, e, allowed, room);
    // Each source is looked at, if only roughly: where they are too many even for that, clusters are first.
    constexpr std::size_t too_many = 10000;
    const bool clusters_first = stage.clustered.tree().sources().size() > too_many;
    if (clusters_first && suits_clusters(stage, tree, e, allowed, room.clustered))
        return fit_clusters(stage, tree, e, allowed, room.clustered);
    const SampledLight::Estimate& of = sampled(tree, e, light_weight(stage.scene.material(region)), allowed, rays);
    if (of.strong.size() > few_strong && suits_clusters(stage, tree, e, allowed, room.clustered))
        return fit_clusters(stage, tree, e, allowed, room.clustered);
    stage.direct.prepare(tree.outline(e), stage.scene.regions()[region].plane.n, region, of.strong, room.light,
                         room.clustered.exact);
    DirectFit out = fit_values(stage, tree, e, allowed, room.light, room.clustered.exact);
    for (Spectrum& corner : out.corners) corner += of.weak;
    out.mean += of.weak;
    // What weak sources may leave is no reason to cut, but is counted where nothing is cut.
    out.misfit_squared = std::max(out.misfit_squared, of.misfit_squared);
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

}  // namespace

namespace {

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

}  // namespace

DirectProjection project_direct_light(const Stage& stage, const DirectProjectionOptions& options,
                                      const StopRequest& stop) {
    DirectProjection out{stage.make_elements(options.mesh), {}};
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
    for (int depth = 0; !active.empty(); ++depth) {
        out.fit.resize(out.tree.size());
        shared_ranges(
            active.size(), 8,
            [&](std::size_t begin, std::size_t end) {
                if (options.may_give_up && stop.requested()) return;
                DirectFitRoom room;
                SampledLight sampled(stage.direct, stage.tracer, options.seed);
                for (std::size_t i = begin; i < end; ++i) {
                    const ElementId e = active[i];
                    DirectFit& fit = out.fit[e];
                    if (stop.requested() && depth > 0)
                        fit = inherited_fit(out.tree, e, out.fit[out.tree.parent(e)]);
                    else if (stop.requested())  // dark, where even rays would take too long
                        fit = stop.seconds_overdue() < time_for_rays ? fit_by_rays(stage, out.tree, e, sampled)
                                                                     : DirectFit();
                    else if (many)
                        fit = fit_strong_light(stage, out.tree, e, allowed_on(e) / out.tree.area(e), rays_of(e),
                                               sampled, room);
                    else
                        fit = fit_direct_light(stage, out.tree, e, allowed_on(e) / out.tree.area(e), room);
                }
            },
            [&](std::size_t i) -> DirectFit& { return out.fit[active[i]]; },
            {"direct light", [&](std::size_t i) { return out.tree.region(active[i]).value; }});
        if (options.may_give_up && stop.requested()) return {};
        if (depth == 0 && !many) share = share_of(weighted_flux(stage, out.tree, active, out.fit));
        if (depth == 0) share_in = shares_by_room(stage, out, active, options.tolerance);
        if (depth == options.max_depth || stop.requested()) break;
        std::vector<ElementId> fresh;
        for (ElementId e : active) {
            if (out.tree.area(e) * out.fit[e].misfit_squared <= allowed_on(e)) continue;
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
