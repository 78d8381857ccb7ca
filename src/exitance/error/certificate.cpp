#include "exitance/error/certificate.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/error/batch_mean.hpp"
#include "exitance/error/body_errors.hpp"
#include "exitance/error/error_tail.hpp"
#include "exitance/error/late_paths.hpp"
#include "exitance/error/mean_residuals.hpp"
#include "exitance/error/residual_samples.hpp"
#include "exitance/error/surface_errors.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/transport/narrow_places.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {
namespace {

/// Returns b + rho H b + (rho H)^2 b + ... on the coarse mesh; b is the right-hand side of the system.
std::vector<Spectrum> respond(const RadiositySystem& system, double residual) {
    std::vector<Spectrum> b(system.rhs.begin(), system.rhs.end());
    solve_radiosity(system, Relaxation::gmres, b, {.residual = residual, .max_iterations = 200});
    return b;
}

double largest(const std::vector<Spectrum>& values) {
    double out = 1;
    for (const Spectrum& v : values) out = std::max(out, max(v));
    return out;
}

/// Returns the accuracy required of exact light at checked hits: half of the requested error. Where the projection is
/// as wrong as the solution, this adds a quarter to the squared differences found; where the projection is worse, and
/// checks matter most, it adds less.
LightAccuracy check_accuracy(double error) {
    constexpr double least = 2e-4, most = 0.1;  // derived from the range of errors that can be requested
    return {.relative = std::clamp(0.5 * error, least, most)};
}

/// Returns the residual for the solves of unit light, which is tighter: the light missing in them makes bounds too
/// small.
double constant_residual() {
    return 0.5 * calibrated::refined_residual;
}

/// Returns the irradiance w = first + H rho w, given the light `first` that arrives without reflection. Solves rho w =
/// rho first + rho H (rho w).
std::vector<Spectrum> irradiance_of(std::span<const Spectrum> first, const RayRows& H, std::span<const Spectrum> rho,
                                    std::span<const double> area) {
    std::vector<Spectrum> reflected, w(rho.size());
    for (std::size_t i = 0; i < rho.size(); ++i) reflected.push_back(rho[i] * first[i]);
    H.gather(respond({H, rho, reflected, area}, constant_residual()), w);
    for (std::size_t i = 0; i < w.size(); ++i) w[i] += first[i];
    return w;
}

/// Returns a bound on the norm of (I - rho H)^-1 in the mean square: sqrt(C_1 C_inf), each from a coarse solve of unit
/// light. `w` is the solution of the adjoint one.
double error_constant(const RayRows& H, std::span<const Spectrum> rho, std::span<const double> area,
                      const std::vector<Spectrum>& w) {
    const std::vector<Spectrum> ones(rho.size(), Spectrum(1.0));
    return std::sqrt(largest(respond({H, rho, ones, area}, constant_residual())) * largest(w));
}

}  // namespace

struct Certifier::Content {
    const Stage& stage;
    const GlobalLight& light;
    const ElementFunction& indirect;
    const ReflectedLight& b;
    CertificateOptions options;
    double mean_reflected, constant = 1;
    std::optional<ElementLocator> own_coarse;
    const ElementLocator& coarse;
    std::vector<Spectrum> rho;
    std::vector<double> area;
    std::vector<std::uint32_t> room_of;  ///< Room of every leaf of the coarse mesh; empty if the scene is one room.
    RayRows H;                           ///< Form factors between the leaves of `light`.
    std::optional<RayRows> other_H;      ///< Like `H`, from other random rays; only if there are several rooms.
    /// Irradiance from light that arrives uniformly on all surfaces; in each room in proportion to the room's light.
    std::vector<Spectrum> even;
    std::size_t looks = 0;
    std::vector<ResidualSample> samples;  ///< Samples of all calls of `look`.
    /// Smooth part of the error after the last `look`, by leaf number of the coarse mesh.
    std::vector<Spectrum> late;
    Field<ElementId, std::uint8_t> narrow;  ///< Marks the narrow leaves of the delivered function.
    PathTracer paths;
    DirectCheck check;
    CheckPlan plan;  ///< How hits are checked; chosen before the first measurement.

    Content(const Stage& stage_, const GlobalLight& light_, const ElementFunction& indirect_, const ReflectedLight& b_,
            const CertificateOptions& options_)
        : stage(stage_),
          light(light_),
          indirect(indirect_),
          b(b_),
          options(options_),
          mean_reflected(light.mean_reflected(stage.area)),
          coarse(options.coarse ? *options.coarse : own_coarse.emplace(light.tree, stage.scene.regions().size())),
          rho(leaf_reflectances(stage.scene, light.tree, light.numbering)),
          area(leaf_areas(light.tree, light.numbering)),
          room_of(rooms_of_leaves()),
          H(rows(options.seed + 1)),
          paths(stage),
          check(stage, paths, options.projected, check_accuracy(options.error)) {
        if (stage.rooms.count() > 0) other_H.emplace(rows(hash(options.seed + 1)));
        share_on_node(std::span(rho)), share_on_node(std::span(area));
        if (mean_reflected <= 0) return;
        const std::vector<Spectrum> ones(rho.size(), Spectrum(1.0));
        even = irradiance_of(ones, H, rho, area);
        constant = error_constant(H, rho, area, even);
        if (!options.light_in.empty()) even = irradiance_of(light_of_rooms(), H, rho, area);
        if (options.places.empty()) narrow = find_narrow_leaves(stage, indirect.tree);
    }

    RayRows rows(std::uint64_t seed) const {
        return {stage, light.tree,          light.numbering,   coarse, {.average = 16, .least = 8, .most = 64},
                seed,  Dealing::by_element, RowsHeld::by_owner};
    }
    std::vector<std::uint32_t> rooms_of_leaves() const;
    std::size_t room_of_leaf(std::size_t i) const { return room_of.empty() ? 0 : room_of[i]; }
    std::vector<Spectrum> light_of_rooms() const;
    ResidualSampler sampler() const { return {stage, indirect, b, check, options, constant, coarse, light.numbering}; }
    /// Returns the mean reflected light of a room, W/m^2, to which its errors are relative.
    double light_of_room(std::size_t room) const {
        return options.light_in.empty() ? mean_reflected : options.light_in[room] * mean_reflected;
    }
    void plan_checks(std::span<const WeightedSample> places);
    void measure_residuals();
    void tell_p99(Certificate& out);
    void look_at_bodies(Certificate& out);
    void check_late(Certificate& out);
    std::vector<Spectrum> mean_residuals(double first) const;
    std::vector<Spectrum> response_to(double first, const RayRows& rows) const;
    std::vector<Spectrum> late_response() const;
    void balance(std::span<const Spectrum> residuals, std::span<Spectrum> errors) const;
    double true_mean(double mean_error) const;
    bool is_rough(const ResidualSample& s, double share, double light, double all) const;
    RoughPlace rough_place(const ResidualSample& s) const;
    Certificate judge();
    void judge_rooms(Certificate& out);
    std::vector<double> mean_by_room() const;
    std::vector<RoomError> rooms;
    std::vector<BodyError> bodies;        ///< Sorted by descending area.
    std::vector<PointError> body_points;  ///< Points of the bodies that were measured at further points.
};

std::vector<std::uint32_t> Certifier::Content::rooms_of_leaves() const {
    if (stage.rooms.count() == 0) return {};
    std::vector<std::uint32_t> out(light.numbering.leaves.size());
    parallel_for(out.size(), 1024, [&](std::size_t i) {
        out[i] = static_cast<std::uint32_t>(stage.rooms.of(light.tree, light.numbering.leaves[i]));
    });
    return out;
}

/// Returns, for every leaf of the coarse mesh, the light of its room divided by the mean light.
std::vector<Spectrum> Certifier::Content::light_of_rooms() const {
    std::vector<Spectrum> out;
    for (std::size_t i = 0; i < rho.size(); ++i) out.emplace_back(options.light_in[room_of_leaf(i)]);
    return out;
}

/// Chooses the parameters for checking hits, from a pilot at some of the places of the first `look`.
void Certifier::Content::plan_checks(std::span<const WeightedSample> places) {
    constexpr std::size_t pilots = 64;
    std::vector<PilotPlace> at;
    const std::size_t step = std::max<std::size_t>(1, places.size() / pilots);
    for (std::size_t k = step / 2; k < places.size(); k += step) {
        const ElementTree::Place& place = places[k].place;
        const unsigned rays = options.summed ? ResidualSampler::rays_beside_sums : sampler().rays_at(place.element);
        at.push_back({{indirect.tree.patch(place.element).at(place.uv), indirect.tree.region(place.element)},
                      places[k].weight,
                      static_cast<double>(rays)});
    }
    // Noise as large as the requested error is acceptable, since that of hundreds of points is averaged. Sums have no
    // other noise.
    const double resolved = (options.summed ? 0.5 : 1) * options.error * mean_reflected;
    const unsigned rays = options.summed ? ResidualSampler::rays_beside_sums : certificate_rays(0);
    plan = plan_check(check, stage, b, at, hash(options.seed, 3),
                      {.tolerated = rays * resolved * resolved, .gather_is_noisy = !options.summed});
}

/// Returns the mean reflected radiosity of every room as found by the method, W/m^2; one entry if the scene is one
/// room.
std::vector<double> Certifier::Content::mean_by_room() const {
    if (stage.rooms.count() == 0) return {mean_reflected};
    std::vector<double> out(stage.rooms.count());
    for (std::size_t i = 0; i < light.reflected.size(); ++i) {
        const std::size_t room = room_of_leaf(i);
        out[room] += area[i] * mean(light.reflected[i]) / stage.rooms.area(room);
    }
    return out;
}

/// Measures the residual at further stratified points, twice at each.
void Certifier::Content::measure_residuals() {
    const std::uint64_t seed = looks == 0 ? options.seed : hash(options.seed, looks);
    const std::vector<WeightedSample> places = options.places.empty()
                                                   ? stratified_places(stage, indirect.tree, narrow, options, seed)
                                                   : in_turn(options.places, options.points);
    const std::size_t before = samples.size();
    samples.resize(before + places.size());
    const ResidualSampler sampler = this->sampler();
    if (looks == 0) plan_checks(places);
    const bool may_stop = looks > 0;
    if (sampler.measure(places, plan, seed, std::span(samples).subspan(before), may_stop ? options.stop : nullptr))
        ++looks;
    else
        samples.resize(before);
}

/// Returns the mean residual of each leaf of the coarse mesh. `first`: weight of the first of the two gathers of every
/// sample.
std::vector<Spectrum> Certifier::Content::mean_residuals(double first) const {
    // A region that extends over several rooms forms one group in each.
    const std::size_t regions = stage.scene.regions().size(), rooms = std::max<std::size_t>(1, stage.rooms.count());
    std::vector<LeafResidual> known;
    for (const ResidualSample& s : samples)
        known.push_back({s.leaf, static_cast<std::uint32_t>(s.room * regions + s.region.value),
                         s.weight * static_cast<double>(options.points), first * s.r1 + (1 - first) * s.r2});
    std::vector<std::uint32_t> group_of_leaf;
    for (std::size_t i = 0; i < rho.size(); ++i)
        group_of_leaf.push_back(
            static_cast<std::uint32_t>(room_of_leaf(i) * regions + light.tree.region(light.numbering.leaves[i]).value));
    return exitance::mean_residuals(light.tree, light.numbering, group_of_leaf, regions * rooms, known);
}

/// Corrects the errors of B such that flux is conserved. If all emitted light is absorbed, and of the delivered light
/// the same amount, the error dE of irradiance satisfies int (1 - rho) dE dA = 0. The samples give a mean residual with
/// noise that the many reflections of a bright room may amplify beyond the error itself. The same residual is therefore
/// added everywhere such that the integral vanishes. With several rooms, it is proportional to the light of the room,
/// like the noise.
void Certifier::Content::balance(std::span<const Spectrum> residuals, std::span<Spectrum> errors) const {
    std::vector<Spectrum> arriving(rho.size());
    H.gather(errors, arriving);
    Spectrum wrong, by_even;
    for (std::size_t i = 0; i < rho.size(); ++i)
        for (std::size_t band = 0; band < bands; ++band) {
            const double r = rho[i][band], absorbed = area[i] * (1 - r);
            wrong[band] += absorbed * (arriving[i][band] + (r > 0 ? residuals[i][band] / r : 0));
            by_even[band] += absorbed * even[i][band];
        }
    for (std::size_t band = 0; band < bands; ++band) {
        if (!(by_even[band] > 0)) continue;
        const double more = wrong[band] / by_even[band];
        for (std::size_t i = 0; i < rho.size(); ++i) errors[i][band] -= more * rho[i][band] * even[i][band];
    }
}

/// Returns the coarse response to the mean residuals, minus these residuals. `first`: weight of the first of the two
/// gathers of every sample; 0.5: equal weights.
std::vector<Spectrum> Certifier::Content::response_to(double first, const RayRows& rows) const {
    const std::vector<Spectrum> rhs = mean_residuals(first);
    std::vector<Spectrum> response = respond({rows, rho, rhs, area}, calibrated::refined_residual);
    // sums are free of noise, so they need no correction
    if (options.keeps_flux && !options.summed) balance(rhs, response);
    for (std::size_t i = 0; i < rhs.size(); ++i) response[i] -= rhs[i];
    return response;
}

/// Returns the smooth part of the error, by leaf number of the coarse mesh. The responses to the two gathers share it,
/// while the noise of their rays is independent. In every room, the mean of both is scaled such that its mean square is
/// the mean product of the two responses.
std::vector<Spectrum> Certifier::Content::late_response() const {
    // In a dark room, light from a brighter room must be distinguished from noise. If the scene is one room, the mean
    // is accurate enough.
    if (options.summed || stage.rooms.count() == 0) return response_to(0.5, H);
    std::vector<Spectrum> one = response_to(1, H);
    const std::vector<Spectrum> other = response_to(0, *other_H);
    const std::size_t count = stage.rooms.count();
    std::vector<double> agreed(count), all(count);
    for (std::size_t i = 0; i < one.size(); ++i) {
        agreed[room_of[i]] += area[i] * mean(one[i] * other[i]);
        one[i] = 0.5 * (one[i] + other[i]);
        all[room_of[i]] += area[i] * mean(one[i] * one[i]);
    }
    for (std::size_t i = 0; i < one.size(); ++i)
        one[i] *= all[room_of[i]] > 0 ? std::sqrt(std::clamp(agreed[room_of[i]] / all[room_of[i]], 0.0, 1.0)) : 0.0;
    return one;
}

/// Estimates the error of each room.
void Certifier::Content::judge_rooms(Certificate& out) {
    const std::size_t count = stage.rooms.count();
    const std::vector<double> found = mean_by_room();
    if (count == 0) {
        rooms = {{stage.area, found[0], out.estimate, out.mean_reflected}};
        out.worst_room = out.estimate, out.room_uncertainty = out.uncertainty;
        return;
    }
    std::vector<std::array<double, batches>> squares(count);
    std::vector<double> weight(count), told(count), local(count), method(count), rough(count);
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const ResidualSample& s = samples[k];
        squares[s.room][k % batches] += s.weight * batches * s.squared;
        weight[s.room] += s.weight;
        if (!s.tells_local) continue;
        told[s.room] += s.weight;
        local[s.room] += s.weight * mean(s.local1 * s.local2);
        method[s.room] += s.weight * mean((s.r1 - s.local1) * (s.r2 - s.local2));
    }
    for (const ResidualSample& s : samples)
        if (told[s.room] > 0 && is_rough(s, s.weight / told[s.room], options.light_in[s.room] * mean_reflected,
                                         local[s.room] / told[s.room])) {
            rough[s.room] += s.weight * mean(s.local1 * s.local2);
            out.rough_places.push_back(rough_place(s));
        }
    rooms.clear();
    for (std::size_t room = 0; room < count; ++room) {
        const double light_there = options.light_in[room] * mean_reflected;
        for (double& square : squares[room]) square /= weight[room] > 0 ? weight[room] : 1;
        const BatchMean error(squares[room]);
        const double estimate = std::sqrt(std::max(error.mean, error.standard_error)) / light_there;
        rooms.push_back({stage.rooms.area(room), found[room], estimate, light_there});
        if (estimate <= out.worst_room) continue;
        out.worst_room = estimate;
        out.room_uncertainty = 0.5 * error.standard_error / (estimate * light_there * light_there);
        if (estimate <= out.estimate) continue;
        out.largest_room = room, out.largest_light = light_there;
        const auto part = [&](double sum) { return std::sqrt(std::max(0.0, sum / told[room])) / light_there; };
        if (told[room] > 0)
            out.local = part(local[room]), out.method = part(method[room]), out.rough = part(rough[room]);
    }
}

/// Returns the mean reflected radiosity of the true light, to which errors are relative, W/m^2: that of the method's
/// light, plus the mean error if that is large and the delivered function holds all light. Relative to itself, light
/// that is far too bright would look accurate, and light that is far too dark would look worse than it is.
double Certifier::Content::true_mean(double mean_error) const {
    constexpr double ignored = 0.1, min_share = 0.1;  // of the mean reflected radiosity; derived from the estimate: a
                                                      // tenth is below its own uncertainty
    if (!options.direct_in_elements || std::abs(mean_error) <= ignored * mean_reflected) return mean_reflected;
    return std::max(mean_reflected + mean_error, min_share * mean_reflected);
}

/// True if the local pass's error at one point, with this share of all weight, is a notable part of the whole allowed
/// error and of its own mean square `all`, (W/m^2)^2. `light`: to which the error is relative, W/m^2.
bool Certifier::Content::is_rough(const ResidualSample& s, double share, double light, double all) const {
    // Derived from the initial number of points: forty times the share that each point has if the error is uniform.
    constexpr double notable = 1.0 / 32;
    const double allowed = options.error * light;
    return s.tells_local && share * mean(s.local1 * s.local2) > notable * std::max(allowed * allowed, all);
}

RoughPlace Certifier::Content::rough_place(const ResidualSample& s) const {
    return {s.region, indirect.tree.patch(s.place.element).at(s.place.uv)};
}

Certificate Certifier::Content::judge() {
    Certificate out{.constant = constant,
                    .mean_reflected = mean_reflected,
                    .points = samples.size(),
                    .rays = H.rays() + (other_H ? other_H->rays() : 0)};
    late = late_response();
    std::array<double, batches> residual_squared{}, error_squared{};
    double local_squared = 0, method_squared = 0, told = 0, mean_error = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        ResidualSample& s = samples[k];
        const double weight = s.weight / static_cast<double>(looks);
        residual_squared[k % batches] += weight * batches * mean(s.r1 * s.r2);
        s.squared = s.is_covered ? 0 : mean((s.r1 + late[s.leaf]) * (s.r2 + late[s.leaf]));
        error_squared[k % batches] += weight * batches * s.squared;
        mean_error += weight * mean(0.5 * (s.r1 + s.r2) + late[s.leaf]);
        if (s.tells_local) {
            told += weight;
            local_squared += weight * mean(s.local1 * s.local2);
            method_squared += weight * mean((s.r1 - s.local1) * (s.r2 - s.local2));
        }
        out.rays += s.rays;
    }
    out.mean_reflected = out.largest_light = true_mean(mean_error);
    double rough_squared = 0;
    for (const ResidualSample& s : samples)
        if (told > 0 &&
            is_rough(s, s.weight / told / static_cast<double>(looks), mean_reflected, local_squared / told)) {
            rough_squared += s.weight / static_cast<double>(looks) * mean(s.local1 * s.local2);
            if (stage.rooms.count() == 0) out.rough_places.push_back(rough_place(s));
        }
    const BatchMean residual(residual_squared), error(error_squared);
    const double upper = std::max(0.0, residual.mean) + student_95 * residual.standard_error;
    out.residual = std::sqrt(std::max(0.0, residual.mean)) / out.mean_reflected;
    if (options.gathered) {
        out.local = std::sqrt(std::max(0.0, local_squared / told)) / out.mean_reflected;
        out.method = std::sqrt(std::max(0.0, method_squared / told)) / out.mean_reflected;
        out.rough = std::sqrt(std::max(0.0, rough_squared / told)) / out.mean_reflected;
    }
    // The reported error is at least its own standard error.
    out.estimate = std::sqrt(std::max(error.mean, error.standard_error)) / out.mean_reflected;
    if (out.estimate > 0)
        out.uncertainty = 0.5 * error.standard_error / (out.estimate * out.mean_reflected * out.mean_reflected);
    out.bound = std::max(out.estimate, constant * std::sqrt(upper) / out.mean_reflected);
    judge_rooms(out);
    return out;
}

/// Measures the error of every body at points on it. A single body has the error of the scene.
void Certifier::Content::look_at_bodies(Certificate& out) {
    if (!options.bodies || !options.places.empty()) return;
    if (options.bodies->all.size() == 1) {
        const SceneBody& body = options.bodies->all[0];
        bodies = {{body.surfaces, body.area, mean_reflected, out.estimate, samples.size(), body.first}};
    } else {
        const BodyCheck body_check{stage, indirect,     b,           check, sampler(), *options.bodies,
                                   late,  options.seed, options.stop};
        const auto light = [&](std::size_t room) { return light_of_room(room); };
        MeasuredBodies found = measure_bodies(body_check, light, options.error, options.check_rays);
        bodies = std::move(found.errors), body_points = std::move(found.points), out.rays += found.rays;
        out.hidden = found.hidden;
    }
    for (const BodyError& body : bodies)
        if (body.error) out.worst_body = std::max(out.worst_body.value_or(0), *body.error);
}

/// Adds the error that arrives by further reflections and that the coarse response misses, if traced paths find it
/// significant.
void Certifier::Content::check_late(Certificate& out) {
    if (options.bounces >= 0 || options.summed || !options.places.empty()) return;
    const LatePaths by_paths(stage, indirect, b, check, options.direct_in_elements);
    const LateMisfit misfit = by_paths.misfit(samples, late, options.seed, options.check_rays / 2);
    out.rays += misfit.rays;
    if (!misfit.is_significant()) return;
    const double more = std::sqrt(misfit.mean_square) / out.mean_reflected;
    out.estimate = std::hypot(out.estimate, more), out.bound = std::hypot(out.bound, more);
    if (stage.rooms.count() == 0) out.worst_room = rooms[0].error = out.estimate;
}

void Certifier::Content::tell_p99(Certificate& out) {
    constexpr double share = 0.01;  // given by the name
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
                        error[k][half] = late[s.leaf] + sampler.by_rays(s, plan, rays_at(which[k]), key, workspace);
                    }
                }
            },
            [&](std::size_t k) -> TwoErrors& { return error[k]; }, {"certificate"});
    };
    out.p99 = error_below(points, rays, mean_square, share, by_more_rays) / mean_reflected;
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
    Field<SurfaceId, std::size_t> close(scene.surfaces().size(), 0);
    for (const PointError& p : points) ++close[p.surface];
    std::erase_if(points, [&](const PointError& p) { return close[p.surface] < BodyMeasure::min_points; });
    for (const ResidualSample& s : c.samples) {
        if (close[s.surface] >= BodyMeasure::min_points) continue;
        const double light_there = c.rooms[s.room].reference;
        points.push_back({s.surface, s.weight, s.squared / (light_there * light_there)});
    }
    std::vector<double> of_rooms;
    for (SurfaceId s : scene.surfaces().ids()) {
        const RegionId region = scene.surfaces()[s].region;
        const bool is_one = c.stage.rooms.count() == 0;
        of_rooms.push_back(c.rooms[is_one ? 0 : c.stage.rooms.at(region, centroid(scene.outline(s)))].error);
    }
    return exitance::surface_errors(points, of_rooms);
}

Certificate Certifier::look() {
    if (content_->mean_reflected <= 0) return {};
    content_->measure_residuals();
    return content_->judge();
}

void Certifier::look_at_bodies(Certificate& certificate) {
    if (content_->samples.empty()) return;
    content_->check_late(certificate);  // before the bodies: a single one has the error of the scene
    content_->look_at_bodies(certificate);
}

const std::vector<BodyError>& Certifier::bodies() const {
    return content_->bodies;
}

void Certifier::tell_p99(Certificate& certificate) {
    if (!content_->samples.empty()) content_->tell_p99(certificate);
}

}  // namespace exitance
