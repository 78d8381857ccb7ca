#include "exitance/transport/element_rays.hpp"

#include <algorithm>

#include "exitance/transport/hemisphere.hpp"

namespace exitance {

void ElementRays::cast(ElementId e, std::uint64_t key, std::span<std::uint32_t> leaves, std::uint32_t first) {
    const std::size_t count = leaves.size();
    const Patch& patch = tree_.patch(e);
    const Frame frame(stage_.scene.regions()[tree_.region(e)].plane.n);
    const ScrambledSobol points(key);
    origins_.resize(count), directions_.resize(count), hits_.resize(count);
    for (std::uint32_t k = 0; k < count; ++k) {
        origins_[k] = patch.at(tree_.uniform(e, points(first + k, 2), points(first + k, 3)));
        directions_[k] = cosine_direction(frame, points(first + k, 0), points(first + k, 1));
    }
    stage_.tracer.nearest(origins_, directions_, tree_.region(e), hits_);
    queries_.clear(), of_ray_.clear();
    std::fill(leaves.begin(), leaves.end(), missed);
    for (std::size_t k = 0; k < count; ++k) {
        if (hits_[k].surface.is_none() || !hits_[k].front) continue;
        const RegionId region = stage_.scene.surfaces()[hits_[k].surface].region;
        queries_.push_back(locator_.root_of(region, origins_[k] + hits_[k].distance * directions_[k]));
        of_ray_.push_back(k);
    }
    locator_.leaves().find(queries_);
    for (std::size_t k = 0; k < queries_.size(); ++k) leaves[of_ray_[k]] = queries_[k].leaf;
}

}  // namespace exitance
