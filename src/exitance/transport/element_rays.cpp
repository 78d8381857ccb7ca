#include "exitance/transport/element_rays.hpp"

#include <algorithm>

#include "exitance/base/random.hpp"
#include "exitance/form_factors/met_directions.hpp"
#include "exitance/transport/light_portals.hpp"

namespace exitance {

std::size_t ElementRays::cast(ElementId e, std::uint64_t key, std::span<std::uint32_t> leaves, std::uint32_t first,
                              Leave leave, std::span<float> counts, std::span<Spectrum> colours) {
    const std::size_t count = leaves.size();
    const Patch& patch = tree_.patch(e);
    const RegionId region = leave == Leave::as_met ? tree_.region(e) : RegionId();
    const Normal& n = stage_.scene.regions()[tree_.region(e)].plane.n;
    const ScrambledSobol points(key);
    origins_.resize(count), directions_.resize(count), hits_.resize(count);
    for (int d = 0; d < 4; ++d) {
        coordinates_[static_cast<std::size_t>(d)].resize(count);
        points.fill(first, d, coordinates_[static_cast<std::size_t>(d)]);
    }
    for (std::size_t k = 0; k < count; ++k)
        origins_[k] = patch.at(tree_.uniform(e, coordinates_[2][k], coordinates_[3][k]));
    met_directions(stage_.scene, region, n, coordinates_[0], coordinates_[1], directions_);
    if (!counts.empty()) aim(tree_.region(e), n, patch.at(tree_.centre(e)), counts);
    stage_.tracer.nearest(origins_, directions_, tree_.region(e), hits_, Mirrored::followed);
    queries_.clear(), of_ray_.clear();
    std::fill(leaves.begin(), leaves.end(), missed);
    for (std::size_t k = 0; k < count; ++k) {
        if (hits_[k].surface.is_none() || !hits_[k].front) continue;
        const Point y = place_of(stage_.scene, hits_[k], origins_[k], directions_[k]);
        locator_.find_root(hits_[k].region, y, queries_.emplace_back());
        of_ray_.push_back(k);
    }
    locator_.leaves().find(queries_);
    for (std::size_t k = 0; k < queries_.size(); ++k) leaves[of_ray_[k]] = queries_[k].leaf;
    if (!colours.empty())
        for (const std::size_t k : of_ray_) colours[k] = stage_.glass.of(hits_[k], origins_[k], directions_[k]);
    return static_cast<std::size_t>(std::count_if(
        hits_.begin(), hits_.end(), [](const RayHit& hit) { return hit.surface.is_none() || hit.is_glass; }));
}

/// Aims the second half of the rays at openings if that reduces the noise at `centre`, and sets the rays' weights.
void ElementRays::aim(RegionId region, const Normal& n, const Point& centre, std::span<float> counts) {
    std::fill(counts.begin(), counts.end(), 1.0f);
    const std::span<const PortalCell> cells = portals_worth_aiming(stage_, region, centre, n);
    if (cells.empty()) return;
    PortalAim aim;
    const std::size_t half = counts.size() / 2;
    for (std::size_t k = 0; k < counts.size(); ++k) {
        aim.set(cells, origins_[k], n);
        double weight = 1;
        if (k < half) {
            weight = aim.is_aimed_at(directions_[k]) ? 0 : 1;
        } else {
            const PortalAim::Ray ray = aim.aimed(coordinates_[0][k], coordinates_[1][k]);
            directions_[k] = ray.direction, weight = ray.weight;
        }
        counts[k] = static_cast<float>(PortalAim::share * weight);
    }
}

}  // namespace exitance
