#include "exitance/error/coarse_response.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/calibration/numbers.hpp"
#include "exitance/error/mean_residuals.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/transport/crowd_rays.hpp"

namespace exitance {
namespace {

/// Returns the form factors between the leaves of the mesh of `light`, from random rays.
RayRows rows_by_rays(const Stage& stage, const GlobalLight& light, const ElementLocator& coarse, std::uint64_t seed) {
    constexpr double mean_rays = 16, min_rays = 8;
    const double fewer = fewer_rays_in_crowd(stage, light.tree, light.numbering, light.reflected);
    const RayBudget rays{.average = fewer * mean_rays, .min = static_cast<unsigned>(fewer * min_rays), .max = 64};
    return {stage, {light.tree, light.numbering, coarse}, {rays, seed, Dealing::by_element, RowsHeld::by_owner}};
}

/// Returns the room of every leaf of the mesh of `light`; empty if the scene is one room.
std::vector<std::uint32_t> rooms_of_leaves(const Stage& stage, const GlobalLight& light) {
    if (stage.rooms.count() == 0) return {};
    std::vector<std::uint32_t> out(light.numbering.leaves.size());
    parallel_for(out.size(), 1024, [&](std::size_t i) {
        out[i] = static_cast<std::uint32_t>(stage.rooms.of(light.tree, light.numbering.leaves[i]));
    });
    return out;
}

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

CoarseResponse::CoarseResponse(const Stage& stage, const GlobalLight& light, const ElementLocator& coarse,
                               const CertificateOptions& options)
    : stage_(stage),
      light_(light),
      options_(options),
      mean_reflected_(light.mean_reflected(stage.area)),
      rho_(leaf_reflectances(stage.scene, light.tree, light.numbering)),
      area_(leaf_areas(light.tree, light.numbering)),
      room_of_(rooms_of_leaves(stage, light)),
      H_(rows_by_rays(stage, light, coarse, options.seed + 1)) {
    if (stage.rooms.count() > 0) other_H_.emplace(rows_by_rays(stage, light, coarse, hash(options.seed + 1)));
    share_on_node(std::span(rho_)), share_on_node(std::span(area_));
    if (mean_reflected_ <= 0) return;
    const std::vector<Spectrum> ones(rho_.size(), Spectrum(1.0));
    even_ = irradiance_of(ones, H_, rho_, area_);
    constant_ = error_constant(H_, rho_, area_, even_);
    if (!options.light_in.empty()) even_ = irradiance_of(light_of_rooms(), H_, rho_, area_);
}

/// Returns, for every leaf, the light of its room divided by the mean light.
std::vector<Spectrum> CoarseResponse::light_of_rooms() const {
    std::vector<Spectrum> out;
    for (std::size_t i = 0; i < rho_.size(); ++i) out.emplace_back(options_.light_in[room_of_leaf(i)]);
    return out;
}

std::vector<double> CoarseResponse::reflected_by_room() const {
    if (stage_.rooms.count() == 0) return {mean_reflected_};
    std::vector<double> out(stage_.rooms.count()), area(out.size());
    for (std::size_t i = 0; i < light_.reflected.size(); ++i) {
        const std::size_t room = room_of_leaf(i);
        out[room] += area_[i] * mean(light_.reflected[i]), area[room] += area_[i];
    }
    // Leaves at the borders of a room may be on either side, so that their area differs from the room's.
    for (std::size_t room = 0; room < out.size(); ++room)
        if (area[room] > 0) out[room] /= area[room];
    return out;
}

/// Returns the mean residual of each leaf. `first`: weight of the first of the two gathers of every sample.
std::vector<Spectrum> CoarseResponse::mean_residuals_of(std::span<const ResidualSample> samples, double first) const {
    // A region that extends over several rooms forms one group in each.
    const std::size_t regions = stage_.scene.regions().size(), rooms = std::max<std::size_t>(1, stage_.rooms.count());
    std::vector<LeafResidual> known;
    for (const ResidualSample& s : samples)
        known.push_back({s.leaf, static_cast<std::uint32_t>(s.room * regions + s.region.value),
                         s.weight * static_cast<double>(options_.points), first * s.r1 + (1 - first) * s.r2});
    std::vector<std::uint32_t> group_of_leaf;
    for (std::size_t i = 0; i < rho_.size(); ++i)
        group_of_leaf.push_back(static_cast<std::uint32_t>(room_of_leaf(i) * regions +
                                                           light_.tree.region(light_.numbering.leaves[i]).value));
    return mean_residuals(light_.tree, light_.numbering, group_of_leaf, regions * rooms, known);
}

/// Corrects the errors of B such that flux is conserved. If all emitted light is absorbed, and of the delivered light
/// the same amount, the error dE of irradiance satisfies int (1 - rho) dE dA = 0. The samples give a mean residual with
/// noise that the many reflections of a bright room may amplify beyond the error itself. The same residual is therefore
/// added everywhere such that the integral vanishes. With several rooms, it is proportional to the light of the room,
/// like the noise.
void CoarseResponse::balance(std::span<const Spectrum> residuals, std::span<Spectrum> errors) const {
    std::vector<Spectrum> arriving(rho_.size());
    H_.gather(errors, arriving);
    Spectrum wrong, by_even;
    for (std::size_t i = 0; i < rho_.size(); ++i)
        for (std::size_t band = 0; band < bands; ++band) {
            const double r = rho_[i][band], absorbed = area_[i] * (1 - r);
            wrong[band] += absorbed * (arriving[i][band] + (r > 0 ? residuals[i][band] / r : 0));
            by_even[band] += absorbed * even_[i][band];
        }
    for (std::size_t band = 0; band < bands; ++band) {
        if (!(by_even[band] > 0)) continue;
        const double more = wrong[band] / by_even[band];
        for (std::size_t i = 0; i < rho_.size(); ++i) errors[i][band] -= more * rho_[i][band] * even_[i][band];
    }
}

/// Returns the response to the mean residuals of the samples, minus these residuals. `first`: weight of the first of
/// the two gathers of every sample; 0.5: equal weights.
std::vector<Spectrum> CoarseResponse::response_to(std::span<const ResidualSample> samples, double first,
                                                  const RayRows& H) const {
    const std::vector<Spectrum> rhs = mean_residuals_of(samples, first);
    std::vector<Spectrum> response = respond({H, rho_, rhs, area_}, calibrated::refined_residual);
    // sums are free of noise, so they need no correction
    if (options_.keeps_flux && !options_.summed) balance(rhs, response);
    for (std::size_t i = 0; i < rhs.size(); ++i) response[i] -= rhs[i];
    return response;
}

std::vector<Spectrum> CoarseResponse::smooth_error(std::span<const ResidualSample> samples) const {
    // In a dark room, light from a brighter room must be distinguished from noise. If the scene is one room, the mean
    // is accurate enough.
    if (options_.summed || stage_.rooms.count() == 0) return response_to(samples, 0.5, H_);
    std::vector<Spectrum> one = response_to(samples, 1, H_);
    const std::vector<Spectrum> other = response_to(samples, 0, *other_H_);
    const std::size_t count = stage_.rooms.count();
    std::vector<double> agreed(count), all(count);
    for (std::size_t i = 0; i < one.size(); ++i) {
        agreed[room_of_[i]] += area_[i] * mean(one[i] * other[i]);
        one[i] = 0.5 * (one[i] + other[i]);
        all[room_of_[i]] += area_[i] * mean(one[i] * one[i]);
    }
    for (std::size_t i = 0; i < one.size(); ++i)
        one[i] *= all[room_of_[i]] > 0 ? std::sqrt(std::clamp(agreed[room_of_[i]] / all[room_of_[i]], 0.0, 1.0)) : 0.0;
    return one;
}

}  // namespace exitance
