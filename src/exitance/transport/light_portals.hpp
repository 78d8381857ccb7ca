#pragma once

#include <vector>

#include "exitance/transport/light_rooms.hpp"
#include "exitance/visibility/portal_aim.hpp"

namespace exitance {

/// Openings between rooms, listed by the room whose rays are aimed at them.
class LightPortals {
  public:
    explicit LightPortals(std::vector<std::vector<PortalCell>> by_room) : by_room_(std::move(by_room)) {}
    std::span<const PortalCell> of_room(std::size_t room) const { return by_room_[room]; }
    bool empty() const;
    /// Returns a copy for rooms with new numbers: room k has the openings that room before[k] has here.
    std::shared_ptr<const LightPortals> renumbered(std::span<const std::size_t> before) const {
        std::vector<std::vector<PortalCell>> by_room;
        for (const std::size_t room : before) by_room.push_back(by_room_[room]);
        return std::make_shared<const LightPortals>(std::move(by_room));
    }

  private:
    std::vector<std::vector<PortalCell>> by_room_;
};

/// True if rays should be aimed at an opening of this form factor. Unaimed rays that find it have a variance of about F
/// light^2, those to the walls of their own room a variance of about 1.
inline bool is_worth_aiming(double form_factor, double light) {
    return form_factor * light * light > 1;
}

/// Mean reflected light of every room, W/m^2, computed on coarse elements with the few dozen rays per element of
/// `rows`. `rooms` must have been made from the elements of `tree` and `numbering`.
std::vector<double> coarse_light(const Stage& stage, const LightRooms& rooms, const ElementTree& tree,
                                 const LeafNumbering& numbering, const RayRows& rows);

/// Finds openings between rooms and covers them with parallelograms. For a ray from one room into another, the point
/// where equally much is seen of both rooms is taken as a point of the opening; lines through its neighbourhood that
/// end in both rooms give the size. If a part of an opening is not covered, unaimed
/// rays hit it, so that the expected light stays the same; but these rays then cause most of the noise.
/// `light`: from coarse_light(). Returns null if aiming at openings does not reduce the noise. Deterministic on any
/// number of threads. Casts at most 2^18 rays, and some thousands per opening.
std::shared_ptr<const LightPortals> find_light_portals(const Stage& stage, const LightRooms& rooms,
                                                       const ElementTree& tree, const LeafNumbering& numbering,
                                                       std::span<const double> light, std::uint64_t seed,
                                                       const StopRequest& stop);

/// Returns the openings at which rays from x on region `own` should be aimed; empty if that does not reduce the noise.
std::span<const PortalCell> portals_worth_aiming(const Stage& stage, RegionId own, const Point& x, const Normal& n);
/// Returns `cells`, or an empty span if aiming rays at them costs more than it saves.
std::span<const PortalCell> worth_aiming(const Stage& stage, RegionId own, std::span<const PortalCell> cells,
                                         const Point& x, const Normal& n);

}  // namespace exitance
