#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "exitance/scene/locator.hpp"
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

    /// Finds all parts of the face that was a triangle of the file. Empty if there is none. Parts at the triangle's
    /// centre may be holes that were left out, so that other points are tried.
    std::vector<SurfaceId> find(const Locator& locator, const std::array<Point, 3>& corner, const Normal& n) const {
        const SurfaceId middle = locator.find((corner[0] + corner[1] + corner[2]) / 3, n);
        if (!middle.is_none()) return of(middle);
        constexpr int steps = 16;  // derived from the size of parts: most are wider than a sixteenth of the face
        for (int i = 1; i < steps && !parts_.empty(); ++i)
            for (int j = 1; i + j < steps; ++j) {
                const double a = i / double(steps), b = j / double(steps);
                const Point p = corner[0] + a * (corner[1] - corner[0]) + b * (corner[2] - corner[0]);
                const SurfaceId s = locator.find(p, n);
                if (!s.is_none() && scene_->surfaces()[s].whole > 0) return of(s);
            }
        return {};
    }

  private:
    const Scene* scene_;
    std::unordered_map<std::uint32_t, std::vector<SurfaceId>> parts_;
};

}  // namespace exitance
