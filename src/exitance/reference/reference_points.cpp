#include "exitance/reference/reference_points.hpp"

#include "exitance/scene/locator.hpp"

namespace exitance {

std::vector<Spectrum> irradiance_at(const Solution& solution, const std::vector<ProbePoint>& points, Evaluated what) {
    const RadiosityFunction function(solution);
    std::vector<Spectrum> out;
    out.reserve(points.size());
    for (const Light& light : what == Evaluated::interpolant ? function.interpolant_at(points) : function.at(points))
        out.push_back(light.irradiance);
    return out;
}

ErrorMeasure error_against(std::span<const Spectrum> irradiance, const ReferencePoints& reference, const Scene& scene) {
    const Locator locator(scene);
    std::vector<SurfaceId> surfaces;
    for (const ProbePoint& point : reference.points) surfaces.push_back(locator.find(point.x, point.n));
    return measure_error({irradiance, reference.irradiance, reference.standard_errors, surfaces}, scene);
}

ErrorMeasure error_against(const Solution& solution, const ReferencePoints& reference, Evaluated what) {
    return error_against(irradiance_at(solution, reference.points, what), reference, solution.scene);
}

}  // namespace exitance
