#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/mesh/element_locator.hpp"

namespace exitance {

struct Stage;
struct LeafNumbering;
class RayRows;
class LightPortals;

/// The rooms of a scene: parts of free space cut at openings smaller than a tenth of their walls. Light of one differs
/// from that of another by orders of magnitude, so that errors are judged by room: outdoors beside a cellar would hide
/// anything. Rooms below a twentieth of the area that is no ground or sky belong to their neighbour.
class LightRooms {
  public:
    /// All is one room.
    LightRooms() = default;

    std::size_t count() const { return areas_.size(); }           ///< 0 where all is one room.
    double area(std::size_t room) const { return areas_[room]; }  ///< m^2
    /// The room that a point of a region lies in, from 0 by area, the largest first.
    std::size_t at(RegionId region, const Point& x) const;
    /// The room of an element's centre.
    std::size_t of(const ElementTree& tree, ElementId e) const;
    /// The share of the light that leaves a surface there which meets no front; by few rays.
    double lost_share(RegionId region, const Point& x) const {
        return locator_ ? lost_[locator_->find(region, x).element] : 0;
    }
    /// What an area in the room of an element counts, so that all rooms count alike, and all together as much as they
    /// are large: the mean area of a room by that of this one. 1 where all is one room.
    double weight(const ElementTree& tree, ElementId e) const;
    /// The same with what the light of the element counts in the rooms that it shines into: the ground before a window
    /// counts by the room behind it.
    double importance(const ElementTree& tree, ElementId e) const;
    /// The same of all elements of a piece, where they are of one room; the least of theirs where they are of several.
    double importance_of_piece(std::size_t piece) const { return count() > 0 ? piece_importance_[piece] : 1; }

    /// The openings between rooms that rays from the darker one are aimed at; null where there are none.
    const LightPortals* portals() const { return portals_.get(); }

  private:
    void weigh(const ElementTree& tree, const LeafNumbering& numbering, const RayRows& rows);

    friend LightRooms find_light_rooms(const Stage&, std::uint64_t, const StopRequest&);
    std::vector<double> areas_;
    double mean_area_ = 0;
    /// Of a coarse mesh over all pieces; none where all is one room that loses no light.
    std::shared_ptr<const ElementLocator> locator_;
    Field<ElementId, std::uint16_t> room_of_;  ///< Of the mesh's leaves.
    std::vector<double> piece_importance_;
    Field<ElementId, float> lost_, importance_;
    std::shared_ptr<const LightPortals> portals_;
};

/// Light that goes to and fro between coarse elements evens out within a room long before it does between rooms: cuts
/// are sought along the slowest differences [Lovasz93], and taken where they go through an
/// opening: narrower than a tenth of the smaller side's walls, and than half of what cuts beside it are. Rays: some
/// dozens an element; the same on any number of threads. O(elements x rays x log rooms).
LightRooms find_light_rooms(const Stage& stage, std::uint64_t seed, const StopRequest& stop);

}  // namespace exitance
