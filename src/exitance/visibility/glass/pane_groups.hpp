#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/visible_part.hpp"

namespace exitance {

/// Groups of panes of clear glass whose transmission changes together, such as the windows of one facade. Finds the
/// groups whose panes a segment crosses. Panes may belong to no group.
class PaneGroups {
  public:
    /// A bit for each group.
    using Mask = std::uint32_t;
    static constexpr std::size_t max_groups = 16;
    static constexpr std::int32_t no_group = -1;

    PaneGroups() = default;
    /// `group_of_pane`: a number below `count`, or `no_group`, for each pane of the scene. At most `max_groups`.
    PaneGroups(const Scene& scene, std::vector<std::int32_t> group_of_pane, std::size_t count);
    /// Returns one group to which all light belongs, whether it crosses panes or not.
    static PaneGroups all_light();

    std::size_t count() const { return count_; }
    bool has_all_light() const { return has_all_light_; }
    /// Returns the mask of the group to which a pane belongs; 0 if it belongs to none. 1 for all_light().
    Mask mask_of(std::size_t pane) const {
        if (has_all_light_) return 1;
        return group_of_pane_[pane] < 0 ? 0 : Mask{1} << static_cast<unsigned>(group_of_pane_[pane]);
    }
    /// Returns the groups that the segment from x to y crosses, without the pane `ignored`. O(log panes).
    Mask crossed(const Point& x, const Point& y, std::int32_t ignored = -1) const;
    /// Returns the groups that a ray crosses before it leaves the scene.
    Mask crossed_outwards(const Point& x, const Vec3& direction, std::int32_t ignored = -1) const;

  private:
    std::vector<Pane> panes_;  ///< Panes of the groups.
    std::vector<std::uint32_t> number_;
    std::vector<std::int32_t> group_of_pane_;  ///< Group of each pane of the scene.
    Bvh tree_;
    double reach_ = 0;  ///< Longer than any segment within the scene, metres.
    std::size_t count_ = 0;
    bool has_all_light_ = false;
};

/// Adds the part of transmitted_form_factor() (visibility/glazed_part.hpp) that crosses panes of a group to that
/// group's entry of `out`, and the part that crosses panes of at least two groups to the last entry. `out` has one
/// entry more than there are groups.
void add_form_factors_through(const PaneGroups& groups, const Occluders& occluders, const SurfacePoint& at,
                              PieceId source, std::span<const Vec3> visible, std::span<Spectrum> out);

}  // namespace exitance
