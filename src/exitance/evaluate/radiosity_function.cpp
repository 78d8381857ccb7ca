#include "exitance/evaluate/radiosity_function.hpp"

#include "exitance/base/parallel.hpp"
#include "exitance/gather/gather.hpp"

namespace exitance {
namespace {

constexpr unsigned free_space_rays = 4096;
constexpr std::size_t points_a_task = 32;

Light light_on(const Material& material, const Spectrum& irradiance) {
    return {irradiance, material.exitance + material.reflectance * irradiance, true};
}

}  // namespace

RadiosityFunction::RadiosityFunction(const Solution& solution)
    : solution_(solution),
      places_(solution.scene),
      indirect_locator_(solution.indirect.tree, solution.scene.regions().size()),
      interpolant_locator_(solution.interpolant.tree, solution.scene.regions().size()),
      triangles_(solution.discontinuity, solution.scene),
      stage_(std::make_unique<Stage>(solution.scene)),
      accuracy_(point_accuracy(solution.statistics.relative_error_estimate.value_or(1))) {}

RadiosityFunction::~RadiosityFunction() = default;

Spectrum RadiosityFunction::gathered(const ProbePoint& point, RegionId own, unsigned rays, std::uint64_t key,
                                     GatherWorkspace& workspace) const {
    if (solution_.bounces == 0) return Spectrum();
    const RadiosityAt reflected = [&](RegionId region, const Point& y) {
        return solution_.scene.material(region).reflectance *
               solution_.interpolant.at(interpolant_locator_.find(region, y));
    };
    return gather_reflected(*stage_, point.x, point.n, own, rays, key, reflected, workspace).irradiance;
}

Spectrum RadiosityFunction::irradiance_on(RegionId region, const Point& x, Component component,
                                          ClusteredLight::Workspace& workspace) const {
    // The elements hold E_ind + c E_dir. The factor of exact direct light is 1 - c for the total, 1 for direct and -c
    // for indirect light.
    Spectrum weight = exact_share();
    if (!solution_.direct_in_elements && component == Component::direct) weight = Spectrum(1);
    if (!solution_.direct_in_elements && component == Component::indirect) weight -= Spectrum(1);
    Spectrum irradiance;
    if (squared(weight) > 0)
        irradiance +=
            weight *
            stage_->clustered.at(x, solution_.scene.regions()[region].plane.n, region, accuracy_, workspace).irradiance;
    if (component != Component::direct) irradiance += elements(region, x);
    return irradiance;
}

std::vector<Light> RadiosityFunction::at(std::span<const ProbePoint> points, Component component) const {
    std::vector<Light> out(points.size());
    evaluate(points, 0, component, out);
    return out;
}

std::vector<Light> RadiosityFunction::at_until(const StopRequest& stop, std::span<const ProbePoint> points,
                                               Component component) const {
    constexpr double step_seconds = 0.5;
    const std::size_t least = points_a_task * static_cast<std::size_t>(threads());
    std::vector<Light> out;
    for (std::size_t step = least; out.size() < points.size() && !stop.requested();) {
        const Stopwatch watch;
        const std::size_t first = out.size();
        out.resize(std::min(points.size(), first + step));
        evaluate(points, first, component, std::span(out).subspan(first));
        if (2 * watch.seconds() < step_seconds)
            step *= 2;
        else if (watch.seconds() > 2 * step_seconds)
            step = std::max(least, step / 2);
    }
    return out;
}

void RadiosityFunction::evaluate(std::span<const ProbePoint> points, std::size_t first, Component component,
                                 std::span<Light> results) const {
    parallel_ranges(results.size(), points_a_task, [&](std::size_t begin, std::size_t end) {
        ClusteredLight::Workspace workspace;
        GatherWorkspace gathering;
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t i = first + k;
            Light& out = results[k];
            const Normal& n = points[i].n;
            const auto& [x, surface, region, is_between_sides] = places_.find(points[i].x, n);
            if (!surface.is_none()) {
                const bool is_covered = stage_->occluders.is_covered(x, n, region);
                out = light_on(solution_.scene.material(surface),
                               is_covered ? Spectrum() : irradiance_on(region, x, component, workspace));
                out.is_between_sides = is_between_sides;
                continue;
            }
            out.is_between_sides = is_between_sides;
            if (component != Component::indirect)
                out.irradiance += stage_->clustered.at(x, n, region, accuracy_, workspace).irradiance;
            const std::uint64_t key = hash(static_cast<std::uint64_t>(Stream::gather), i);
            if (component != Component::direct)
                out.irradiance += gathered({x, n}, RegionId(), free_space_rays, key, gathering);
        }
    });
}

Spectrum RadiosityFunction::interpolated(RegionId region, const Point& x) const {
    if (solution_.layers) return exact_share() * solution_.layers->at(solution_.scene, region, x) + elements(region, x);
    if (!solution_.discontinuity.empty()) return triangles_.at(region, x);
    return solution_.interpolant.at(interpolant_locator_.find(region, x));
}

std::vector<Light> RadiosityFunction::interpolant_at(std::span<const ProbePoint> points) const {
    std::vector<Light> out(points.size());
    parallel_for(points.size(), 256, [&](std::size_t i) {
        const MeasuredPlace place = places_.find(points[i].x, points[i].n);
        if (!place.surface.is_none())
            out[i] = light_on(solution_.scene.material(place.surface), interpolated(place.region, place.x));
        out[i].is_between_sides = place.is_between_sides;
    });
    return out;
}

}  // namespace exitance
