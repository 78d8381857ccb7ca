#pragma once

#include <span>
#include <vector>

#include "exitance/transport/light_portals.hpp"

namespace exitance {

class ReflectedLight;

/// Parallelograms at which rays of a gather are aimed (`PortalAim`), by room: openings into brighter rooms, and places
/// that reflect much more light than the rest of their room, such as a patch of sunlight or the sides of a lit door.
class BrightPlaces {
  public:
    BrightPlaces() = default;
    explicit BrightPlaces(std::vector<std::vector<PortalCell>> by_room) : by_room_(std::move(by_room)) {}
    std::span<const PortalCell> of_room(std::size_t room) const {
        return room < by_room_.size() ? by_room_[room] : std::span<const PortalCell>();
    }

    bool empty() const { return by_room_.empty(); }

  private:
    std::vector<std::vector<PortalCell>> by_room_;
};

/// Finds the bright places of b on the leaves of a mesh, and adds the openings of the stage. A room has bright places
/// if leaves that reflect at least four times its mean hold more than half of the mean square of b: then rays that meet
/// them by chance are the largest part of the noise. They are covered by at most a dozen parallelograms. O(leaves).
BrightPlaces find_bright_places(const Stage& stage, const ElementTree& tree, const ReflectedLight& b);

}  // namespace exitance
