#include "exitance/error/direct_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "exitance/processes/distributed.hpp"

namespace exitance {

DirectCheck::DirectCheck(const Stage& stage, const PathTracer& paths, const ProjectedDirect& projected,
                         const LightAccuracy& accuracy)
    : stage_(&stage), paths_(&paths), projected_(projected), accuracy_(accuracy) {
    // Assumed work of an emitter's unoccluded light at a point, in rays. A diffuse emitter has a closed form, a
    // directed one needs a quadrature, which is some twenty times as expensive. Not measured by a command.
    constexpr double diffuse = 5, directed = 100;
    for (const DirectLight::Emitter& emitter : stage.direct.emitters())
        closed_form_work_ += emitter.radiance.is_directed() ? directed : diffuse;
}

DirectCheck::Difference DirectCheck::exact_difference(const RayEnd& hit, const Spectrum& projected,
                                                      double absolute_error, PlaceLight::Workspace& room) const {
    const Normal& n = stage_->scene.regions()[hit.region].plane.n;
    LightAccuracy accuracy = accuracy_;
    accuracy.absolute += absolute_error;
    const PlaceLight::Estimate direct = stage_->place_light.at(hit.x, n, hit.region, accuracy, room);
    const double of_forms = direct.rays > 0 ? direct.work : std::max(direct.work, closed_form_work_);
    return {projected_.weight * (direct.irradiance - projected), static_cast<double>(direct.rays) + of_forms};
}

Spectrum DirectCheck::sampled_difference(const RayEnd& hit, const Spectrum& projected, RandomStream& random) const {
    const Normal& n = stage_->scene.regions()[hit.region].plane.n;
    return projected_.weight * (paths_->step({hit.x, n, hit.region}, random).direct - projected);
}

Spectrum DirectCheck::missing(const CheckPlan& plan, const GatherWorkspace& gather, std::uint64_t key,
                              Workspace& room) const {
    if (!has_projection() || gather.hits.empty()) return {};
    RandomStream random(key, Stream::certificate);
    room.hits.clear(), room.counts.clear();
    for (std::size_t k = 0; k < gather.fronts.size(); ++k) {
        const double q = probability(plan, gather.fronts[k]);
        if (random.uniform() >= q) continue;
        room.hits.push_back(gather.fronts[k]);
        const Spectrum colour = gather.colours.empty() ? Spectrum(1.0) : gather.colours[k];
        room.counts.push_back((gather.counts.empty() ? 1 : gather.counts[k]) / q * colour);
    }
    room.projected.resize(room.hits.size());
    projected_.irradiance->read(room.hits, room.projected);
    Spectrum sum;
    for (std::size_t k = 0; k < room.hits.size(); ++k) {
        const Spectrum& rho = stage_->scene.material(room.hits[k].region).reflectance;
        if (max(rho) <= 0) continue;
        const Spectrum missing =
            plan.is_exact ? exact_difference(room.hits[k], room.projected[k], plan.absolute_error, room.clustered).light
                          : sampled_difference(room.hits[k], room.projected[k], random);
        sum += room.counts[k] * (rho * missing);
    }
    return sum / static_cast<double>(gather.hits.size());
}

double DirectCheck::probability(const CheckPlan& plan, const RayEnd& hit) const {
    // computing a misfit requires a search, so skip it where it is unused
    return plan.per_misfit > 0 ? plan.probability(misfit(hit)) : plan.share;
}

namespace {

constexpr unsigned pilot_rays = 8;  // rays per place; enough to estimate the variance between rays of one place

/// One hit of a pilot's ray, with its terms in rho E, mean over bands.
struct PilotHit {
    double weight = 0;   ///< Weight of the ray in the mean over all rays.
    double cast = 0;     ///< Share of the rays of all places that this one represents.
    double step = 0;     ///< Square of the difference found by one step of a path, (W/m^2)^2.
    double exact = -1;   ///< Square of the exact difference, (W/m^2)^2; negative: not evaluated.
    double work = 0;     ///< Work of the exact difference, in rays.
    double misfit = 0;   ///< Misfit of the projection, in rho E at the receiver, W/m^2.
    double claimed = 0;  ///< Misfit of the projection at the hit, W/m^2.
    Spectrum factor;     ///< Term in rho E at the receiver over the difference at the hit.
    double square_of(const Spectrum& difference) const { return mean(factor * difference * (factor * difference)); }
};

/// Results of the pilot at one place: squares of the terms of one ray.
struct PilotFound {
    double gather = 0;  ///< Variance of the gather without a check, times the place's weight in the estimate.
    std::array<PilotHit, pilot_rays> hits;
    std::optional<RayEnd> first;  ///< The first hit, at which exact light is evaluated.
    Spectrum projected;           ///< Projected direct light there, W/m^2.
};

PilotFound pilot_at(const DirectCheck& check, const Stage& stage, const ReflectedLight& b, const PilotPlace& place,
                    double rays_of_all, std::uint64_t key, GatherWorkspace& gather, DirectCheck::Workspace& room) {
    PilotFound out;
    const Region& region = stage.scene.regions()[place.at.region];
    cast_gather(stage, place.at.x, region.plane.n, place.at.region, pilot_rays, key, b.bright_places(), gather);
    const Gathered found = read_gather(b, gather);
    RandomStream random(key, Stream::certificate);
    room.projected.resize(gather.fronts.size());
    if (check.has_projection()) check.projected().irradiance->read(gather.fronts, room.projected);
    const Spectrum& reflectance = stage.scene.material(place.at.region).reflectance;
    const double rho2 = mean(reflectance * reflectance), n = pilot_rays;
    double square = 0;
    for (std::size_t k = 0; k < gather.fronts.size(); ++k) {
        const double count = gather.counts.empty() ? 1 : gather.counts[k];
        const RayEnd& hit = gather.fronts[k];
        const Spectrum colour = gather.colours.empty() ? Spectrum(1.0) : gather.colours[k];
        const Spectrum rho = count * (colour * stage.scene.material(hit.region).reflectance);
        square += mean(count * gather.values[k] * (count * gather.values[k]));
        if (!check.has_projection()) continue;
        PilotHit& told = out.hits[k];
        told.weight = place.weight / n, told.cast = place.rays / (n * rays_of_all);
        told.claimed = check.misfit(hit), told.misfit = count * std::sqrt(rho2) * told.claimed;
        told.factor = std::sqrt(rho2) * rho;
        told.step = told.square_of(check.sampled_difference(hit, room.projected[k], random));
        if (k == 0) out.first = hit, out.projected = room.projected[k];
    }
    out.gather =
        place.weight * rho2 * std::max(0.0, (square / n - mean(found.irradiance * found.irradiance)) * n / (n - 1));
    return out;
}

/// Sums over the hits of a pilot.
struct PilotSums {
    double gather = 0, step = 0, misfit = 0, exact = 0, exact_work = 0, exact_weight = 0, exact_cast = 0, weight = 0;
    double factor = 0;  ///< Mean square of `PilotHit::factor`.
};

PilotSums sums_of(std::span<const PilotFound> found) {
    PilotSums V;
    for (const PilotFound& p : found) {
        V.gather += p.gather;
        for (const PilotHit& hit : p.hits) {
            V.weight += hit.weight, V.step += hit.weight * hit.step, V.misfit += hit.weight * hit.misfit;
            V.factor += hit.weight * hit.square_of(Spectrum(1.0));
            if (hit.exact < 0) continue;
            V.exact_weight += hit.weight, V.exact += hit.weight * hit.exact;
            V.exact_cast += hit.cast, V.exact_work += hit.cast * hit.work;
        }
    }
    if (V.exact_weight > 0) V.exact *= V.weight / V.exact_weight, V.exact_work /= V.exact_cast;
    return V;
}

/// Evaluates exact light at the first hit of each place: it may be expensive.
void add_exact_differences(const DirectCheck& check, double absolute_error, std::span<PilotFound> found) {
    shared_ranges(
        found.size(), 1,
        [&](std::size_t begin, std::size_t end) {
            PlaceLight::Workspace room;
            for (PilotFound& at : found.subspan(begin, end - begin)) {
                if (!at.first) continue;
                const DirectCheck::Difference exact =
                    check.exact_difference(*at.first, at.projected, absolute_error, room);
                at.hits[0].exact = at.hits[0].square_of(exact.light), at.hits[0].work = exact.work;
            }
        },
        [&](std::size_t k) -> PilotHit& { return found[k].hits[0]; }, {"certificate"});
}

/// Returns the work of a plan's checks per ray of the gather, in rays. It counts rays as they are cast, not by the
/// weights of their places: places of little weight may have most of the rays. The work of one check is that of the
/// evaluated hits, each as likely as it would be checked.
double work_of_checks(const CheckPlan& plan, std::span<const PilotFound> found) {
    double checked = 0, evaluated = 0, work = 0;
    for (const PilotFound& p : found)
        for (const PilotHit& hit : p.hits) {
            const double q = hit.cast * plan.probability(hit.claimed);
            checked += q;
            if (hit.exact >= 0) evaluated += q, work += q * hit.work;
        }
    return evaluated > 0 ? checked * work / evaluated : 0;
}

/// Evaluates exact light at a pilot's hits, and plans checks by it, with a probability proportional to the misfit. The
/// variance is smallest if the misfit is correct.
CheckPlan plan_by_exact_light(const DirectCheck& check, const OtherNoise& other, double beside, double absolute_error,
                              std::span<PilotFound> found) {
    add_exact_differences(check, absolute_error, found);
    const PilotSums V = sums_of(found);
    const double step_work = check.paths().rays_per_step(), exact_work = std::max(1.0, V.exact_work);
    CheckPlan exact{true, other.min_share * std::min(1.0, step_work / exact_work), 1 / std::sqrt(beside * exact_work),
                    absolute_error};
    double weight = 0;
    for (const PilotFound& p : found)
        for (const PilotHit& hit : p.hits) {
            if (hit.exact < 0) continue;
            exact.variance += hit.weight * hit.exact / exact.probability(hit.claimed);
            weight += hit.weight;
        }
    if (weight > 0) exact.variance *= V.weight / weight;
    exact.work = work_of_checks(exact, found);
    // Differences on a share of the hits that is smaller than 1 / (number of evaluated hits) may have been missed.
    // Assume that they are as large as those found by single steps.
    exact.variance += V.step / static_cast<double>(found.size());
    exact.gather_variance = V.gather;
    return exact;
}

}  // namespace

CheckPlan plan_check(const DirectCheck& check, const Stage& stage, const ReflectedLight& b,
                     std::span<const PilotPlace> places, std::uint64_t seed, const OtherNoise& other) {
    if (places.empty()) return {};
    double rays_of_all = 0, weight_of_all = 0;
    for (const PilotPlace& p : places) rays_of_all += p.rays, weight_of_all += p.weight;
    std::vector<PilotFound> found(places.size());
    shared_ranges(
        places.size(), 1,
        [&](std::size_t begin, std::size_t end) {
            GatherWorkspace gather;
            DirectCheck::Workspace room;
            for (std::size_t k = begin; k < end; ++k) {
                PilotPlace place = places[k];
                place.weight /= weight_of_all;
                found[k] = pilot_at(check, stage, b, place, rays_of_all,
                                    hash(seed, static_cast<std::uint64_t>(Stream::certificate), k, 0), gather, room);
            }
        },
        [&](std::size_t k) -> PilotFound& { return found[k]; }, {"certificate"});
    const PilotSums V = sums_of(found);
    const double beside =
        std::max({other.gather_is_noisy ? V.gather : 0, other.tolerated, std::numeric_limits<double>::min()});
    // First option: single steps, with equal probability at all hits.
    const double step_work = check.paths().rays_per_step();
    CheckPlan step{false, std::clamp(std::sqrt(V.step / (beside * step_work)), other.min_share, 1.0)};
    step.variance = V.step / step.share, step.work = step.share * step_work, step.gather_variance = V.gather;
    if (!(V.factor > 0)) return step;
    const auto cost = [&](const CheckPlan& plan) { return (beside + plan.variance) * (1 + plan.work); };
    // Second option: exact light. Near small emitters and borders of shadows, single steps have rare large values that
    // a pilot misses. Exact light is therefore preferred at up to twice the predicted variance and work.
    const CheckPlan exact = plan_by_exact_light(check, other, beside, 0, found);
    const bool is_safer = exact.variance <= 2 * step.variance && 1 + exact.work <= 2 * (1 + step.work);
    const CheckPlan& best = is_safer || cost(exact) < cost(step) ? exact : step;
    // This is good enough if the checks take less time than the gather.
    if (best.is_exact && best.work < 1) return best;
    // Third option: exact light that is less accurate in dim places, where it would take thousands of rays. Its noise
    // may add a hundredth of the other variance. In such places the first rays often find no light, so that the result
    // seems more accurate than it is. The option is therefore taken only if it is predicted to be much cheaper.
    constexpr double beside_others = 0.1;  // derived from that: error over the standard deviation of the others
    const double dim = beside_others * std::sqrt(beside / V.factor);
    const CheckPlan rougher = plan_by_exact_light(check, other, beside, dim, found);
    return 2 * cost(rougher) < cost(best) ? rougher : best;
}

}  // namespace exitance
