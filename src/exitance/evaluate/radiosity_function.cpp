#include "exitance/evaluate/radiosity_function.hpp"

#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/gather/gather.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

constexpr unsigned free_space_rays = 4096;
constexpr std::size_t points_a_task = 32;

/// Mean irradiance of a solution over its surfaces, mean over bands, W/m^2.
double mean_irradiance(const ElementFunction& E) {
    double sum = 0, area = 0;
    for (const ElementId e : E.tree.leaves()) {
        sum += E.tree.area(e) * mean(E.at({e, E.tree.centre(e)}));
        area += E.tree.area(e);
    }
    return area > 0 ? sum / area : 0;
}

/// Accuracy of direct light at points: half of it relative to the light there, half to the mean light, to which the
/// solution's error is relative.
LightAccuracy accuracy_of(const Solution& solution) {
    LightAccuracy out = point_accuracy(solution.statistics.relative_error_estimate.value_or(1));
    const double level = mean_irradiance(solution.interpolant);
    if (!(level > 0)) return out;
    out.relative *= 0.5, out.absolute = out.relative * level;
    return out;
}

Light light_on(const Material& material, const Spectrum& irradiance) {
    return {.irradiance = irradiance,
            .radiosity = material.exitance + material.reflectance * irradiance,
            .standard_error = {},
            .on_surface = true};
}

}  // namespace

RadiosityFunction::RadiosityFunction(const Solution& solution, DirectBy direct)
    : solution_(solution),
      places_(solution.scene),
      indirect_locator_(solution.indirect.tree, solution.scene.regions().size()),
      interpolant_locator_(solution.interpolant.tree, solution.scene.regions().size()),
      triangles_(solution.discontinuity, solution.scene),
      stage_(std::make_unique<Stage>(solution.scene)),
      accuracy_(direct == DirectBy::closed_forms ? LightAccuracy() : accuracy_of(solution)) {}

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

Spectrum RadiosityFunction::direct_at(const ProbePoint& point, RegionId own, PlaceLight::Workspace& workspace) const {
    return stage_->place_light.at(point.x, point.n, own, accuracy_, workspace).irradiance;
}

Light RadiosityFunction::light_on(RegionId region, const Material& material, const Point& x, Component component,
                                  PlaceLight::Workspace& workspace) const {
    // The elements hold E_ind + c E_dir. The factor of exact direct light is 1 - c for the total, 1 for direct and -c
    // for indirect light.
    Spectrum weight = exact_share();
    if (!solution_.direct_in_elements && component == Component::direct) weight = Spectrum(1);
    if (!solution_.direct_in_elements && component == Component::indirect) weight -= Spectrum(1);
    PlaceLight::Estimate direct;
    if (squared(weight) > 0)
        direct = stage_->place_light.at(x, solution_.scene.regions()[region].plane.n, region, accuracy_, workspace);
    Spectrum irradiance = weight * direct.irradiance;
    if (component != Component::direct) irradiance += elements(region, x);
    Light out = exitance::light_on(material, irradiance);
    out.standard_error = direct.standard_error();
    for (std::size_t b = 0; b < bands; ++b) out.standard_error[b] *= std::abs(weight[b]);
    return out;
}

std::vector<Light> RadiosityFunction::at(std::span<const ProbePoint> points, Component component) const {
    std::vector<Light> out(points.size());
    parallel_ranges(out.size(), points_a_task, [&](std::size_t begin, std::size_t end) {
        evaluate(points, begin, component, std::span(out).subspan(begin, end - begin));
    });
    return out;
}

std::vector<Light> RadiosityFunction::at_until(const StopRequest& stop, std::span<const ProbePoint> points,
                                               Component component) const {
    constexpr double step_seconds = 0.5;
    const std::size_t least = points_a_task * processes() * static_cast<std::size_t>(as_first(threads()));
    std::vector<Light> out;
    for (std::size_t step = least; out.size() < points.size() && !stop.requested();) {
        const Stopwatch watch;
        const std::size_t first = out.size();
        out.resize(std::min(points.size(), first + step));
        shared_ranges(
            out.size() - first, points_a_task,
            [&](std::size_t begin, std::size_t end) {
                evaluate(points, first + begin, component, std::span(out).subspan(first + begin, end - begin));
            },
            [&](std::size_t i) -> Light& { return out[first + i]; }, {"points"});
        const double seconds = as_first(watch.seconds());
        if (2 * seconds < step_seconds)
            step *= 2;
        else if (seconds > 2 * step_seconds)
            step = std::max(least, step / 2);
    }
    return out;
}

void RadiosityFunction::evaluate(std::span<const ProbePoint> points, std::size_t first, Component component,
                                 std::span<Light> results) const {
    PlaceLight::Workspace workspace;
    GatherWorkspace gathering;
    for (std::size_t k = 0; k < results.size(); ++k) {
        const std::size_t i = first + k;
        Light& out = results[k];
        const Normal& n = points[i].n;
        const auto& [x, surface, region, is_between_sides] = places_.find(points[i].x, n);
        if (!surface.is_none()) {
            const bool is_covered = stage_->occluders.is_covered(x, n, region);
            const Material& material = solution_.scene.material(surface);
            out = is_covered ? exitance::light_on(material, Spectrum())
                             : light_on(region, material, x, component, workspace);
            out.is_between_sides = is_between_sides;
            continue;
        }
        out.is_between_sides = is_between_sides;
        if (component != Component::indirect) {
            const PlaceLight::Estimate direct = stage_->place_light.at(x, n, region, accuracy_, workspace);
            out.irradiance += direct.irradiance, out.standard_error = direct.standard_error();
        }
        const std::uint64_t key = hash(static_cast<std::uint64_t>(Stream::gather), i);
        if (component != Component::direct)
            out.irradiance += gathered({x, n}, RegionId(), free_space_rays, key, gathering);
    }
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
            out[i] = exitance::light_on(solution_.scene.material(place.surface), interpolated(place.region, place.x));
        out[i].is_between_sides = place.is_between_sides;
    });
    return out;
}

}  // namespace exitance
