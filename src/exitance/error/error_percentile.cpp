#include "exitance/error/error_percentile.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/error/area_samples.hpp"
#include "exitance/gather/gather.hpp"
#include "exitance/transport/open_points.hpp"

namespace exitance {
namespace {

struct Place {
    bool used = false;
    double level = 0, error = 0, noise = 0;  ///< W/m^2
};

Place look(const RadiosityFunction& light, const Locator& locator, const ProbePoint& point, unsigned rays,
           std::size_t number, PlaceLight::Workspace& visibility, GatherWorkspace& gathering) {
    const Scene& scene = light.solution().scene;
    const SurfaceId s = locator.find(point.x, point.n);
    if (s.is_none()) return {};
    const RegionId region = scene.surfaces()[s].region;
    if (!is_in_open(light.stage(), point.x, point.n, region)) return {};
    // Derived from the 99th percentile, which is several times the error: the noise of direct light is negligible in
    // it.
    constexpr LightAccuracy accuracy{.relative = 0.01};
    const Spectrum direct = light.stage().place_light.at(point.x, point.n, region, accuracy, visibility).irradiance;
    const Spectrum E = light.elements(region, point.x) + light.exact_share() * direct;
    // The mean of two gathers with half of the rays each is the reference; their difference is its noise.
    Spectrum half[2];
    for (std::uint64_t k = 0; k < 2; ++k)
        half[k] = light.gathered(point, region, rays / 2,
                                 hash(static_cast<std::uint64_t>(Stream::certificate), number, k), gathering);
    const Spectrum reference = direct + 0.5 * (half[0] + half[1]);
    return {true, mean(E), std::abs(mean(E) - mean(reference)), 0.5 * std::abs(mean(half[0]) - mean(half[1]))};
}

}  // namespace

ErrorPercentile find_error_percentile(const RadiosityFunction& light, std::size_t count, unsigned rays,
                                      Progress& progress, const StopRequest& stop) {
    progress.phase("check");
    const std::vector<ProbePoint> points = points_uniform_in_area(light.solution().scene, count, 1);
    const Locator locator(light.solution().scene);
    std::vector<Place> places(points.size());
    constexpr std::size_t at_once = 64;
    for (std::size_t first = 0; first < points.size() && !stop.requested(); first += at_once) {
        progress.advance(static_cast<double>(first) / static_cast<double>(points.size()));
        parallel_ranges(std::min(at_once, points.size() - first), 4, [&](std::size_t begin, std::size_t end) {
            PlaceLight::Workspace visibility;
            GatherWorkspace gathering;
            for (std::size_t i = first + begin; i < first + end && !stop.requested(); ++i)
                places[i] = look(light, locator, points[i], rays, i, visibility, gathering);
        });
    }
    std::erase_if(places, [](const Place& place) { return !place.used; });
    ErrorPercentile out;
    out.points = places.size();
    double level = 0, noise = 0;
    for (const Place& place : places) level += place.level, noise += place.noise * place.noise;
    if (!(level > 0)) return out;
    const auto n = static_cast<double>(places.size());
    level /= n;
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.error < b.error; });
    out.median = places[places.size() / 2].error / level;
    // Given by the definition of p99.
    out.p99 = places[std::min(places.size() - 1, static_cast<std::size_t>(0.99 * n))].error / level;
    out.noise = std::sqrt(noise / n) / level;
    return out;
}

}  // namespace exitance
