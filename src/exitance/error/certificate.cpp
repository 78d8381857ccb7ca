#include "exitance/error/certificate.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "exitance/base/loop_progress.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/calibration/error_budget.hpp"
#include "exitance/error/body_errors.hpp"
#include "exitance/error/coarse_response.hpp"
#include "exitance/error/error_factors.hpp"
#include "exitance/error/error_tail.hpp"
#include "exitance/error/sample_sums.hpp"
#include "exitance/error/surface_errors.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/transport/narrow_places.hpp"

namespace exitance {

struct Certifier::Content {
    const Stage& stage;
    const GlobalLight& light;
    const ElementFunction& indirect;
    const ReflectedLight& b;
    CertificateOptions options;
    double mean_reflected;
    std::optional<ElementLocator> own_coarse;
    const ElementLocator& coarse;
    CoarseResponse response;
    std::size_t looks = 0;
    double share_shown = 0;  ///< Share of the phase that is done, for the progress; bodies are its second half.
    std::vector<ResidualSample> samples;  ///< Samples of all calls of `measure`.
    /// Smooth part of the error after the last `measure`, by leaf number of the coarse mesh.
    std::vector<Spectrum> late;
    Field<ElementId, std::uint8_t> narrow;  ///< Marks the narrow leaves of the delivered function.
    PathTracer paths;
    DirectCheck check;
    /// How the hits of rays from each room are checked; chosen before the first measurement. One if the scene is one
    /// room.
    std::vector<CheckPlan> plans;

    Content(const Stage& stage_, const GlobalLight& light_, const ElementFunction& indirect_, const ReflectedLight& b_,
            const CertificateOptions& options_)
        : stage(stage_),
          light(light_),
          indirect(indirect_),
          b(b_),
          options(options_),
          mean_reflected(light.mean_reflected(stage.area)),
          coarse(options.coarse ? *options.coarse : own_coarse.emplace(light.tree, stage.scene.regions().size())),
          response(stage, light, coarse, options),
          paths(stage),
          check(stage, paths, options.projected, {.relative = ErrorBudget(options.error).checked_hit()}) {
        if (mean_reflected > 0 && options.places.empty()) narrow = find_narrow_leaves(stage, indirect.tree);
    }

    ResidualSampler sampler() const {
        return {stage, {indirect, b}, check, options, response.constant(), {light.tree, light.numbering, coarse}};
    }
    /// Returns the mean reflected light of a room, W/m^2, to which its errors are relative.
    double light_of_room(std::size_t room) const {
        return options.light_in.empty() ? mean_reflected : options.light_in[room] * mean_reflected;
    }
    void plan_checks(std::span<const WeightedSample> places);
    CheckPlan plan_checks_from(std::size_t room, std::span<const WeightedSample> places) const;
    void measure_residuals(std::size_t later);
    void measure_p99(Certificate& out);
    void measure_each_body(Certificate& out);
    std::vector<BodyAtPoints> bodies_at_points() const;
    void choose_largest(Certificate& out) const;
    double raise_by_paths(const LatePaths& by_paths, Certificate& out);
    void check_by_paths(Certificate& out);
    double true_mean(double mean_error) const;
    bool is_rough(const ResidualSample& s, double weight, const SampleSums& all, double light) const;
    RoughPlace rough_place(const ResidualSample& s) const;
    Certificate judge();
    void judge_rooms(Certificate& out);
    std::vector<RoomError> rooms;
    std::vector<BodyError> bodies;        ///< Sorted by descending area.
    std::vector<PointError> body_points;  ///< Points of the bodies that were measured at further points.
    ErrorFactors factors;                 ///< Factors on all errors, by paths; lists are empty before `check_by_paths`.
    SampleSums whole_sums;                ///< Sums over all samples, after the last `judge`.
    std::vector<SampleSums> room_sums;    ///< Sums over the samples of every room; empty if the scene is one room.
    std::vector<double> room_uncertainties;  ///< Standard errors of the errors of `rooms`.

    double factor_of_room(std::size_t room) const { return factors.rooms.empty() ? 1 : factors.rooms[room]; }
    double factor_of_body(SurfaceId face) const {
        return factors.bodies.empty() ? 1 : factors.bodies[options.bodies->body[face]];
    }
};

/// Chooses the parameters for checking hits of rays from a room, from a pilot at some of its places.
CheckPlan Certifier::Content::plan_checks_from(std::size_t room, std::span<const WeightedSample> places) const {
    // Places of a pilot: 64 of all rooms together, but at least 16 of each, or 8 if there are many.
    const std::size_t rooms = plans.size(), few = std::clamp<std::size_t>(256 / rooms, 8, 16);
    const std::size_t pilots = std::max(few, 64 / rooms);
    std::vector<PilotPlace> at;
    const std::size_t step = std::max<std::size_t>(1, places.size() / pilots);
    for (std::size_t k = step / 2; k < places.size(); k += step) {
        const ElementTree::Place& place = places[k].place;
        const unsigned rays = options.summed ? ResidualSampler::rays_beside_sums : sampler().rays_at(place.element);
        at.push_back({{indirect.tree.patch(place.element).at(place.uv), indirect.tree.region(place.element)},
                      places[k].weight,
                      static_cast<double>(rays)});
    }
    // The noise of a point may be as large as the requested error, since the certificate averages over hundreds of
    // points. If the light is summed rather than sampled, these rays are the only noise.
    const double light_there = mean_reflected * (options.allowed_in.empty() ? 1 : options.allowed_in[room]);
    const double resolved = (options.summed ? 0.5 : 1) * options.error * light_there;
    const unsigned rays = options.summed ? ResidualSampler::rays_beside_sums : certificate_rays(0);
    return plan_check(check, stage, b, at, room == 0 ? hash(options.seed, 3) : hash(options.seed, 3, room),
                      {.tolerated = rays * resolved * resolved, .gather_is_noisy = !options.summed});
}

/// Chooses the parameters for checking hits, room by room. Windows of a dim room show bright surroundings, whose errors
/// are large beside the light of the room.
void Certifier::Content::plan_checks(std::span<const WeightedSample> places) {
    plans.resize(std::max<std::size_t>(1, stage.rooms.count()));
    std::vector<std::vector<WeightedSample>> of_room(plans.size());
    for (const WeightedSample& at : places)
        of_room[stage.rooms.count() > 0 ? stage.rooms.of(indirect.tree, at.place.element) : 0].push_back(at);
    for (std::size_t room = 0; room < plans.size(); ++room) plans[room] = plan_checks_from(room, of_room[room]);
}

/// Measures the residual at further stratified points, twice at each. `later`: number of calls that are expected to
/// follow.
void Certifier::Content::measure_residuals(std::size_t later) {
    const std::uint64_t seed = looks == 0 ? options.seed : hash(options.seed, looks);
    const std::vector<WeightedSample> places = options.places.empty()
                                                   ? stratified_places(stage, indirect.tree, narrow, options, seed)
                                                   : in_turn(options.places, options.points);
    const std::size_t before = samples.size();
    samples.resize(before + places.size());
    const ResidualSampler sampler = this->sampler();
    if (looks == 0) plan_checks(places);
    const bool may_stop = looks > 0;
    const double from = std::exchange(share_shown, share_shown + (0.5 - share_shown) / static_cast<double>(1 + later));
    if (sampler.measure(places, plans, seed, std::span(samples).subspan(before), may_stop ? options.stop : nullptr,
                        {options.progress, from, share_shown, "points"}))
        ++looks;
    else
        samples.resize(before);
}

/// Estimates the error of each room.
void Certifier::Content::judge_rooms(Certificate& out) {
    const std::size_t count = stage.rooms.count();
    const std::vector<double> found =
        options.delivered_in.empty() ? response.reflected_by_room() : options.delivered_in;
    rooms.clear(), room_sums.assign(count, {}), room_uncertainties.clear();
    if (count == 0) {
        rooms = {{stage.area, found[0], out.estimate, out.mean_reflected}};
        room_uncertainties = {out.uncertainty};
        return;
    }
    std::vector<SampleSums>& sums = room_sums;
    for (std::size_t k = 0; k < samples.size(); ++k) sums[samples[k].room].add(samples[k], samples[k].weight, k);
    for (const ResidualSample& s : samples) {
        if (!is_rough(s, s.weight, sums[s.room], light_of_room(s.room))) continue;
        sums[s.room].rough += s.weight * mean(s.local1 * s.local2);
        out.rough_places.push_back(rough_place(s));
    }
    for (std::size_t room = 0; room < count; ++room) {
        const double light_there = light_of_room(room);
        for (double& square : sums[room].squared) square /= sums[room].weight > 0 ? sums[room].weight : 1;
        const BatchMean error(sums[room].squared);
        const double estimate = std::sqrt(std::max(error.mean, error.standard_error)) / light_there;
        rooms.push_back({stage.rooms.area(room), found[room], estimate, light_there});
        room_uncertainties.push_back(estimate > 0 ? 0.5 * error.standard_error / (estimate * light_there * light_there)
                                                  : 0);
    }
}

/// Finds the worst room, and sets the parts of the error where it is largest: in the whole scene or in that room.
void Certifier::Content::choose_largest(Certificate& out) const {
    const auto worst = std::max_element(rooms.begin(), rooms.end(),
                                        [](const RoomError& x, const RoomError& y) { return x.error < y.error; });
    const auto room = static_cast<std::size_t>(worst - rooms.begin());
    out.worst_room = worst->error, out.room_uncertainty = room_uncertainties[room];
    out.largest_room.reset(), out.largest_light = out.mean_reflected, out.again = factors.whole;
    if (options.gathered) whole_sums.set_parts(out, out.mean_reflected);
    if (room_sums.empty() || out.worst_room <= out.estimate) return;
    out.largest_room = room, out.largest_light = worst->reference, out.again = factor_of_room(room);
    if (room_sums[room].divided_weight > 0) room_sums[room].set_parts(out, worst->reference);
}

/// Returns the mean reflected radiosity of the true light, to which errors are relative, W/m^2: that of the method's
/// light, plus the mean error if that is large and the delivered function holds all light. Relative to itself, light
/// that is far too bright would look accurate, and light that is far too dark would look worse than it is.
double Certifier::Content::true_mean(double mean_error) const {
    constexpr double ignored = 0.1, min_share = 0.1;  // shares of mean_reflected; derived from its uncertainty

    if (!options.direct_in_elements || std::abs(mean_error) <= ignored * mean_reflected) return mean_reflected;
    return std::max(mean_reflected + mean_error, min_share * mean_reflected);
}

/// True if the local pass's error at one point, with this weight, is a notable part of the whole allowed error and of
/// the mean square of all points in `all`. `light`: to which the error is relative, W/m^2.
bool Certifier::Content::is_rough(const ResidualSample& s, double weight, const SampleSums& all, double light) const {
    if (!s.is_divided || !(all.divided_weight > 0)) return false;
    // Derived from the initial number of points: forty times the share that each point has if the error is uniform.
    constexpr double notable = 1.0 / 32;
    const double allowed = options.error * light, share = weight / all.divided_weight;
    return share * mean(s.local1 * s.local2) > notable * std::max(allowed * allowed, all.local / all.divided_weight);
}

RoughPlace Certifier::Content::rough_place(const ResidualSample& s) const {
    return {s.region, indirect.tree.patch(s.place.element).at(s.place.uv)};
}

/// Computes the certificate from the samples of all calls of `measure`.
Certificate Certifier::Content::judge() {
    Certificate out{.constant = response.constant(),
                    .mean_reflected = mean_reflected,
                    .points = samples.size(),
                    .rays = response.rays()};
    late = response.smooth_error(samples);
    const auto count = static_cast<double>(looks);
    SampleSums sums;
    std::array<double, batches> residual_squared{};
    double mean_error = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        ResidualSample& s = samples[k];
        const double weight = s.weight / count;
        s.squared = s.is_covered ? 0 : mean((s.r1 + late[s.leaf]) * (s.r2 + late[s.leaf]));
        sums.add(s, weight, k);
        residual_squared[k % batches] += weight * batches * mean(s.r1 * s.r2);
        mean_error += weight * mean(0.5 * (s.r1 + s.r2) + late[s.leaf]);
        out.rays += s.rays;
    }
    out.mean_reflected = out.largest_light = true_mean(mean_error);
    for (const ResidualSample& s : samples) {
        if (!is_rough(s, s.weight / count, sums, mean_reflected)) continue;
        sums.rough += s.weight / count * mean(s.local1 * s.local2);
        if (stage.rooms.count() == 0) out.rough_places.push_back(rough_place(s));
    }
    whole_sums = sums, factors = {};
    const BatchMean residual(residual_squared), error(sums.squared);
    const double upper = std::max(0.0, residual.mean) + student_95 * residual.standard_error;
    out.residual = std::sqrt(std::max(0.0, residual.mean)) / out.mean_reflected;
    // The reported error is at least its own standard error.
    out.estimate = std::sqrt(std::max(error.mean, error.standard_error)) / out.mean_reflected;
    if (out.estimate > 0)
        out.uncertainty = 0.5 * error.standard_error / (out.estimate * out.mean_reflected * out.mean_reflected);
    out.bound = std::max(out.estimate, out.constant * std::sqrt(upper) / out.mean_reflected);
    judge_rooms(out);
    choose_largest(out);
    return out;
}

/// Returns the error of every body at those points of all calls of `measure` that are on it.
std::vector<BodyAtPoints> Certifier::Content::bodies_at_points() const {
    std::vector<SampleSums> sums(options.bodies->all.size());
    std::vector<BodyAtPoints> out(sums.size());
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const std::size_t body = options.bodies->of(stage.scene, samples[k].region);
        sums[body].add(samples[k], samples[k].weight, k), ++out[body].points;
    }
    for (std::size_t body = 0; body < out.size(); ++body) {
        if (!(sums[body].weight > 0)) continue;
        for (double& square : sums[body].squared) square /= sums[body].weight;
        const BatchMean error(sums[body].squared);
        out[body].mean_square = error.mean, out[body].standard_error = error.standard_error;
    }
    return out;
}

/// Measures the error of every body at points on it. A single body has the error of the scene.
void Certifier::Content::measure_each_body(Certificate& out) {
    if (!options.bodies || !options.places.empty()) return;
    if (options.bodies->all.size() == 1) {
        const SceneBody& body = options.bodies->all[0];
        bodies = {{body.surfaces, body.area, mean_reflected, out.estimate, samples.size(), body.first}};
    } else {
        const std::vector<BodyAtPoints> at_points = bodies_at_points();
        const BodyCheck body_check{stage,     indirect,         b,
                                   check,     sampler(),        *options.bodies,
                                   late,      options.seed,     options.stop,
                                   at_points, options.progress, share_shown};
        const auto light = [&](std::size_t room) { return light_of_room(room); };
        MeasuredBodies found = measure_bodies(body_check, light, options.error, options.check_rays);
        bodies = std::move(found.errors), body_points = std::move(found.points), out.rays += found.rays;
        out.hidden = found.hidden;
        for (BodyError& body : bodies) {
            const double factor = factor_of_body(body.first);
            if (body.error) *body.error *= factor, body.at_least *= factor;
        }
    }
    for (const BodyError& body : bodies)
        if (body.error) out.worst_body = std::max(out.worst_body.value_or(0), *body.error);
}

/// Measures the factors on the errors of the scene, its rooms and its bodies (`measure_error_factors`), and multiplies
/// the first two by them. Returns the mean square of the light that they add, (W/m^2)^2.
double Certifier::Content::raise_by_paths(const LatePaths& by_paths, Certificate& out) {
    ErrorDomains domains{.max_factor = response.constant()};
    for (const RoomError& room : rooms) domains.light_of_room.push_back(room.reference);
    if (options.bodies && options.bodies->all.size() > 1) {
        domains.bodies = options.bodies->all.size();
        for (const ResidualSample& s : samples) domains.body_of.push_back(options.bodies->of(stage.scene, s.region));
    }
    factors = measure_error_factors(by_paths, samples, late, domains, options.seed, options.check_rays / 2);
    out.rays += factors.rays;
    out.estimate *= factors.whole, out.uncertainty *= factors.whole;
    out.bound = std::max(out.bound, out.estimate);
    for (std::size_t room = 0; room < rooms.size(); ++room)
        rooms[room].error *= factors.rooms[room], room_uncertainties[room] *= factors.rooms[room];
    return factors.explained;
}

/// Adds the error that arrives by further reflections and that the coarse response misses, if traced paths find it
/// significant.
void Certifier::Content::check_by_paths(Certificate& out) {
    if (options.bounces >= 0 || options.summed || !options.places.empty()) return;
    const LatePaths by_paths(stage, indirect, b, check, plans, options.direct_in_elements, options.stop);
    const double explained = raise_by_paths(by_paths, out);
    LateMisfit misfit = by_paths.misfit(samples, late, options.seed, options.check_rays / 2);
    out.rays += misfit.rays;
    misfit.mean_square -= explained;
    if (misfit.is_significant()) {
        const double more = std::sqrt(misfit.mean_square) / out.mean_reflected;
        out.estimate = std::hypot(out.estimate, more), out.bound = std::hypot(out.bound, more);
    }
    if (stage.rooms.count() == 0) rooms[0].error = out.estimate;
    choose_largest(out);
}

void Certifier::Content::measure_p99(Certificate& out) {
    constexpr double share = 0.01;  // share of the points above the 99th percentile, given by its name
    constexpr unsigned max_rays = 1 << 14;
    std::vector<WeightedError> points;
    std::vector<unsigned> rays;
    double mean_square = 0;
    for (const ResidualSample& s : samples) {
        const double weight = s.weight / static_cast<double>(looks);
        points.push_back({rms_over_bands(0.5 * (s.r1 + s.r2) + late[s.leaf]), weight});
        rays.push_back(s.rays);
        mean_square += weight * s.squared;
    }
    if (options.summed) {
        out.p99 = error_below(points, {}, share) / mean_reflected;
        return;
    }
    const ResidualSampler sampler = this->sampler();
    const auto by_more_rays = [&](std::span<const std::size_t> which, unsigned factor, std::span<TwoErrors> error) {
        const auto rays_at = [&](std::size_t i) { return std::min(max_rays, factor * samples[i].rays / 2); };
        if (!options.is_stopped())
            for (std::size_t i : which) out.rays += 2 * rays_at(i);
        shared_ranges(
            which.size(), 1,
            [&](std::size_t begin, std::size_t end) {
                ResidualSampler::Workspace workspace;
                for (std::size_t k = begin; k < end; ++k) {
                    const ResidualSample& s = samples[which[k]];
                    error[k] = {s.r1 + late[s.leaf], s.r2 + late[s.leaf]};
                    if (options.is_stopped()) continue;
                    for (std::uint64_t half = 0; half < 2; ++half) {
                        const std::uint64_t key =
                            hash(options.seed, static_cast<std::uint64_t>(Stream::certificate), which[k], factor, half);
                        error[k][half] =
                            late[s.leaf] + sampler.by_rays(s, plans[s.room], rays_at(which[k]), key, workspace);
                    }
                }
            },
            [&](std::size_t k) -> TwoErrors& { return error[k]; }, {"certificate"});
    };
    const double found = error_below(points, rays, mean_square, share, by_more_rays);
    if (found > 0) out.p99 = factors.whole * found / mean_reflected;
}

Certifier::Certifier(const Stage& stage, const GlobalLight& light, const ElementFunction& indirect,
                     const ReflectedLight& b, const CertificateOptions& options)
    : content_(std::make_unique<Content>(stage, light, indirect, b, options)) {}
Certifier::~Certifier() = default;

const std::vector<RoomError>& Certifier::rooms() const {
    return content_->rooms;
}

std::vector<FaceError> Certifier::surface_errors() const {
    const Content& c = *content_;
    if (c.rooms.empty()) return {};
    const Scene& scene = c.stage.scene;
    // The points of bodies that were measured at further points check direct light at more hits. If a face has enough
    // of them, they replace its other points.
    std::vector<PointError> points = c.body_points;
    for (PointError& p : points) p.squared *= std::pow(c.factor_of_body(p.surface), 2);
    Field<SurfaceId, std::size_t> close(scene.surfaces().size(), 0);
    for (const PointError& p : points) ++close[p.surface];
    std::erase_if(points, [&](const PointError& p) { return close[p.surface] < BodyMeasure::min_points; });
    for (const ResidualSample& s : c.samples) {
        if (close[s.surface] >= BodyMeasure::min_points) continue;
        const double light_there = c.rooms[s.room].reference;
        const double factor = c.factor_of_room(s.room) / light_there;
        points.push_back({s.surface, s.weight, factor * factor * s.squared});
    }
    std::vector<double> of_rooms;
    for (SurfaceId s : scene.surfaces().ids()) {
        const RegionId region = scene.surfaces()[s].region;
        const bool is_one = c.stage.rooms.count() == 0;
        of_rooms.push_back(c.rooms[is_one ? 0 : c.stage.rooms.at(region, centroid(scene.outline(s)))].error);
    }
    return exitance::surface_errors(points, of_rooms);
}

Certificate Certifier::measure(std::size_t later) {
    if (content_->mean_reflected <= 0) return {};
    content_->measure_residuals(later);
    return content_->judge();
}

void Certifier::check_by_paths(Certificate& certificate) {
    if (!content_->samples.empty()) content_->check_by_paths(certificate);
}

void Certifier::measure_each_body(Certificate& certificate) {
    if (!content_->samples.empty()) content_->measure_each_body(certificate);
}

const std::vector<BodyError>& Certifier::bodies() const {
    return content_->bodies;
}

void Certifier::measure_p99(Certificate& certificate) {
    if (!content_->samples.empty()) content_->measure_p99(certificate);
}

}  // namespace exitance
