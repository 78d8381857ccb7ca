#include "exitance/reconstruct/local_pass.hpp"

#include <bit>

#include "exitance/basis/element_fit.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/core/trace.hpp"
#include "exitance/mesh/adaptive.hpp"

namespace exitance {

LocalPass::LocalPass(const Stage& stage, MeshSize mesh, std::uint64_t seed)
    : stage_(stage), seed_(seed), tree_(stage.make_elements(mesh)) {
    mean_area_ = stage.area / static_cast<double>(tree_.leaves().size());
}

/// An even share for every element of the first mesh if the error falls with the root of the rays. Small elements stand
/// in corners, which are dark and count little; where light is to be right there, too, it is judged by what there is.
double LocalPass::allowed_noise(ElementId e, double light, const LocalPassDemand& demand) const {
    const double share = demand.noise * std::pow(mean_area_ / tree_.area(e), 0.25);
    constexpr double small = 0.125, least = 0.2;
    if (demand.relative_noise == 0) return share;
    // Large ones, where their light is dim: four times as much of what there is.
    const double relative = (tree_.area(e) > small * mean_area_ ? 4 : 1) * demand.relative_noise;
    return std::min(share, std::max(relative * light, least * demand.noise));
}

/// An even share for every element of the first mesh: area x error^2 <= mean area x tolerance^2. Without noise it can
/// be told how far dim places are off, too.
double LocalPass::allowed_misfit(ElementId e, double light, const LocalPassDemand& demand) const {
    const double share = demand.tolerance * std::sqrt(mean_area_ / tree_.area(e));
    if (demand.elements == nullptr || demand.relative_tolerance == 0) return share;
    return std::min(share, demand.relative_tolerance * light);
}

bool LocalPass::is_too_noisy(ElementId e, const LocalPassDemand& demand) const {
    constexpr double tolerated = 1.5;  // the noise is itself an estimate
    return std::sqrt(sampled_[e].noise_squared) > tolerated * allowed_noise(e, sampled_[e].light, demand);
}

/// Gathers with the rays that the element's area suggests, or that it or its parent took before, and once more with as
/// many as the noise then asks for.
LocalPass::Sampled LocalPass::sample(ElementId e, const ReflectedLight& b, const LocalPassDemand& demand,
                                     Workspace& workspace) const {
    const ElementId parent = tree_.parent(e);
    const unsigned inherited = parent.is_none() ? 0 : sampled_[parent].place_rays / 2;
    const unsigned before = sampled_[e].place_rays > 0 ? sampled_[e].place_rays : inherited;
    const bool hopeless = stage_.is_left_out(tree_.region(e));  // to begin with: its area asks for no rays
    const unsigned first = hopeless ? demand.rays.least : demand.rays.rays(tree_.area(e), mean_area_);
    unsigned rays = std::max({4u, first, before});
    const auto excess_of = [&](const Sampled& s) {
        return std::sqrt(s.noise_squared) / allowed_noise(e, s.light, demand);
    };
    const auto more = [&](const Sampled& s) {
        const double excess = excess_of(s);
        const double factor = std::clamp(std::pow(excess, 4.0 / 3), 1.0, 64.0);
        return std::min(demand.rays.most, std::bit_ceil(static_cast<unsigned>(rays * factor)));
    };
    unsigned spent = 0;
    if (sampled_[e].place_rays > 0) rays = more(sampled_[e]);
    Sampled out = sample(e, b, rays, demand, workspace);
    constexpr double tolerated = 1.5;
    if (excess_of(out) > tolerated && more(out) > rays) {
        spent = out.rays;
        out = sample(e, b, more(out), demand, workspace);
    }
    out.rays += spent;
    return out;
}

/// One place's light: summed over elements, exact but for what they may miss, or by rays.
Gathered LocalPass::gather_at(ElementId e, std::size_t place, const Point& x, const ReflectedLight& b, unsigned rays,
                              const LocalPassDemand& demand, Workspace& workspace) const {
    const RegionId region = tree_.region(e);
    const Normal& n = stage_.scene.regions()[region].plane.n;
    if (demand.elements != nullptr) {
        if (stage_.occluders.is_covered(x, n, region)) return {};
        return {(*demand.elements)(x, n, region, demand.element_share, workspace.elements), {}};
    }
    const std::uint64_t key = hash(seed_, static_cast<std::uint64_t>(Stream::gather), e.value, place);
    return gather_reflected(stage_, x, n, region, rays, key, b, workspace.rays);
}

LocalPass::Sampled LocalPass::sample(ElementId e, const ReflectedLight& b, unsigned rays, const LocalPassDemand& demand,
                                     Workspace& workspace) const {
    const Patch& patch = tree_.patch(e);
    const Spectrum& rho = stage_.scene.material(tree_.region(e)).reflectance;
    const std::vector<WeightedPlace> places = element_rule(tree_, e, RuleOrder::fine);
    std::vector<Spectrum> value(places.size());
    Sampled out;
    double noise = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Gathered g = gather_at(e, i, patch.at(places[i].uv), b, rays, demand, workspace);
        value[i] = g.irradiance;
        noise += places[i].weight * mean(rho * rho * g.variance);
        out.light += places[i].weight * squared(rho * g.irradiance) / static_cast<double>(bands);
    }
    out.light = std::sqrt(out.light);
    const ElementFit fit(tree_, e, places, value);
    for (int i = 0; i < patch.corner_count(); ++i) out.corners[static_cast<std::size_t>(i)] = fit.corner(i);
    for (std::size_t i = 0; i < places.size(); ++i)
        out.misfit_squared +=
            places[i].weight * squared(rho * (value[i] - fit.at(places[i].uv))) / static_cast<double>(bands);
    // Of the noise of n places, p freedoms take p / n up into the polynomial; the rest is left over.
    const double taken = std::min(1.0, fit.freedoms() / static_cast<double>(places.size()));
    out.noise_squared = taken * noise;
    out.noise_in_misfit = (1 - taken) * noise;
    out.place_rays = rays;
    // Summed light has no noise, and what judges it should have little, too.
    out.rays = (demand.elements != nullptr ? 4 : 1) * rays * static_cast<unsigned>(places.size());
    return out;
}

/// Cuts the elements whose error has too large a share in the whole; returns the new leaves.
std::vector<ElementId> LocalPass::split_where_needed(const std::vector<ElementId>& candidates,
                                                     const LocalPassDemand& demand) {
    std::vector<ElementId> fresh;
    for (ElementId e : candidates) {
        const Sampled& s = sampled_[e];
        // Five freedoms of noise alone leave over 2.3 times what they do on average once in twenty times.
        const double share = allowed_misfit(e, s.light, demand);
        if (s.misfit_squared <= share * share + 2.3 * s.noise_in_misfit) continue;
        for (ElementId child : refine_element(tree_, e)) fresh.push_back(child);
    }
    return fresh;
}

ElementFunction LocalPass::finished(LocalPassReport& report) const {
    ElementFunction out;
    out.tree = tree_;
    out.first_value.resize(tree_.size());
    double noise = 0, interpolation = 0;
    report.leaves = Field<ElementId, LocalPassReport::Leaf>(tree_.size());
    for (ElementId e : tree_.leaves()) {
        const Sampled& s = sampled_[e];
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        for (int i = 0; i < tree_.patch(e).corner_count(); ++i) out.add_value(s.corners[static_cast<std::size_t>(i)]);
        report.leaves[e] = {std::sqrt(s.misfit_squared + s.noise_squared), s.rays};
        noise += tree_.area(e) * s.noise_squared;
        interpolation += tree_.area(e) * (s.misfit_squared - s.noise_in_misfit);
    }
    report.noise = std::sqrt(noise / stage_.area);
    report.interpolation = std::sqrt(std::max(0.0, interpolation) / stage_.area);
    return out;
}

ElementFunction LocalPass::gather(const ReflectedLight& b, bool fresh, const LocalPassDemand& demand,
                                  LocalPassReport& report, Progress& progress, const StopRequest& stop,
                                  SafePoints safe_points) {
    std::vector<ElementId> active = tree_.leaves();
    int depth = 0;
    std::size_t begun = 0;  // how many of `active` an earlier run has gathered
    const bool resumed = safe_points.resume([&](auto& a) { a(active, depth, begun, report.rays); });
    const bool known = !fresh && sampled_.size() == tree_.size();
    std::vector<ElementId> kept;
    if (known && !resumed) {
        const auto good = [&](ElementId e) { return sampled_[e].place_rays > 0 && !is_too_noisy(e, demand); };
        std::copy_if(active.begin(), active.end(), std::back_inserter(kept), good);
        std::erase_if(active, good);
        // Of what is quiet enough and to be cut, the pieces are all that has to be gathered.
        for (ElementId child : split_where_needed(kept, demand)) active.push_back(child);
    }
    for (; !active.empty(); ++depth) {
        sampled_.resize(tree_.size());
        // In slices, so that progress can be told; few, since threads wait for one another at the end of each. A
        // request to stop is heard at every element: what it leaves out is not used.
        const std::size_t slice = std::max<std::size_t>(256, active.size() / 16 + 1);
        for (std::size_t first = std::exchange(begun, 0); first < active.size() && !stop.requested(); first += slice) {
            safe_points.pass([&](auto& a) { a(active, depth, first, report.rays); });
            parallel_ranges(std::min(slice, active.size() - first), 1,
                            [&](std::size_t begin, std::size_t end) {
                                Workspace workspace;
                                for (std::size_t i = first + begin; i < first + end && !stop.requested(); ++i)
                                    sampled_[active[i]] = sample(active[i], b, demand, workspace),
                                    note_touched("rays", sampled_[active[i]].rays);
                            },
                            {"gather", [&](std::size_t i) { return tree_.region(active[first + i]).value; }});
            // The first round is about half of the work, every further one half of what is left.
            const double done = static_cast<double>(first) / static_cast<double>(active.size());
            progress.advance(1 - std::ldexp(1 - 0.5 * done, -depth));
        }
        if (demand.elements == nullptr)
            for (ElementId e : active) report.rays += sampled_[e].rays;
        report.interrupted = stop.requested();
        if (depth == demand.max_depth || report.interrupted) break;
        active = split_where_needed(active, demand);
    }
    tree_.shrink_to_fit(), sampled_.shrink_to_fit();
    return finished(report);
}

}  // namespace exitance
