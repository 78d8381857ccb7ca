#include "exitance/measure/light_maps/curved_difference.hpp"

#include <cmath>

#include "exitance/evaluate/surface_light.hpp"

namespace exitance {

double CurvedDifferences::level() const {
    double squares = 0, area = 0;
    for (const CurvedDifference& d : regions) squares += d.area * d.solved * d.solved, area += d.area;
    return squares > 0 ? std::sqrt(squares / area) : 1;
}

double CurvedDifferences::rms() const {
    double squares = 0, area = 0;
    for (const CurvedDifference& d : regions) squares += d.area * d.value() * d.value(), area += d.area;
    return area > 0 ? std::sqrt(squares / area) / level() : 0;
}

double CurvedDifferences::largest() const {
    double largest = 0;
    for (const CurvedDifference& d : regions) largest = std::max(largest, std::abs(d.value()));
    return largest / level();
}

CurvedSums::CurvedSums(const Scene& scene, const CurvedFaces* faces)
    : faces_(faces), sums_(faces && !faces->empty() ? scene.regions().size() : 0) {}

void CurvedSums::add(RegionId region, double area, const Spectrum& irradiance) {
    if (sums_.size() == 0 || !faces_->is_curved(region)) return;
    sums_[region].area += area, sums_[region].flux += area * mean(irradiance);
}

CurvedDifferences CurvedSums::compare(const Solution& solution) const {
    CurvedDifferences out;
    if (sums_.size() == 0) return out;
    const Field<SurfaceId, SurfaceLight> light = mean_light(solution);
    const Scene& scene = solution.scene;
    for (const RegionId r : scene.regions().ids()) {
        if (!(sums_[r].area > 0)) continue;
        CurvedDifference d{r, 0, sums_[r].flux / sums_[r].area, 0};
        for (const SurfaceId s : scene.regions()[r].surfaces) {
            d.area += scene.surfaces()[s].area;
            d.solved += scene.surfaces()[s].area * mean(light[s].irradiance);
        }
        d.solved /= d.area;
        out.regions.push_back(d);
    }
    return out;
}

}  // namespace exitance
