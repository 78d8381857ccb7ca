#include "exitance/transport/element_rays.hpp"

#include <algorithm>

#include "exitance/form_factors/hemisphere.hpp"

namespace exitance {

void ElementRays::cast(ElementId e, std::uint64_t key, std::span<std::uint32_t> leaves, std::uint32_t first) {
    const std::size_t count = leaves.size();
    const Patch& patch = tree_.patch(e);
    const Frame frame(stage_.scene.regions()[tree_.region(e)].plane.n);
    const ScrambledSobol points(key);
    origins_.resize(count), directions_.resize(count), hits_.resize(count);
    for (int d = 0; d < 4; ++d) {
        coordinates_[static_cast<std::size_t>(d)].resize(count);
        points.fill(first, d, coordinates_[static_cast<std::size_t>(d)]);
    }
    for (std::size_t k = 0; k < count; ++k)
        origins_[k] = patch.at(tree_.uniform(e, coordinates_[2][k], coordinates_[3][k]));
    cosine_directions(frame, coordinates_[0], coordinates_[1], directions_);
    stage_.tracer.nearest(origins_, directions_, tree_.region(e), hits_);
    queries_.clear(), of_ray_.clear();
    std::fill(leaves.begin(), leaves.end(), missed);
    for (std::size_t k = 0; k < count; ++k) {
        if (hits_[k].surface.is_none() || !hits_[k].front) continue;
        const RegionId region = hits_[k].region;
        locator_.find_root(region, origins_[k] + hits_[k].distance * directions_[k], queries_.emplace_back());
        of_ray_.push_back(k);
    }
    locator_.leaves().find(queries_);
    for (std::size_t k = 0; k < queries_.size(); ++k) leaves[of_ray_[k]] = queries_[k].leaf;
}

}  // namespace exitance
