#include "exitance/reference/path_reference.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/gather/path_tracer.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

/// Adds direct light and its noise to a reference.
void add_direct(const PlaceLight::Estimate& direct, ReferenceLight& out) {
    out.irradiance += direct.irradiance;
    const Spectrum error = direct.standard_error();
    for (std::size_t b = 0; b < bands; ++b) out.standard_error[b] = std::hypot(out.standard_error[b], error[b]);
}

constexpr std::size_t randomisations = 16;

/// Estimates the light at single points, as described at reference_light.
class PointEstimator {
  public:
    PointEstimator(const Scene& scene, std::size_t paths, std::uint64_t seed, const StopRequest& stop)
        : stage_(scene),
          tracer_(stage_),
          places_(scene),
          paths_(paths),
          each_(static_cast<std::uint32_t>((paths + randomisations - 1) / randomisations)),
          seed_(seed),
          stop_(stop) {}

    /// Estimates the light at point number `i`. Returns false if a stop was requested meanwhile.
    bool estimate(std::size_t i, const ProbePoint& point, ReferenceLight& out) const {
        const Normal& n = point.n;
        const MeasuredPlace place = places_.find(point.x, n);
        const auto& [x, surface, region, is_between_sides] = place;
        out.surface = surface, out.is_between_sides = is_between_sides;
        if (!surface.is_none() && stage_.occluders.is_covered(x, n, region)) return true;
        std::array<Spectrum, randomisations> batch{};
        for (std::size_t k = 0; k < randomisations; ++k) {
            const ScrambledSobol first_directions(hash(seed_, static_cast<std::uint64_t>(Stream::reference), i, k));
            RandomStream random(seed_, Stream::reference, i, k);
            for (std::uint32_t p = 0; p < each_; ++p) {
                if (p % 1024 == 0 && stops_within_loop(stop_)) return false;
                batch[k] += tracer_.path({x, n, region}, first_directions(p, 0), first_directions(p, 1), random);
            }
            batch[k] *= 1.0 / each_;
            out.irradiance += batch[k] / randomisations;
        }
        Spectrum square;
        for (const Spectrum& value : batch) square += (value - out.irradiance) * (value - out.irradiance);
        for (std::size_t b = 0; b < bands; ++b)
            out.standard_error[b] = std::sqrt(square[b] / (randomisations * (randomisations - 1.0)));
        PlaceLight::Workspace workspace;
        add_direct(stage_.place_light.at(x, n, region, {.relative = RayLight::error_of(1.0 * paths_)}, workspace), out);
        return true;
    }

  private:
    const Stage stage_;
    const PathTracer tracer_;
    const PlaceFinder places_;
    std::size_t paths_;
    std::uint32_t each_;  ///< Paths of a randomisation.
    std::uint64_t seed_;
    const StopRequest& stop_;
};

}  // namespace

std::vector<ReferenceLight> reference_light(const Scene& scene, std::span<const ProbePoint> points, std::size_t paths,
                                            std::uint64_t seed, Progress& progress, const StopRequest& stop) {
    constexpr std::size_t points_a_process = 64;
    const std::size_t chunk = points_a_process * processes();
    const PointEstimator estimator(scene, paths, seed, stop);
    std::vector<ReferenceLight> out(points.size());
    std::vector<std::uint8_t> is_finished(points.size());
    progress.phase("paths");
    progress.advance(0);
    for (std::size_t first = 0; first < points.size() && !stop.requested(); first += chunk) {
        const std::size_t count = std::min(chunk, points.size() - first);
        shared_ranges(
            count, 1,
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = first + begin; i < first + end; ++i)
                    is_finished[i] = estimator.estimate(i, points[i], out[i]);
            },
            [&](std::size_t k) -> ReferenceLight& { return out[first + k]; }, {"paths"});
        exchange_values(
            count, 1, [&](std::size_t k) -> std::uint8_t& { return is_finished[first + k]; }, "paths");
        progress.advance(static_cast<double>(first + count) / static_cast<double>(points.size()));
    }
    out.resize(static_cast<std::size_t>(std::find(is_finished.begin(), is_finished.end(), 0) - is_finished.begin()));
    return out;
}

}  // namespace exitance
