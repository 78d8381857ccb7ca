#include "exitance/error/late_paths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "exitance/processes/distributed.hpp"

namespace exitance {

LatePaths::LatePaths(const Stage& stage, const ElementFunction& indirect, const ReflectedLight& b,
                     const DirectCheck& check, bool holds_direct)
    : stage_(stage),
      indirect_(indirect),
      b_(b),
      check_(check),
      holds_direct_(holds_direct),
      locator_(indirect.tree, stage.scene.regions().size()) {}

Spectrum LatePaths::read(const ReflectedLight& light, const SurfacePoint& y) const {
    const RayEnd at{y.x, y.region};
    Spectrum value;
    light.read(std::span(&at, 1), std::span(&value, 1));
    return value;
}

Spectrum LatePaths::sample(const SurfacePoint& x, double a, double b, RandomStream& random, std::size_t& rays) const {
    const PathTracer& paths = check_.paths();
    const auto per_step = static_cast<std::size_t>(paths.rays_per_step());
    Spectrum sum, throughput(1.0);
    const std::optional<PathTracer::Vertex> first = paths.first(x, a, b);
    ++rays;
    if (!first) return sum;
    SurfacePoint y = first->at;
    throughput *= first->colour;
    PathTracer::Step at_y = paths.step(y, random);
    rays += per_step;
    while (true) {
        const Spectrum& rho = stage_.scene.material(y.region).reflectance;
        const double survival = max(rho);
        if (survival <= 0 || random.uniform() >= survival) return sum;
        throughput *= rho / survival;
        Spectrum found = Spectrum() - indirect_.at(locator_.find(y.region, y.x));
        if (holds_direct_) found += at_y.direct;
        const std::optional<PathTracer::Vertex> next = at_y.next;
        if (!next) return sum + throughput * found;
        const SurfacePoint& z = next->at;
        at_y = paths.step(z, random);
        rays += per_step;
        found += next->colour * read(b_, z);
        if (check_.has_projection()) {
            const ProjectedDirect& projected = check_.projected();
            found += next->colour * stage_.scene.material(z.region).reflectance * projected.weight *
                     (at_y.direct - read(*projected.irradiance, z));
        }
        sum += throughput * found;
        throughput *= next->colour;
        y = z;
    }
}

LateMisfit LatePaths::misfit(std::span<const ResidualSample> samples, std::span<const Spectrum> late,
                             std::uint64_t seed, std::size_t max_rays) const {
    constexpr double max_places = 128;
    constexpr std::uint32_t min_paths = 4, max_paths = 64, paths_again = 4 * max_paths;
    const double places = std::min(max_places, static_cast<double>(samples.size()));
    const double rays_per_path =
        1 + 2 * check_.paths().rays_per_step();  // a path with two vertices, since most paths are short
    const auto paths = static_cast<std::uint32_t>(
        std::clamp(static_cast<double>(max_rays) / (2 * rays_per_path * places), 1.0 * min_paths, 1.0 * max_paths));
    const LateMisfit first = measure(samples, late, seed, paths);
    if (!first.is_significant()) return first;
    LateMisfit again = measure(samples, late, hash(seed), paths_again);
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
            for (std::size_t k = begin; k < end; ++k) {
                const ResidualSample& s = samples[k * step + offset];
                found[k].weight = s.weight;
                if (s.is_covered) continue;
                const Normal& n = stage_.scene.regions()[s.region].plane.n;
                const SurfacePoint x{indirect_.tree.patch(s.place.element).at(s.place.uv), n, s.region};
                std::array<Spectrum, 2> half;
                for (std::uint64_t which = 0; which < 2; ++which) {
                    RandomStream random(seed, Stream::certificate, k, 2 + which);
                    const ScrambledSobol first(random.key());
                    for (std::uint32_t p = 0; p < paths; ++p)
                        half[which] += sample(x, first(p, 0), first(p, 1), random, found[k].rays) / paths;
                    half[which] = stage_.scene.material(s.region).reflectance * half[which] - late[s.leaf];
                }
                found[k].product = mean(half[0] * half[1]);
            }
        },
        [&](std::size_t k) -> Found& { return found[k]; }, {"certificate"});
    LateMisfit out;
    double weight = 0, spread = 0;
    for (const Found& f : found) weight += f.weight, out.mean_square += f.weight * f.product, out.rays += f.rays;
    if (weight <= 0) return {};
    out.mean_square /= weight;
    for (const Found& f : found) spread += std::pow(f.weight * (f.product - out.mean_square), 2);
    out.standard_error = std::sqrt(spread) / weight;
    return out;
}

}  // namespace exitance
