#include "exitance/error/late_paths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "exitance/processes/distributed.hpp"

namespace exitance {

namespace {

constexpr unsigned rays_at_vertex = 16;  ///< Rays of the gather at a vertex of a path.

}  // namespace

LatePaths::LatePaths(const Stage& stage, const ElementFunction& indirect, const ReflectedLight& b,
                     const DirectCheck& check, std::span<const CheckPlan> plans, bool holds_direct,
                     const StopRequest* stop)
    : stage_(stage),
      indirect_(indirect),
      b_(b),
      check_(check),
      plans_(plans),
      holds_direct_(holds_direct),
      stop_(stop),
      locator_(indirect.tree, stage.scene.regions().size()) {}

/// Returns one sample of the residual of irradiance at a vertex.
Spectrum LatePaths::residual(const SurfacePoint& y, RandomStream& random, Workspace& w, std::size_t& rays) const {
    const CheckPlan& plan = plans_[stage_.rooms.count() > 0 ? stage_.rooms.at(y.region, y.x) : 0];
    const std::uint64_t key = random.bits();
    cast_gather(stage_, y.x, y.n, y.region, rays_at_vertex, key, b_.bright_places(), w.rays);
    Spectrum found = read_gather(b_, w.rays).irradiance + check_.missing(plan, w.rays, key, w.check) -
                     indirect_.at(locator_.find(y.region, y.x));
    rays += rays_at_vertex + static_cast<std::size_t>(plan.work * rays_at_vertex);
    if (!holds_direct_) return found;
    rays += static_cast<std::size_t>(check_.paths().rays_per_step());
    return found + check_.paths().step(y, random).direct;
}

Spectrum LatePaths::sample(const SurfacePoint& x, double a, double b, RandomStream& random, Workspace& w,
                           std::size_t& rays) const {
    Spectrum sum, throughput(1.0);
    std::optional<PathTracer::Vertex> y = check_.paths().first(x, a, b);
    ++rays;
    while (y) {
        const Spectrum& rho = stage_.scene.material(y->at.region).reflectance;
        const double survival = max(rho);
        if (survival <= 0 || random.uniform() >= survival) return sum;
        throughput *= rho / survival * y->colour;
        sum += throughput * residual(y->at, random, w, rays);
        const double u = random.uniform(), v = random.uniform();
        y = check_.paths().first(y->at, u, v);
        ++rays;
    }
    return sum;
}

/// Returns the expected number of rays of a path. In a bright room, a path has as many vertices as light has
/// reflections.
double LatePaths::rays_per_path() const {
    double work = 0;
    for (const CheckPlan& plan : plans_) work = std::max(work, plan.work);
    return 1 + std::max(2.0, stage_.expected_reflections()) * (1 + rays_at_vertex * (1 + work));
}

LateMisfit LatePaths::misfit(std::span<const ResidualSample> samples, std::span<const Spectrum> late,
                             std::uint64_t seed, std::size_t max_rays) const {
    constexpr double max_places = 128;
    constexpr double min_paths = 2, max_paths = 16, more_again = 4;
    const double places = std::min(max_places, static_cast<double>(samples.size()));
    const double affordable = static_cast<double>(max_rays) / (2 * rays_per_path() * places);
    const double paths = std::clamp(affordable, min_paths, max_paths);
    const LateMisfit first = measure(samples, late, seed, static_cast<std::uint32_t>(paths));
    if (!first.is_significant()) return first;
    LateMisfit again = measure(samples, late, hash(seed), static_cast<std::uint32_t>(more_again * paths));
    again.rays += first.rays;
    return again;
}

LateMisfit LatePaths::measure(std::span<const ResidualSample> samples, std::span<const Spectrum> late,
                              std::uint64_t seed, std::uint32_t paths) const {
    constexpr std::size_t max_places = 128;
    const std::size_t step = (samples.size() + max_places - 1) / max_places,
                      count = samples.size() / std::max<std::size_t>(1, step);
    if (count < 2) return {};
    const std::size_t offset = seed % std::max<std::size_t>(1, step);
    struct Found {
        double weight = 0, product = 0;
        std::size_t rays = 0;
    };
    std::vector<Found> found(count);
    shared_ranges(
        count, 1,
        [&](std::size_t begin, std::size_t end) {
            Workspace w;
            for (std::size_t k = begin; k < end; ++k) {
                const ResidualSample& s = samples[k * step + offset];
                found[k].weight = s.weight;
                if (s.is_covered || is_stopped()) continue;
                const Normal& n = stage_.scene.regions()[s.region].plane.n;
                const SurfacePoint x{indirect_.tree.patch(s.place.element).at(s.place.uv), n, s.region};
                std::array<Spectrum, 2> half;
                for (std::uint64_t which = 0; which < 2; ++which) {
                    RandomStream random(seed, Stream::certificate, k, 2 + which);
                    const ScrambledSobol first(random.key());
                    for (std::uint32_t p = 0; p < paths; ++p)
                        half[which] += sample(x, first(p, 0), first(p, 1), random, w, found[k].rays) / paths;
                    half[which] = stage_.scene.material(s.region).reflectance * half[which] - late[s.leaf];
                }
                found[k].product = mean(half[0] * half[1]);
            }
        },
        [&](std::size_t k) -> Found& { return found[k]; }, {"certificate"});
    if (is_stopped()) return {};
    LateMisfit out;
    double weight = 0, spread = 0;
    for (const Found& f : found) weight += f.weight, out.mean_square += f.weight * f.product, out.rays += f.rays;
    if (weight <= 0) return {};
    out.mean_square /= weight;
    for (const Found& f : found) spread += std::pow(f.weight * (f.product - out.mean_square), 2);
    out.standard_error = std::sqrt(spread) / weight;
    return out;
}

std::vector<CorrelationTerm> LatePaths::correlation(std::span<const ResidualSample> samples,
                                                    std::span<const double> weight_of_place,
                                                    std::span<const Spectrum> late, std::uint64_t seed,
                                                    std::size_t max_rays, std::size_t& rays) const {
    // The noise of a path is assumed to be proportional to the light delivered at the place.
    std::vector<double> running(samples.size());
    double total = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const ResidualSample& s = samples[k];
        const Spectrum& rho = stage_.scene.material(s.region).reflectance;
        if (!s.is_covered)
            total +=
                weight_of_place[k] * rms_over_bands(s.r1 + s.r2 + 2 * late[s.leaf]) * rms_over_bands(rho * s.delivered);
        running[k] = total;
    }
    const auto count = static_cast<std::size_t>(static_cast<double>(max_rays) / rays_per_path());
    if (!(total > 0) || count == 0) return {};
    struct Found {
        CorrelationTerm term;
        std::size_t rays = 0;
    };
    std::vector<Found> found(count);
    const double each = total / static_cast<double>(count);
    const double offset = RandomStream(seed, Stream::certificate).uniform();
    shared_ranges(
        count, 16,
        [&](std::size_t begin, std::size_t end) {
            Workspace w;
            for (std::size_t j = begin; j < end; ++j) {
                const double at = (static_cast<double>(j) + offset) * each;
                const auto k = std::min<std::size_t>(
                    static_cast<std::size_t>(std::upper_bound(running.begin(), running.end(), at) - running.begin()),
                    samples.size() - 1);
                const ResidualSample& s = samples[k];
                const double share = running[k] - (k > 0 ? running[k - 1] : 0);
                if (!(share > 0) || is_stopped()) continue;
                const Normal& n = stage_.scene.regions()[s.region].plane.n;
                const SurfacePoint x{indirect_.tree.patch(s.place.element).at(s.place.uv), n, s.region};
                RandomStream random(seed, Stream::certificate, j, 4);
                const ScrambledSobol first(hash(seed, k));
                const auto p = static_cast<std::uint32_t>(j);
                const Spectrum beyond = stage_.scene.material(s.region).reflectance *
                                            sample(x, first(p, 0), first(p, 1), random, w, found[j].rays) -
                                        late[s.leaf];
                const Spectrum error = s.r1 + s.r2 + 2 * late[s.leaf];
                found[j].term = {static_cast<std::uint32_t>(k), s.weight * each / share * mean(error * beyond)};
            }
        },
        [&](std::size_t j) -> Found& { return found[j]; }, {"certificate"});
    std::vector<CorrelationTerm> out;
    if (is_stopped()) return out;
    for (const Found& f : found) out.push_back(f.term), rays += f.rays;
    return out;
}

}  // namespace exitance
