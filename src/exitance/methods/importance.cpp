#include "exitance/methods/importance.hpp"

#include "exitance/base/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/scene/locator.hpp"

namespace exitance {
namespace {

/// The region that a point is on; none in free space.
RegionId region_of(const Scene& scene, const Locator& faces, const ImportantPoint& point) {
    const SurfaceId face = faces.find(point.at, point.normal);
    return face.is_none() ? RegionId() : scene.surfaces()[face].region;
}

}  // namespace

std::vector<Spectrum> importance_at(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                                    const std::vector<ImportantPoint>& points, std::uint64_t seed) {
    const Locator faces(stage.scene);
    const ElementLocator elements(tree, stage.scene.regions().size());
    std::vector<Spectrum> out(numbering.leaves.size());
    const auto look = [&](RegionId region, const Point& at, const Spectrum& share) {
        const ElementId e = elements.find(region, at).element;
        const double density = stage.area / (static_cast<double>(points.size()) * tree.area(e));
        out[numbering.number[e]] += density * share;
    };
    constexpr std::uint32_t rays = 256;
    std::vector<Vec3> directions(rays);
    std::vector<RayHit> hits(rays);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& [at, normal] = points[i];
        if (const RegionId region = region_of(stage.scene, faces, points[i]); !region.is_none()) {
            look(region, at, Spectrum(1.0));
            continue;
        }
        const ScrambledSobol places(hash(seed, static_cast<std::uint64_t>(Stream::gather), i));
        const Frame frame(normal);
        for (std::uint32_t k = 0; k < rays; ++k) directions[k] = cosine_direction(frame, places(k, 0), places(k, 1));
        stage.tracer.nearest(directions, at, RegionId(), hits);
        for (std::uint32_t k = 0; k < rays; ++k) {
            if (hits[k].surface.is_none() || !hits[k].front) continue;
            const RegionId region = hits[k].region;
            look(region, at + hits[k].distance * directions[k],
                 (1.0 / rays) * stage.scene.material(region).reflectance);
        }
    }
    return out;
}

std::vector<ElementTree::Place> places_of(const Stage& stage, const ElementTree& tree,
                                          const std::vector<ImportantPoint>& points) {
    const Locator faces(stage.scene);
    const ElementLocator elements(tree, stage.scene.regions().size());
    std::vector<ElementTree::Place> out;
    for (const ImportantPoint& point : points)
        if (const RegionId region = region_of(stage.scene, faces, point); !region.is_none())
            out.push_back(elements.find(region, point.at));
    return out;
}

}  // namespace exitance
