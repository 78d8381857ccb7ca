#pragma once

#include <vector>

#include "exitance/transport/light_rooms.hpp"

namespace exitance {

/// A parallelogram that covers an opening into a lighter room, or a part of it.
struct PortalCell {
    Point corner;  ///< Its points are corner + s u + t v, s and t in [0, 1).
    Vec3 u, v;     ///< At right angles.
    Normal n;      ///< Of its plane.
    double area = 0;
    double light = 0;  ///< Reflected light of the room behind it by that of the room before it; rough.
};

/// Openings between rooms, by the room that rays are aimed at them from.
class LightPortals {
  public:
    explicit LightPortals(std::vector<std::vector<PortalCell>> by_room) : by_room_(std::move(by_room)) {}
    std::span<const PortalCell> of_room(std::size_t room) const { return by_room_[room]; }
    bool empty() const;

  private:
    std::vector<std::vector<PortalCell>> by_room_;
};

/// Would rays be aimed at an opening whose form factor from a place is that? Rays in all directions meet it with a
/// variance of F light^2, and the walls of their own room with one of some 1.
inline bool is_worth_aiming(double form_factor, double light) {
    return form_factor * light * light > 1;
}

/// Mean reflected light of every room, W/m^2, as coarse elements and the dozens of rays of each, `rows`, have it.
/// `rooms` were made of the elements that `tree` and `numbering` hold.
std::vector<double> coarse_light(const Stage& stage, const LightRooms& rooms, const ElementTree& tree,
                                 const LeafNumbering& numbering, const RayRows& rows);

/// Where rays from one room meet another one, a point of the opening is where as much is seen of both; lines through
/// its neighbourhood that end in both rooms tell how large it is. An opening need not be found whole: rays that are not
/// aimed meet the rest. `light` of every room, as above.
/// Null where nothing is worth aiming at. The same on any number of threads. At most 2^18 rays, and some thousands an
/// opening.
std::shared_ptr<const LightPortals> find_light_portals(const Stage& stage, const LightRooms& rooms,
                                                       const ElementTree& tree, const LeafNumbering& numbering,
                                                       std::span<const double> light, std::uint64_t seed,
                                                       const StopRequest& stop);

}  // namespace exitance
