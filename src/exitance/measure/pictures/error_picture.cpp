#include "exitance/measure/pictures/error_picture.hpp"

#include <cmath>
#include <limits>
#include <map>

#include "exitance/base/parallel.hpp"
#include "exitance/measure/pictures/mesh_view.hpp"
#include "exitance/scene/locator.hpp"

namespace exitance {

SeenPlaces seen_places(const Scene& scene, const RayTracer& tracer, const Camera& camera, PictureSize size) {
    const MeshView view = view_mesh(SixNodeMesh(), scene, tracer, camera, size);
    SeenPlaces out{size, {}, {}, {}};
    for (std::size_t i = 0; i < view.pixels.size(); ++i) {
        const MeshView::Pixel& pixel = view.pixels[i];
        if (pixel.region.is_none()) continue;
        out.points.push_back({pixel.at, scene.regions()[pixel.region].plane.n});
        out.regions.push_back(pixel.region), out.pixels.push_back(i);
    }
    return out;
}

std::vector<Spectrum> nearest_reference(const SeenPlaces& places, const ReferencePoints& reference,
                                        const Scene& scene) {
    const Locator locator(scene);
    std::map<RegionId, std::vector<std::size_t>> by_region;
    for (std::size_t i = 0; i < reference.points.size(); ++i) {
        const SurfaceId surface = locator.find(reference.points[i].x, reference.points[i].n);
        if (!surface.is_none()) by_region[scene.surfaces()[surface].region].push_back(i);
    }
    std::vector<Spectrum> out(places.points.size(), Spectrum(std::numeric_limits<double>::quiet_NaN()));
    parallel_for(places.points.size(), 256, [&](std::size_t i) {
        const auto known = by_region.find(places.regions[i]);
        if (known == by_region.end()) return;
        double nearest = std::numeric_limits<double>::infinity();
        for (const std::size_t at : known->second) {
            const Vec3 away = reference.points[at].x - places.points[i].x;
            if (dot(away, away) < nearest) nearest = dot(away, away), out[i] = reference.irradiance[at];
        }
    });
    return out;
}

Picture error_picture(const SeenPlaces& places, const std::vector<Spectrum>& irradiance,
                      const std::vector<Spectrum>& reference) {
    Picture picture{places.size, std::vector<Pixel>(places.size.pixels())};
    for (std::size_t i = 0; i < places.points.size(); ++i) {
        const Spectrum off = irradiance[i] - reference[i];
        if (!std::isfinite(mean(off))) continue;
        Pixel& pixel = picture.pixels[places.pixels[i]];
        for (std::size_t band = 0; band < bands; ++band) pixel.irradiance[band] = std::abs(off[band]);
        pixel.front = 1, pixel.region = places.regions[i];
    }
    return picture;
}

}  // namespace exitance
