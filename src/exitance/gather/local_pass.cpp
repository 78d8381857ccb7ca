#include "exitance/gather/local_pass.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "exitance/base/error_share.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/base/trace.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/solution/continuous.hpp"
#include "exitance/transport/narrow_places.hpp"
#include "exitance/transport/open_points.hpp"

namespace exitance {

LocalPass::LocalPass(const Stage& stage, MeshSize mesh, std::uint64_t seed)
    : stage_(stage), seed_(seed), tree_(stage.make_elements(mesh)) {
    const std::vector<ElementId> leaves = tree_.leaves();
    noise_area_ = mean_area_ = stage.area / static_cast<double>(leaves.size());
    is_crowd_ = stage.is_crowd(leaves.size());
    if (is_crowd_) {
        std::vector<double> areas;
        for (ElementId e : leaves)
            if (!stage.is_unlit(tree_.region(e))) areas.push_back(stage.counted_area(tree_, e));
        noise_area_ = std::max(mean_area_, even_noise_area(areas));
    }
    share_on_node(tree_);
}

/// Light of the room of an element over the mean light.
double LocalPass::light_near(ElementId e, const LocalPassDemand& demand) const {
    return demand.light_in.empty() ? 1 : demand.light_in[stage_.rooms.of(tree_, e)];
}

/// Factor on the noise allowed in the room of an element.
double LocalPass::noise_factor_in(ElementId e, const LocalPassDemand& demand) const {
    return demand.noise_in.empty() ? 1 : demand.noise_in[stage_.rooms.of(tree_, e)];
}

std::uint32_t LocalPass::body_of(ElementId e, const LocalPassDemand& demand) const {
    return demand.bodies->of(stage_.scene, tree_.region(e));
}

/// Divides the error allowed for every body among its elements: misfit by area, noise so that it takes the fewest rays.
void LocalPass::divide_among_bodies(const LocalPassDemand& demand) {
    if (!demand.bodies) return;
    std::vector<std::vector<double>> areas(demand.bodies->all.size());
    for (ElementId e : tree_.leaves()) areas[body_of(e, demand)].push_back(stage_.counted_area(tree_, e));
    const bool is_first = mean_area_of_.empty();
    noise_area_of_.clear();
    for (const std::vector<double>& of : areas) {
        const double sum = std::accumulate(of.begin(), of.end(), 0.0);
        if (is_first) mean_area_of_.push_back(of.empty() ? 0 : sum / static_cast<double>(of.size()));
        noise_area_of_.push_back(sum > 0 ? even_noise_area(of) : 0);
    }
}

/// RMS noise that an element may have for the sake of its body, W/m^2.
double LocalPass::noise_for_body(ElementId e, const LocalPassDemand& demand) const {
    if (!demand.bodies) return HUGE_VAL;
    const std::uint32_t body = body_of(e, demand);
    const double even = noise_area_of_[body] / stage_.counted_area(tree_, e);
    return demand.allowed_on_body[body] * std::sqrt(std::sqrt(even));
}

/// RMS misfit that an element may have for the sake of its body, W/m^2.
double LocalPass::misfit_for_body(ElementId e, const LocalPassDemand& demand) const {
    if (!demand.bodies) return HUGE_VAL;
    const std::uint32_t body = body_of(e, demand);
    return demand.allowed_on_body[body] * std::sqrt(mean_area_of_[body] / stage_.counted_area(tree_, e));
}

/// Noise of an element over the allowed noise. Three factors adjust the allowance:
/// - Small elements may be noisier. If the error falls with the root of the rays, all elements of the first mesh then
/// get the same number.
/// - Elements that need many rays may be noisier, and others less, since an additional ray reduces their noise less.
/// The fewest rays for a mean squared error would allow noise in proportion to the root of the rays; half of that
/// exponent is used, since noise and rays are estimates.
/// - Places much brighter than their room may be noisier, by the root of the ratio; otherwise a few square centimetres
/// at the opening of a dark room would take most rays. This concerns at most a quarter of a room's light and adds at
/// most a quarter to its squared noise.
double LocalPass::noise_excess(ElementId e, const SampledElement& sampled, const LocalPassDemand& demand) const {
    constexpr double far_lighter = 4;  // derived from the limit above, a quarter of the light
    const double usual_rays = 4 * demand.rays.average;
    // Exponents derived from those that minimize the rays for a mean squared error: half of them.
    const double effort_factor = std::clamp(std::pow(sampled.place_rays / usual_rays, 0.25), 0.5, 2.0);
    const double near = light_near(e, demand), usual_light = far_lighter * near * demand.light;
    const double brightness_factor = usual_light > 0 ? std::sqrt(std::max(1.0, sampled.light / usual_light)) : 1;
    const double of_all =
        demand.noise * noise_factor_in(e, demand) * near * effort_factor * brightness_factor *
        std::pow(noise_area_ / stage_.counted_area(tree_, e), 0.25);  // derived from the same minimization as above
    const double allowed = std::min(of_all, noise_for_body(e, demand));
    return allowed > 0 ? std::sqrt(sampled.noise_squared) / allowed : 0;
}

/// Allowed RMS misfit of an element: an even share for every element of the first mesh, area x error^2 <= mean area x
/// tolerance^2. If elements are summed, without noise, it is also limited relative to the light of dark places. The
/// darkest places are excluded, since refinement there would follow the method's elements.
double LocalPass::allowed_misfit(ElementId e, double light, const LocalPassDemand& demand) const {
    const double counted = stage_.counted_area(tree_, e), near = light_near(e, demand);
    const double even = demand.tolerance * near * std::sqrt(mean_area_ / counted);
    const double share = std::min(std::max(even, near * std::sqrt(min_share_ / counted)), misfit_for_body(e, demand));
    if (demand.elements.empty() || demand.relative_tolerance == 0) return share;
    return std::min(share, std::max(demand.relative_tolerance * light, calibrated::minor_misfit * demand.tolerance));
}

/// Allowed mean squared misfit of an element, including noise.
double LocalPass::tolerated_misfit_squared(ElementId e, const SampledElement& sampled,
                                           const LocalPassDemand& demand) const {
    const double share = allowed_misfit(e, sampled.light, demand);
    return share * share + noise_misfit_bound * sampled.noise_in_misfit;
}

bool LocalPass::is_too_rough(ElementId e, const SampledElement& sampled, const LocalPassDemand& demand) const {
    return sampled.misfit_squared > tolerated_misfit_squared(e, sampled, demand);
}

/// Computes the light at all places: by summing elements, exactly up to their allowed error, or by rays. If `more`,
/// every second place gets twice as many rays. Returns the number of rays.
unsigned LocalPass::gather_at(ElementId e, const std::vector<WeightedPlace>& places, const ReflectedLight& b,
                              unsigned rays, bool more, const LocalPassDemand& demand, Workspace& w) const {
    const RegionId region = tree_.region(e);
    const Normal& n = stage_.scene.regions()[region].plane.n;
    w.gathered.assign(places.size(), {});
    w.short_places.clear(), w.short_of.clear();
    const unsigned most = more ? 2 * rays : rays;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Point x = tree_.patch(e).at(places[i].uv);
        if (!demand.elements.empty()) {
            if (stage_.occluders.is_covered(x, n, region)) continue;
            for (const ElementGather& part : demand.elements)
                w.gathered[i].irradiance += part(x, n, region, demand.element_share, w.elements);
        } else if (w.growing[i].rays() < most && !(more && i % 2 == 0)) {
            w.short_places.push_back({x, hash(seed_, static_cast<std::uint64_t>(Stream::gather), e.value, i)});
            w.short_of.push_back(&w.growing[i]);
        }
    }
    if (demand.elements.empty()) {
        grow_together(stage_, w.short_places, n, region, most, b, w.short_of, w.rays);
        for (std::size_t i = 0; i < places.size(); ++i) w.gathered[i] = w.growing[i].gathered();
    }
    const auto count = static_cast<unsigned>(places.size());
    return rays * (count + (more ? count / 2 : 0));
}

/// True if a place is covered by another surface or inside a body, so that its light is never visible.
bool LocalPass::is_hidden(ElementId e, const Point& x, const Gathered& gathered) const {
    const RegionId region = tree_.region(e);
    return gathered.irradiance == Spectrum() && !is_in_open(stage_, x, stage_.scene.regions()[region].plane.n, region);
}

/// Fits a polynomial to the gathered light of those places that can be seen.
SampledElement LocalPass::fitted(ElementId e, const std::vector<WeightedPlace>& places, bool curved,
                                 Workspace& w) const {
    w.hidden.clear();
    for (std::size_t i = 0; i < places.size(); ++i)
        w.hidden.push_back(is_hidden(e, tree_.patch(e).at(places[i].uv), w.gathered[i]));
    if (std::find(w.hidden.begin(), w.hidden.end(), true) != w.hidden.end())
        continue_below(tree_, e, places, w.hidden, curved, w.gathered);
    return fit_gathered(tree_, e, places, w.gathered, stage_.scene.material(tree_.region(e)).reflectance, curved,
                        spread_.gain());
}

/// Samples an element. The first number of rays follows from its area, or is the number that it or its parent took
/// before. It is then raised to 1.5, 2, 3, 4 times and so on, until the noise is small enough. An element that must be
/// split is left noisy, since its pieces will be gathered.
SampledElement LocalPass::sample(ElementId e, const ReflectedLight& b, const LocalPassDemand& demand, bool may_cut,
                                 Workspace& w) const {
    const std::vector<WeightedPlace> places = element_rule(tree_, e, rule_order(demand.curved));
    const ElementId parent = tree_.parent(e);
    const unsigned before = sampled_[e].place_rays > 0 ? sampled_[e].place_rays
                            : parent.is_none()         ? 0
                                                       : sampled_[parent].place_rays / 2;
    // if true, the element's area has no weight, and it gets the minimum number of rays
    const bool unlit = stage_.is_unlit(tree_.region(e));
    // Rays of a place follow from the noise allowed to the power of -4/3 (`knobs_for_error`).
    const double allowance = std::pow(noise_factor_in(e, demand), 4.0 / 3);
    // In a crowd every element starts with few rays. More follow only where its noise requires them, since the area of
    // an element says little about its share of the light.
    constexpr unsigned min_rays = 4;
    const unsigned first = is_crowd_ ? min_rays
                           : unlit   ? std::bit_ceil(demand.rays.min)
                                     : demand.rays.rays(stage_.counted_area(tree_, e) / allowance, mean_area_);
    unsigned rays = std::max({min_rays, first, before});
    w.growing.assign(places.size(), {});
    for (bool more = false;; rays *= more ? 2 : 1, more = !more) {
        const unsigned cast = gather_at(e, places, b, rays, more, demand, w);
        SampledElement out = fitted(e, places, demand.curved, w);
        out.place_rays = rays;
        out.rays = cast;
        if (may_cut && is_too_rough(e, out, demand)) return out;
        if (noise_excess(e, out, demand) <= calibrated::tolerated_noise || 2 * rays > demand.rays.max) {
            if (may_cut && demand.elements.empty())
                is_suspect(e) ? check_strips(e, out, b, demand, w) : check_between_nodes(e, out, b, demand, w);
            return out;
        }
    }
}

/// Adds a change of the light to an element's polynomial. The change needs fewer rays than the whole light. An element
/// that is too noisy in any case is returned unchanged, to be gathered again.
SampledElement LocalPass::changed(ElementId e, const LocalPassDemand& demand, Workspace& w) const {
    const SampledElement& before = sampled_[e];
    if (noise_excess(e, before, demand) > calibrated::kept_noise) return before;
    constexpr unsigned min_rays = 4, share = 8;  // initial share of the rays of a place: 1 / share
    const std::vector<WeightedPlace> places = element_rule(tree_, e, rule_order(before.curved));
    w.growing.assign(places.size(), {});
    for (unsigned rays = std::max(min_rays, before.place_rays / share);; rays *= 2) {
        const unsigned cast = gather_at(e, places, *demand.change, rays, false, demand, w);
        SampledElement out = fitted(e, places, before.curved, w);
        for (std::size_t k = 0; k < out.coefficient.size(); ++k)
            for (std::size_t b = 0; b < bands; ++b) out.coefficient[k][b] += before.coefficient[k][b];
        out.light = before.light, out.quarters = before.quarters, out.halves = before.halves;
        out.noise_squared += before.noise_squared;
        out.misfit_squared += before.misfit_squared, out.noise_in_misfit += before.noise_in_misfit;
        out.rays = before.rays + cast, out.place_rays = before.place_rays;
        if (noise_excess(e, out, demand) <= calibrated::kept_noise || 2 * rays > before.place_rays) return out;
    }
}

/// Checks the polynomial between the nodes. Light in a slit between two boards, or at the mouth of a gap, varies over
/// less than the distance of the nodes. The polynomial is compared with a few rays at random places; if the difference
/// exceeds their noise, it counts as misfit.
void LocalPass::check_between_nodes(ElementId e, SampledElement& sampled, const ReflectedLight& b,
                                    const LocalPassDemand& demand, Workspace& w) const {
    constexpr unsigned share = 8;  // the check takes about 1 / share of the rays that the element took before
    constexpr unsigned min_places = 4, max_places = 32;
    unsigned rays = 16, count = std::min(max_places, sampled.rays / (share * rays));
    if (is_narrow_leaf(stage_, tree_, e)) {
        // With 16 places, one is at the mouth of a gap with a probability of 19/20 if the mouth is a sixth of the
        // element.
        constexpr unsigned places_before_gaps = 16, rays_before_gaps = 64;
        count = std::max(count, places_before_gaps), rays = rays_before_gaps;
    }
    if (count < min_places) return;  // too few places to estimate their noise
    const RegionId region = tree_.region(e);
    const Normal& n = stage_.scene.regions()[region].plane.n;
    const Spectrum& rho = stage_.scene.material(region).reflectance;
    const SampledFunction polynomial(tree_, e, sampled);
    const std::uint64_t key = hash(seed_, static_cast<std::uint64_t>(Stream::gather), e.value, ~std::uint64_t{0});
    const ScrambledSobol random(key);
    double misfit = 0, noise = 0;
    for (unsigned k = 0; k < count; ++k) {
        const Vec2 uv = tree_.uniform(e, random(k, 0), random(k, 1));
        const Point x = tree_.patch(e).at(uv);
        const Gathered g = gather_reflected(stage_, x, n, region, rays, hash(key, k), b, w.rays);
        if (is_hidden(e, x, g)) continue;
        misfit += squared(rho * (g.irradiance - polynomial.at(uv))) / static_cast<double>(bands) / count;
        noise += spread_.gain() * mean(rho * rho * g.quarters) / count;
    }
    sampled.rays += rays * count;
    const double allowed = allowed_misfit(e, sampled.light, demand);
    if (!(misfit > allowed * allowed + 3 * noise)) return;
    sampled.misfit_squared = std::max(sampled.misfit_squared, misfit + noise_misfit_bound * sampled.noise_in_misfit);
}

/// Squared misfit allowed on each of many small elements, from the present misfits of all.
double LocalPass::share_in_crowd(const LocalPassDemand& demand) const {
    std::vector<double> errors;
    for (ElementId e : tree_.leaves()) {
        const SampledElement& s = sampled_[e];
        const double light = light_near(e, demand);
        const double misfit = std::max(0.0, s.misfit_squared - s.noise_in_misfit);
        if (light > 0) errors.push_back(stage_.counted_area(tree_, e) * misfit / (light * light));
    }
    return share_of_crowd(std::move(errors), demand.tolerance * demand.tolerance * stage_.area);
}

/// Splits the elements whose misfit exceeds their share; returns the new leaves.
std::vector<ElementId> LocalPass::split_where_needed(const std::vector<ElementId>& candidates,
                                                     const LocalPassDemand& demand) {
    std::vector<ElementId> fresh;
    for (ElementId e : candidates)
        if (const SampledElement& s = sampled_[e]; is_too_rough(e, s, demand)) {
            const double tolerated = tolerated_misfit_squared(e, s, demand);
            const Cut only = sufficient_cut(s.misfit_squared, s.misfit_along, tolerated);
            for (ElementId child : refine_element(tree_, e, only)) fresh.push_back(child);
        }
    return fresh;
}

/// Sets the errors of the whole and of every room.
void LocalPass::record_parts(LocalPassReport& report) const {
    struct Sum {
        double area = 0, noise = 0, interpolation = 0;

        void add(double of_area, const SampledElement& s) {
            area += of_area, noise += of_area * s.noise_squared;
            interpolation += of_area * (s.misfit_squared - s.noise_in_misfit);
        }
        LocalPassReport::Parts root_mean() const {
            if (!(area > 0)) return {};
            return {std::sqrt(noise / area), std::sqrt(std::max(0.0, interpolation) / area)};
        }
    };
    Sum whole;
    std::vector<Sum> rooms(stage_.rooms.count());
    for (ElementId e : tree_.leaves()) {
        if (stage_.is_unlit(tree_.region(e))) continue;
        whole.add(tree_.area(e), sampled_[e]);
        if (!rooms.empty()) rooms[stage_.rooms.of(tree_, e)].add(tree_.area(e), sampled_[e]);
    }
    report.whole = whole.root_mean();
    report.rooms.clear();
    for (const Sum& room : rooms) report.rooms.push_back(room.root_mean());
}

ElementFunction LocalPass::finished(const LocalPassDemand& demand, LocalPassReport& report) const {
    ElementFunction out;
    out.tree = tree_;
    const std::vector<StraightLeaf> straight = add_straight(
        out, tree_.leaves(), [&](ElementId e) -> const SampledElement& { return sampled_[e]; },
        [&](ElementId e) { return stage_.scene.material(tree_.region(e)).reflectance; },
        [&](ElementId e) { return calibrated::minor_misfit * allowed_misfit(e, sampled_[e].light, demand); });
    report.leaves.resize(out.tree.size());
    for (const auto [leaf, of] : straight) {
        const SampledElement& s = sampled_[of];
        report.leaves[leaf] = {std::sqrt(s.misfit_squared + s.noise_squared), s.rays};
    }
    out = nearest_continuous(out, stage_.scene, stage_.contacts);
    // Polynomials that are made continuous overshoot next to steep falls. Irradiance is not negative.
    for (std::array<float, bands>& value : out.values)
        for (float& v : value) v = std::max(0.0f, v);
    record_parts(report);
    return out;
}

/// Returns the leaves that must be gathered: those that are unknown or too noisy. Other leaves with too large a misfit
/// are split, and their parts are returned.
std::vector<ElementId> LocalPass::to_gather_again(std::vector<ElementId> leaves, const LocalPassDemand& demand) {
    const auto good = [&](ElementId e) {
        return sampled_[e].place_rays > 0 && noise_excess(e, sampled_[e], demand) <= calibrated::kept_noise;
    };
    std::vector<ElementId> kept;
    std::copy_if(leaves.begin(), leaves.end(), std::back_inserter(kept), good);
    std::erase_if(leaves, good);
    if (is_crowd_) min_share_ = share_in_crowd(demand);
    for (ElementId child : split_where_needed(kept, demand)) leaves.push_back(child);
    return leaves;
}

/// Restricts the polynomial of a split element to one of its parts.
SampledElement LocalPass::part_of(ElementId whole, ElementId part) const {
    const SampledElement& known = sampled_[whole];
    const SampledFunction polynomial(tree_, whole, known);
    const std::vector<WeightedPlace> places = element_rule(tree_, part, rule_order(known.curved));
    std::vector<Gathered> values(places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
        values[i].irradiance = polynomial.at(tree_.patch(whole).coordinates(tree_.patch(part).at(places[i].uv)));
    const Spectrum& rho = stage_.scene.material(tree_.region(part)).reflectance;
    SampledElement out = fit_gathered(tree_, part, places, values, rho, known.curved, 1);
    out.noise_squared = known.noise_squared;
    out.misfit_squared = known.misfit_squared, out.noise_in_misfit = known.noise_in_misfit;
    return out;
}

/// Restricts known polynomials to elements that were not gathered for lack of time. Returns false if some have no known
/// ancestor.
bool LocalPass::inherit() {
    bool is_whole = true;
    for (ElementId e : tree_.leaves()) {
        ElementId whole = e;
        while (!whole.is_none() && sampled_[whole].place_rays == 0) whole = tree_.parent(whole);
        if (whole.is_none())
            is_whole = false;
        else if (whole != e)
            sampled_[e] = part_of(whole, e);
    }
    return is_whole;
}

std::size_t LocalPass::rays_of(std::span<const ElementId> elements) const {
    std::size_t rays = 0;
    for (ElementId e : elements) rays += sampled_[e].rays;
    return rays;
}

ElementFunction LocalPass::gather(const ReflectedLight& b, bool fresh, const LocalPassDemand& demand,
                                  LocalPassReport& report, Progress& progress, const StopRequest& stop,
                                  SafePoints safe_points) {
    constexpr int change = -1;  // number of the round that gathers a change; it precedes the rounds of refinement
    std::vector<ElementId> active = tree_.leaves();
    const bool known = !fresh && sampled_.size() == tree_.size();
    int depth = known && demand.change ? change : 0;
    std::size_t begun = 0;        // elements of `active` that a resumed run has gathered
    std::size_t rays_before = 0;  // rays of the active elements, if only a change is gathered
    const bool resumed = safe_points.resume([&](auto& a) { a(active, depth, begun, report.rays, rays_before); });
    divide_among_bodies(demand);
    if (!resumed && known) report.rays += follow_rough_places(b, demand);
    if (!resumed && depth == change) rays_before = rays_of(active);
    if (!resumed && known && depth == 0) active = to_gather_again(std::move(active), demand);
    if (!resumed && is_crowd_ && depth == 0 && demand.elements.empty())
        active = gather_together(active, b, demand, report, progress, stop);
    // With very many elements, the allowed misfit of each follows from the misfits of all in the first round.
    const auto may_cut = [&](int at) { return at < demand.max_depth && !(is_crowd_ && at == 0); };
    for (; !active.empty(); ++depth) {
        sampled_.resize(tree_.size());
        // Elements are processed in slices, so that progress can be reported; slices are few, since threads wait for
        // each other at the end of each. A stop request is checked at every element, and elements that it skips are not
        // used.
        const std::size_t slice = std::max<std::size_t>(256, active.size() / 16 + 1);
        for (std::size_t first = std::exchange(begun, 0); first < active.size() && !stop.requested(); first += slice) {
            safe_points.pass([&](auto& a) { a(active, depth, first, report.rays, rays_before); });
            const auto slice_of = std::span(active).subspan(first, std::min(slice, active.size() - first));
            const auto [lowest, highest] = std::minmax_element(slice_of.begin(), slice_of.end());
            shared_ranges_of(
                sampled_.span().subspan(lowest->value, highest->value - lowest->value + 1), slice_of.size(), 1,
                [&](std::size_t begin, std::size_t end) {
                    Workspace workspace;
                    for (std::size_t i = first + begin; i < first + end && !stop.requested(); ++i) {
                        const ElementId e = active[i];
                        sampled_[e] = depth == change ? changed(e, demand, workspace)
                                                      : sample(e, b, demand, may_cut(depth), workspace);
                        note_touched("rays", sampled_[e].rays);
                    }
                },
                [&](std::size_t i) -> SampledElement& { return sampled_[active[first + i]]; },
                {"gather", [&](std::size_t i) { return tree_.region(active[first + i]).value; }});
            for (std::size_t i = first; depth != change && i < std::min(first + slice, active.size()); ++i) {
                const SampledElement& s = sampled_[active[i]];
                spread_.quarters += tree_.area(active[i]) * s.quarters;
                spread_.halves += tree_.area(active[i]) * s.halves;
            }
            // The first round is about half of the work, every further round half of the remaining work.
            const double done = static_cast<double>(first) / static_cast<double>(active.size());
            if (depth != change) progress.advance(1 - std::ldexp(1 - 0.5 * done, -depth));
        }
        if (demand.elements.empty()) report.rays += rays_of(active) - std::exchange(rays_before, 0);
        if (stop.requested()) report.interrupted = !inherit();
        if (depth == demand.max_depth || stop.requested()) break;
        if (depth != change && is_crowd_) min_share_ = share_in_crowd(demand);
        active = depth == change ? to_gather_again(std::move(active), demand) : split_where_needed(active, demand);
        divide_among_bodies(demand);
    }
    tree_.shrink_to_fit(), sampled_.shrink_to_fit();
    share_on_node(tree_), share_on_node(sampled_.span());
    return finished(demand, report);
}

}  // namespace exitance
