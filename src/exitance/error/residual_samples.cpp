#include "exitance/error/residual_samples.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/transport/open_points.hpp"

namespace exitance {
namespace {

/// Returns the face of a region that contains the point x of the region.
SurfaceId surface_at(const Scene& scene, RegionId region, const Point& x) {
    const auto& surfaces = scene.regions()[region].surfaces;
    if (surfaces.size() > 1)
        for (SurfaceId s : surfaces)
            if (contains(scene.outline(s), scene.surfaces()[s].normal, x)) return s;
    return surfaces[0];
}

/// If light is summed, one of this many samples measures the parts of the residual, since that takes another sum.
constexpr std::size_t samples_per_local_sum = 4;

/// Returns the factor on the number of rays. If light is reflected often, a small mean of the residual causes a large
/// error and must be distinguished from noise. The number of rays grows with the power 4/3, as the noise of a mean
/// square requires.
double factor_for_many_reflections(double constant) {
    // given by the power 4/3 above
    return std::clamp(std::pow(constant / 4, 4.0 / 3), 1.0, calibrated::max_ray_factor);
}

}  // namespace

double rays_to_resolve(double error, std::size_t points) {
    return calibrated::certificate_noise / (error * error * std::sqrt(static_cast<double>(points)));
}

unsigned certificate_rays(double wanted) {
    const double most = calibrated::max_certificate_rays;
    return std::bit_ceil(static_cast<unsigned>(std::clamp(wanted, calibrated::min_rays_per_sample, most)));
}

ResidualSampler::ResidualSampler(const Stage& stage, const Delivered& light, const DirectCheck& check,
                                 const CertificateOptions& options, double constant, const NumberedLeaves& coarse)
    : stage_(stage),
      light_(light),
      check_(check),
      options_(options),
      ray_factor_(factor_for_many_reflections(constant)),
      coarse_(coarse) {}

unsigned ResidualSampler::rays_at(ElementId leaf) const {
    if (options_.leaves)
        return certificate_rays(calibrated::certificate_ray_share *
                                LocalPassReport::known(*options_.leaves, light_.indirect.tree, leaf).rays);
    return certificate_rays(ray_factor_ * rays_to_resolve(options_.error, options_.points));
}

Point ResidualSampler::point(const ResidualSample& sample) const {
    return light_.indirect.tree.patch(sample.place.element).at(sample.place.uv);
}

void ResidualSampler::locate(const WeightedSample& at, ResidualSample& sample, Workspace& w) const {
    sample.place = at.place, sample.weight = at.weight;
    const RegionId region = sample.region = light_.indirect.tree.region(at.place.element);
    const Point x = point(sample);
    const Normal& n = stage_.scene.regions()[region].plane.n;
    sample.is_covered = !is_in_open(stage_, x, n, region);
    if (!sample.is_covered) sample.delivered = light_.indirect.at(at.place);
    if (!sample.is_covered && options_.direct_in_elements)
        sample.delivered -= stage_.place_light.at(x, n, region, point_accuracy(options_.error), w.clustered).irradiance;
    sample.reflected = 0;
    if (!sample.is_covered) {
        Spectrum E = light_.indirect.at(at.place);
        if (check_.has_projection()) {
            const RayEnd here{x, region};
            Spectrum projected;
            check_.projected().irradiance->read(std::span(&here, 1), std::span(&projected, 1));
            E += check_.projected().weight * projected;
        }
        sample.reflected = mean(stage_.scene.material(region).reflectance * E);
    }
    sample.surface = surface_at(stage_.scene, region, x);
    if (stage_.rooms.count() > 0) sample.room = static_cast<std::uint32_t>(stage_.rooms.at(region, x));
    sample.leaf = coarse_.numbering.number[coarse_.locator.find(region, x).element];
}

/// Measures the residual by sums over elements. Two gathers of independent rays correct the projected direct light in
/// them.
void ResidualSampler::sum_elements(std::uint64_t seed, std::size_t k, const CheckPlan& plan, ResidualSample& sample,
                                   Workspace& w) const {
    const Point x = point(sample);
    const Normal& n = stage_.scene.regions()[sample.region].plane.n;
    const Spectrum& reflectance = stage_.scene.material(sample.region).reflectance;
    const auto residual = [&](std::span<const ElementGather> parts) {
        Spectrum arriving;
        for (const ElementGather& part : parts)
            if (!sample.is_covered) arriving += part(x, n, sample.region, options_.summed->share, w.sums);
        return reflectance * (arriving - sample.delivered);
    };
    sample.r1 = sample.r2 = residual(options_.summed->delivered);
    if (!options_.summed->gathered.empty() && k % samples_per_local_sum == 0) {
        sample.local1 = sample.local2 = residual(options_.summed->gathered);
        sample.is_divided = true;
    }
    if (sample.is_covered || !check_.has_projection()) return;
    for (std::uint64_t which = 1; which <= 2; ++which) {
        const std::uint64_t key = hash(seed, static_cast<std::uint64_t>(Stream::certificate), k, which);
        cast_gather(stage_, x, n, sample.region, rays_beside_sums, key, light_.b.bright_places(), w.rays);
        (which == 1 ? sample.r1 : sample.r2) += reflectance * check_.missing(plan, w.rays, key, w.check);
    }
    sample.rays = 2 * rays_beside_sums;
}

/// Measures the residual by two gathers of independent rays.
void ResidualSampler::cast_rays(std::uint64_t seed, std::size_t k, const CheckPlan& plan, ResidualSample& sample,
                                Workspace& w) const {
    const Spectrum& reflectance = stage_.scene.material(sample.region).reflectance;
    const unsigned rays = rays_at(sample.place.element);
    sample.is_divided = options_.gathered != nullptr;
    if (sample.is_covered) return;
    for (std::uint64_t which = 1; which <= 2; ++which) {
        const std::uint64_t key = hash(seed, static_cast<std::uint64_t>(Stream::certificate), k, which);
        (which == 1 ? sample.r1 : sample.r2) = by_rays(sample, plan, rays, key, w);
        if (options_.gathered)
            (which == 1 ? sample.local1 : sample.local2) =
                reflectance * (read_gather(*options_.gathered, w.rays).irradiance - sample.delivered);
    }
    sample.rays = 2 * rays;
}

bool ResidualSampler::measure(std::span<const WeightedSample> places, std::span<const CheckPlan> plans,
                              std::uint64_t seed, std::span<ResidualSample> samples, const StopRequest* stop,
                              PhasePart part) const {
    constexpr std::size_t grain = 8;
    LoopProgress progress(std::move(part), own_count(places.size(), grain));
    shared_ranges(
        places.size(), grain,
        [&](std::size_t begin, std::size_t end) {
            Workspace w;
            for (std::size_t k = begin; k < end && !(stop && stop->requested()); ++k) {
                locate(places[k], samples[k], w);
                samples[k].is_measured = true;
                const CheckPlan& plan = plans[samples[k].room];
                if (options_.summed)
                    sum_elements(seed, k, plan, samples[k], w);
                else
                    cast_rays(seed, k, plan, samples[k], w);
                progress.add_one();
            }
        },
        [&](std::size_t k) -> ResidualSample& { return samples[k]; }, {"certificate"});
    return std::all_of(samples.begin(), samples.end(), [](const ResidualSample& s) { return s.is_measured; });
}

Spectrum ResidualSampler::by_rays(const ResidualSample& sample, const CheckPlan& plan, unsigned rays, std::uint64_t key,
                                  Workspace& w) const {
    if (sample.is_covered) return {};
    const Region& region = stage_.scene.regions()[sample.region];
    cast_gather(stage_, point(sample), region.plane.n, sample.region, rays, key, light_.b.bright_places(), w.rays);
    const Spectrum arriving = read_gather(light_.b, w.rays).irradiance + check_.missing(plan, w.rays, key, w.check);
    return stage_.scene.material(sample.region).reflectance * (arriving - sample.delivered);
}

}  // namespace exitance
