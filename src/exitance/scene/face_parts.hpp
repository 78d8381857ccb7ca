#pragma once

#include <unordered_map>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// The parts of faces that were cut when the scene was read (`Surface::whole`).
class FaceParts {
  public:
    explicit FaceParts(const Scene& scene) : scene_(&scene) {
        for (const SurfaceId s : scene.surfaces().ids())
            if (const std::uint32_t whole = scene.surfaces()[s].whole; whole > 0) parts_[whole].push_back(s);
    }

    /// Returns all parts of the face to which a part belongs, or the face itself if it was not cut. Ascending.
    std::vector<SurfaceId> of(SurfaceId s) const {
        const auto parts = parts_.find(scene_->surfaces()[s].whole);
        return parts == parts_.end() ? std::vector<SurfaceId>{s} : parts->second;
    }

  private:
    const Scene* scene_;
    std::unordered_map<std::uint32_t, std::vector<SurfaceId>> parts_;
};

}  // namespace exitance
