#include "exitance/transport/direct_projection.hpp"

#include "exitance/basis/element_fit.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/mesh/adaptive.hpp"

namespace exitance {
DirectFit fit_direct_light(const Stage& stage, const ElementTree& tree, ElementId e, ReceiverLight& light,
                           DirectLight::Workspace& workspace) {
    const Patch& patch = tree.patch(e);
    const RegionId region = tree.region(e);
    const std::vector<WeightedPlace> rule = element_rule(tree, e, RuleOrder::fine);
    stage.direct.prepare(tree.outline(e), stage.scene.regions()[region].plane.n, region, light, workspace);
    DirectFit out;
    if (light.is_dark()) return out;
    std::vector<Spectrum> value(rule.size());
    for (std::size_t i = 0; i < rule.size(); ++i) {
        Spectrum parallel;
        value[i] = stage.direct.irradiance(light, patch.at(rule[i].uv), workspace, &parallel);
        out.mean += rule[i].weight * value[i];
        out.parallel += rule[i].weight * parallel;
    }
    const ElementFit fit(tree, e, rule, value);
    for (int i = 0; i < patch.corner_count(); ++i) out.corners[static_cast<std::size_t>(i)] = fit.corner(i);
    const Spectrum w = light_weight(stage.scene.material(region));
    for (std::size_t i = 0; i < rule.size(); ++i)
        out.misfit_squared +=
            rule[i].weight * squared(w * (value[i] - fit.at(rule[i].uv))) / static_cast<double>(bands);
    return out;
}

Spectrum DirectProjection::at(ElementTree::Place place) const {
    const auto [u, v] = place.uv;
    const std::array<Spectrum, 4>& c = fit[place.element].corners;
    if (tree.patch(place.element).is_triangle()) return (1 - u - v) * c[0] + u * c[1] + v * c[2];
    return (1 - v) * ((1 - u) * c[0] + u * c[1]) + v * ((1 - u) * c[3] + u * c[2]);
}

Spectrum light_weight(const Material& material) {
    constexpr double least = 0.1;
    Spectrum w = material.reflectance;
    for (double& v : w.value) v = std::max(v, least);
    return w;
}

DirectProjection project_direct_light(const Stage& stage, const DirectProjectionOptions& options,
                                      const StopRequest& stop) {
    DirectProjection out{stage.make_elements(options.mesh), {}};
    std::vector<ElementId> active = out.tree.leaves();
    const double mean_area = stage.area / static_cast<double>(active.size());
    double share = 0;  // of the squared error that one element may have
    for (int depth = 0; !active.empty(); ++depth) {
        out.fit.resize(out.tree.size());
        parallel_ranges(active.size(), 8,
                        [&](std::size_t begin, std::size_t end) {
                            if (options.may_give_up && stop.requested()) return;
                            DirectLight::Workspace workspace;
                            ReceiverLight light;
                            for (std::size_t i = begin; i < end; ++i)
                                out.fit[active[i]] = fit_direct_light(stage, out.tree, active[i], light, workspace);
                        },
                        {"direct light", [&](std::size_t i) { return out.tree.region(active[i]).value; }});
        if (options.may_give_up && stop.requested()) return {};
        if (depth == 0) {
            double flux = 0;
            for (ElementId e : active)
                flux +=
                    out.tree.area(e) * mean(light_weight(stage.scene.material(out.tree.region(e))) * out.fit[e].mean);
            const double allowed = options.tolerance * flux / stage.area;
            share = allowed * allowed * mean_area;
        }
        if (depth == options.max_depth || stop.requested()) break;
        std::vector<ElementId> fresh;
        for (ElementId e : active) {
            if (out.tree.area(e) * out.fit[e].misfit_squared <= share) continue;
            if (options.least_area && out.tree.area(e) < 2 * *options.least_area) continue;
            for (ElementId child : refine_element(out.tree, e)) fresh.push_back(child);
        }
        active = std::move(fresh);
    }
    return out;
}

}  // namespace exitance
