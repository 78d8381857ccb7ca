#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/scene/sky/sky_patches.hpp"
#include "exitance/visibility/glass/pane_groups.hpp"
#include "exitance/visibility/glazed_part.hpp"

namespace exitance {

/// Exact visible part of every patch of the sky at a sensor: the visible parts of the sky and of the ground below it,
/// clipped to the patches.
class VisiblePatches {
  public:
    /// `occluders`: those of a scene whose light from outside is a sky and a ground. Must outlive this object.
    VisiblePatches(const Occluders& occluders, const SkyPatches& patches);

    /// Arrays for irradiance(): one object per thread, reused.
    struct Workspace {
        VisibilityWorkspace visibility;
        Fragments fragments;
        std::vector<Vec3> part, rest;
    };
    /// Computes the irradiance at a sensor by every patch with luminance 1, also through panes: one value per patch.
    /// Bands are weighted by luminous_weights(). O(patches x visible parts).
    void irradiance(const SurfacePoint& at, Workspace& workspace, std::span<float> out) const;
    /// Computes the parts of it that cross panes of each group, and in the last row the part that crosses panes of two
    /// groups or more: a row per group and one more, a column per patch.
    void irradiance_through(const PaneGroups& groups, const SurfacePoint& at, Workspace& workspace,
                            std::span<float> out) const;

  private:
    /// Directions of a facet of a patch, bounded by planes through the sensor.
    struct Cone {
        std::vector<Vec3> inward;
        std::uint32_t patch = 0;
        bool below = false;
    };
    static void clip_to(const Cone& cone, std::vector<Vec3>& polygon, std::vector<Vec3>& rest);
    template <class Visit>
    void for_each_part(const SurfacePoint& at, Workspace& workspace, const Visit& visit) const;

    const Occluders& occluders_;
    std::vector<Cone> cones_;
};

}  // namespace exitance
