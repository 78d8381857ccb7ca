#include "exitance/reconstruct/radiosity_function.hpp"

#include "exitance/core/parallel.hpp"
#include "exitance/reconstruct/gather.hpp"

namespace exitance {
namespace {

Light light_on(const Material& material, const Spectrum& irradiance) {
    return {irradiance, material.exitance + material.reflectance * irradiance, true};
}

}  // namespace

RadiosityFunction::RadiosityFunction(const Solution& solution)
    : solution_(solution),
      locator_(solution.scene),
      indirect_locator_(solution.indirect.tree, solution.scene.regions().size()),
      interpolant_locator_(solution.interpolant.tree, solution.scene.regions().size()),
      stage_(std::make_unique<Stage>(solution.scene)) {}

RadiosityFunction::~RadiosityFunction() = default;

Spectrum RadiosityFunction::indirect_in_free_space(const ProbePoint& point, std::size_t index) const {
    constexpr unsigned rays = 4096;
    const RadiosityAt reflected = [&](RegionId region, const Point& y) {
        return solution_.scene.material(region).reflectance *
               solution_.interpolant.at(interpolant_locator_.find(region, y));
    };
    GatherWorkspace workspace;
    const std::uint64_t key = hash(static_cast<std::uint64_t>(Stream::gather), index);
    return gather_reflected(*stage_, point.x, point.n, RegionId(), rays, key, reflected, workspace).irradiance;
}

Spectrum RadiosityFunction::irradiance_on(const SeenPoint& point, Component component,
                                          DirectLight::Workspace& workspace) const {
    // E = E_dir + (indirect - c E_dir): the exact part weighs 1 - c in all, 1 or -c by itself.
    Spectrum irradiance;
    if (!solution_.direct_in_elements && (component != Component::indirect || has_direct_share())) {
        Spectrum weight(component == Component::indirect ? 0.0 : 1.0);
        if (component != Component::direct) weight -= solution_.direct_share;
        const Normal& n = solution_.scene.regions()[point.region].plane.n;
        irradiance += weight * stage_->direct.irradiance(point.x, n, point.region, workspace);
    }
    if (component != Component::direct)
        irradiance += solution_.indirect.at(indirect_locator_.find(point.region, point.x));
    return irradiance;
}

std::vector<Light> RadiosityFunction::at(std::span<const ProbePoint> points, Component component) const {
    std::vector<Light> out(points.size());
    parallel_ranges(points.size(), 32, [&](std::size_t begin, std::size_t end) {
        DirectLight::Workspace workspace;
        for (std::size_t i = begin; i < end; ++i) {
            const auto& [x, n] = points[i];
            const SurfaceId surface = locator_.find(x, n);
            const bool free = surface.is_none();
            const RegionId region = free ? RegionId() : solution_.scene.surfaces()[surface].region;
            if (!free && stage_->occluders.is_covered(x, n, region)) {
                out[i] = light_on(solution_.scene.material(surface), Spectrum());
                continue;
            }
            if (!free) {
                const Spectrum irradiance = irradiance_on({x, region}, component, workspace);
                out[i] = light_on(solution_.scene.material(surface), irradiance);
                continue;
            }
            if (component != Component::indirect)
                out[i].irradiance += stage_->direct.irradiance(x, n, region, workspace);
            if (component != Component::direct) out[i].irradiance += indirect_in_free_space(points[i], i);
        }
    });
    return out;
}

std::vector<Light> RadiosityFunction::at(std::span<const SeenPoint> points, Component component) const {
    std::vector<Light> out(points.size());
    parallel_ranges(points.size(), 32, [&](std::size_t begin, std::size_t end) {
        DirectLight::Workspace workspace;
        for (std::size_t i = begin; i < end; ++i)
            out[i] =
                light_on(solution_.scene.material(points[i].region), irradiance_on(points[i], component, workspace));
    });
    return out;
}

std::vector<Light> RadiosityFunction::interpolant_at(std::span<const ProbePoint> points) const {
    std::vector<Light> out(points.size());
    parallel_for(points.size(), 256, [&](std::size_t i) {
        const SurfaceId surface = locator_.find(points[i].x, points[i].n);
        if (surface.is_none()) return;
        const RegionId region = solution_.scene.surfaces()[surface].region;
        out[i] = light_on(solution_.scene.material(surface),
                          solution_.interpolant.at(interpolant_locator_.find(region, points[i].x)));
    });
    return out;
}

}  // namespace exitance
