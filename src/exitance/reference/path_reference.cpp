#include "exitance/reference/path_reference.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/gather/path_tracer.hpp"

namespace exitance {
namespace {

/// Adds direct light and its noise to a reference.
void add_direct(const PlaceLight::Estimate& direct, ReferenceLight& out) {
    out.irradiance += direct.irradiance;
    const Spectrum error = direct.standard_error();
    for (std::size_t b = 0; b < bands; ++b) out.standard_error[b] = std::hypot(out.standard_error[b], error[b]);
}

}  // namespace

std::vector<ReferenceLight> reference_light(const Scene& scene, std::span<const ProbePoint> points, std::size_t paths,
                                            std::uint64_t seed, Progress& progress, const StopRequest& stop) {
    constexpr std::size_t randomisations = 16, chunk = 64;
    const Stage stage(scene);
    const PathTracer tracer(stage);
    const PlaceFinder places(scene);
    const std::uint32_t each = static_cast<std::uint32_t>((paths + randomisations - 1) / randomisations);
    std::vector<ReferenceLight> out(points.size());
    std::vector<std::uint8_t> is_finished(points.size());
    progress.phase("paths");
    progress.advance(0);
    for (std::size_t first = 0; first < points.size() && !stop.requested(); first += chunk) {
        const std::size_t count = std::min(chunk, points.size() - first);
        parallel_for(count, 1, [&](std::size_t local) {
            const std::size_t i = first + local;
            const Normal& n = points[i].n;
            const MeasuredPlace place = places.find(points[i].x, n);
            const auto& [x, surface, region, is_between_sides] = place;
            out[i].surface = surface, out[i].is_between_sides = is_between_sides;
            is_finished[i] = !surface.is_none() && stage.occluders.is_covered(x, n, region);
            if (is_finished[i]) return;
            std::array<Spectrum, randomisations> batch{};
            for (std::size_t k = 0; k < randomisations; ++k) {
                const ScrambledSobol first_directions(hash(seed, static_cast<std::uint64_t>(Stream::reference), i, k));
                RandomStream random(seed, Stream::reference, i, k);
                for (std::uint32_t p = 0; p < each; ++p) {
                    if (p % 1024 == 0 && stop.requested()) return;
                    batch[k] += tracer.path({x, n, region}, first_directions(p, 0), first_directions(p, 1), random);
                }
                batch[k] *= 1.0 / each;
                out[i].irradiance += batch[k] / randomisations;
            }
            Spectrum square;
            for (const Spectrum& value : batch) square += (value - out[i].irradiance) * (value - out[i].irradiance);
            for (std::size_t b = 0; b < bands; ++b)
                out[i].standard_error[b] = std::sqrt(square[b] / (randomisations * (randomisations - 1.0)));
            PlaceLight::Workspace workspace;
            add_direct(stage.place_light.at(x, n, region, {.relative = RayLight::error_of(1.0 * paths)}, workspace),
                       out[i]);
            is_finished[i] = 1;
        });
        progress.advance(static_cast<double>(first + count) / static_cast<double>(points.size()));
    }
    out.resize(static_cast<std::size_t>(std::find(is_finished.begin(), is_finished.end(), 0) - is_finished.begin()));
    return out;
}

}  // namespace exitance
